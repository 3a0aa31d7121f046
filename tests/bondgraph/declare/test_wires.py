"""Wires say what reads what: the graph with wires has the equations of the one that reads by names."""

from collections.abc import Callable, Mapping
from typing import Any

import pytest
import sympy as sp

import bondgraph as bg
from bondgraph.declare.wires import WIRES

BONDS = "motor > shaft > J, shaft > b, shaft > tacho"
EQUATIONS = (
    "A",
    "J",
    "B",
    "E",
    "F",
    "D",
    "G",
    "states",
    "further_states",
    "inputs",
    "laws",
    "tasks",
)


def _motor(*nodes: Any, value: object = None) -> list[Any]:
    return [
        bg.Se("motor", value), bg.One("shaft"), bg.I("J", "J", flow="omega"), bg.R("b", "b"),
        bg.Df("tacho"), *nodes,
    ]  # fmt: skip


def _same(one: Any, other: Any) -> None:
    first, second = bg.derive(one), bg.derive(other)
    for name in EQUATIONS:
        assert getattr(first, name) == getattr(second, name), name


def _wires(graph: Any) -> list[tuple[Any, Any, tuple[str, ...]]]:
    return [(one.source, one.reader, one.names) for one in bg.validate(graph).graph[WIRES]]


def test_a_loop_by_wires_is_the_loop_by_names() -> None:
    """J omega' = K (ref - omega) + z - b omega, z' = K_i (ref - omega)."""
    wired = bg.graph(
        _motor(
            bg.Function("error", "ref - y", ports=["y"]), bg.State("z", "K_i*e", ports=["e"]),
            bg.Function("tau", "K*e + z", ports=["e"]),
        ),
        BONDS, "tacho > error > tau > motor, error > z > tau",
    )  # fmt: skip
    rates = bg.explicit(bg.derive(wired))
    omega, z, ref, K, K_i, b, J = sp.symbols("omega z ref K K_i b J")
    assert sp.expand(rates[omega] - (K * (ref - omega) + z - b * omega) / J) == 0
    assert sp.expand(rates[z] - K_i * (ref - omega)) == 0
    assert _wires(wired) == [
        ("tacho", "error", ("omega",)), ("error", "tau", ("error",)), ("error", "z", ("error",)),
        ("z", "tau", ("z",)), ("tau", "motor", ("tau",)),
    ]  # fmt: skip


def test_wires_have_no_part_in_bonds_and_causality() -> None:
    wired = bg.graph(_motor(bg.Function("tau", "-K*omega")), BONDS, "tacho > tau > motor")
    plain = bg.graph(_motor(bg.Function("tau", "-K*omega"), value="1*tau"), BONDS)
    _same(wired, plain)
    assert [*bg.validate(wired).edges] == [*bg.validate(plain).edges]
    assert repr(wired) == "<BondGraph: 6 nodes, 4 bonds, 2 wires>"
    assert bg.validate(bg.in_mode(wired)).graph[WIRES] == bg.validate(wired).graph[WIRES]


@pytest.mark.parametrize(
    ("source", "value", "name"),
    [
        ("tacho", "-K*f_tacho", "f_tacho"), ("tacho", "-K*omega", "omega"), ("J", "-K*omega", "omega"),
        ("shaft", "-K*f_shaft", "f_shaft"), ("shaft", "-K*omega", "omega"), ("b", "-e_b", "e_b"),
        ("b", "-f_b", "f_b"), ("motor", "-K*f_motor", "f_motor"), ("J", "-K*e_J", "e_J"),
    ],
)  # fmt: skip
def test_what_a_wire_brings_is_what_its_reader_reads(source: str, value: str, name: str) -> None:
    graph = bg.graph(_motor(bg.Function("tau", value)), BONDS, f"{source} > tau > motor")
    assert _wires(graph)[0] == (source, "tau", (name,))


@pytest.mark.parametrize(
    ("source", "told", "name"),
    [
        ("tacho", {}, "omega"), ("shaft", {}, "omega"), ("J", {}, "omega"), ("spring", {}, "F"),
        ("node", {}, "F"), ("gauge", {}, "F"), ("s", {}, "s"), ("c", {}, "u"),
        ("b", {"signal": "e_b"}, "e_b"), ("turns", {"signal": "phi"}, "phi"),
        ("plate", {"tail_port": "rod"}, "e_plate_rod"), ("plate", {"port": "end"}, "F"),
        ("two", {"signal": "v"}, "v"), ("J", {"signal": sp.Symbol("omega")}, "omega"),
    ],
)  # fmt: skip
def test_what_stands_for_a_port(source: str, told: Mapping[str, object], name: str) -> None:
    """Of detectors what they read, of storages what they give, of junctions what is common there."""
    graph = bg.graph(
        _motor(
            bg.Zero("node"), bg.C("spring", "1/k", effort="F"), bg.De("gauge"),
            bg.Df("turns", integrate="phi"), bg.C("plate", [[2, 1], [1, 3]], ports=["rod", "end"]),
            bg.Sf("in", "v_in"), bg.State("s", "-omega"),
            bg.Controller("c", every=1, gives={"u": "omega"}),
            bg.Controller("two", every=1, states={"w": 0}, update={"w": "omega"}, gives={"v": "w", "q": 1}),
            bg.Function("out", "2*x", ports=["x"]), value="tau",
        ),
        BONDS, "shaft > turns, in > node > spring, node > gauge, shaft > plate.rod, node > plate.end",
    )  # fmt: skip
    graph.add_edge(source, "out", **told)
    assert _wires(graph) == [(source, "out", (name,))]
    element = bg.validate(graph).nodes["out"]["element"]
    assert element.law.expression == 2 * sp.Symbol(name)


def test_ports_are_known_to_their_node_alone() -> None:
    """A port called as a signal of elsewhere, and two that are exchanged."""
    wired = bg.graph(
        [bg.Function("a", "t"), bg.Function("b", "2*t"), bg.Function("d", "a - 3*b", ports=["b", "a"]),
         bg.State("x", "d + a")],
        "a > d.b, b > d.a, d > x",
    )  # fmt: skip
    plain = bg.graph(
        [bg.Function("a", "t"), bg.Function("b", "2*t"), bg.Function("d", "b - 3*a"), bg.State("x", "d + a")]
    )  # fmt: skip
    _same(wired, plain)


def test_what_a_controller_gives_is_named_in_a_path() -> None:
    def made(*paths: str, port: bool) -> Any:
        told = {"ports": ["e"]} if port else {}
        name = "e" if port else "error"
        pi = bg.Controller(
            "pi", every="1/10", states={"z": 0}, update={"z": f"z + {name}"},
            gives={"tau": f"K*{name} + z", "lamp": name}, reads=[name], **told,
        )  # fmt: skip
        return bg.graph(
            _motor(pi, bg.Function("error", "ref - omega"), value=None if paths else "1*tau"), BONDS, *paths
        )  # fmt: skip

    wired = made("J > error > pi.tau > motor", port=True)
    _same(wired, made(port=False))
    assert wired.edges["pi", "motor"] == {"signal": "tau"}
    assert wired.edges["error", "pi"] == {}


def test_two_functions_may_read_each_other() -> None:
    nodes = [bg.Function("a", "b/2 + t"), bg.Function("b", "a/2"), bg.State("x", "a")]
    _same(bg.graph(nodes, "a > b > a > x"), bg.graph(nodes))


@pytest.mark.parametrize("make", [bg.TF, bg.GY])
def test_a_ratio_may_come_by_a_wire(make: Callable[..., Any]) -> None:
    def made(value: object, *paths: str) -> Any:
        nodes = [
            bg.Se("u", "u"), make("mod", value), bg.One("a"), bg.I("m", "m"), bg.Function("x", "1 + t")
        ]  # fmt: skip
        return bg.graph(nodes, "u > mod > a > m", *paths)

    _same(made(None, "x > mod"), made("1*x"))


def test_wires_come_back_from_files() -> None:
    graph = bg.graph(
        _motor(bg.Function("error", "plus - minus", ports=["plus", "minus"]),
               bg.Function("tau", "K*u", ports=["u"]), bg.Function("ref", "sin(t)")),
        BONDS, "ref > error.plus, b > error.minus, error > tau > motor",
    )  # fmt: skip
    graph.edges["b", "error"]["signal"] = "f_b"
    for to_text, from_text in ((bg.to_json, bg.from_json), (bg.to_graphml, bg.from_graphml)):
        back = from_text(to_text(graph))
        assert to_text(back) == to_text(graph)
        assert list(back.edges(data=True)) == list(graph.edges(data=True))
        _same(back, graph)


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ("tacho > f", "wire 'tacho' > 'f': Function 'f' does not read omega; it reads K, e. Write the signal "
         "where it is meant, by this name, or remove the wire"),
        ("f > b", "wire 'f' > 'b': R 'b' does not read f; it reads b"),
        ("f > shaft", "wire 'f' > 'shaft': 1-junction 'shaft' reads nothing; a signal acts on bonds by"),
        ("f > motor, e > motor", "wire 'e' > 'motor': Se 'motor' does not read e, and another wire stands "
         "for its value; write the signal by this name"),
        ("b > gain", "wire 'b' > 'gain': 'b' has several signals, e_b, f_b; name one, signal='e_b'"),
        ("e > gain, f > gain", "wire 'e' > 'gain': Function 'gain' has one port, u, and several wires"),
        ("e > gain.u, f > gain.u", "wire 'e' > 'gain': port 'u' of 'gain' stands for f already"),
        ("e > gain.u, f > gain", "wire 'f' > 'gain': Function 'gain' does not read f, and another wire "
         "stands for all its ports"),
        ("f > e", "wire 'f' > 'e': Function 'e' does not read f; it reads omega, ref"),
        ("e > gain > f", "wire 'gain' > 'f': Function 'f' does not read gain"),
        ("e > sum, f > gain", "wire 'e' > 'sum': Function 'sum' has the ports plus, minus; name one on the "
         "edge, port='plus', or in the path, '... > sum.plus'"),
        ("e > sum.plus", "node 'sum': nothing comes in at its port 'minus'; wire a signal to it"),
        ("drive > gain", "wire 'drive' > 'gain': 'drive' has no signal of its own; wire a detector"),
        ("drive > f", "wire 'drive' > 'f': 'drive' has no signal of its own; wire a detector"),
        ("sum.plus > f", "path 'sum.plus > f': 'plus' is where a signal comes in at 'sum'"),
    ],
)  # fmt: skip
def test_wires_that_say_nothing_are_refused(path: str, message: str) -> None:
    named = path.replace(",", " ").replace(".", " ").split()
    blocks = {
        "gain": bg.Function("gain", "K*u", ports=["u"]),
        "sum": bg.Function("sum", "plus - minus", ports=["plus", "minus"]),
    }
    extra = [node for name, node in blocks.items() if name in named]
    nodes = _motor(
        bg.Function("f", "K*e"), bg.Function("e", "ref - omega"), bg.TF("drive", 2), bg.R("c", "c"), *extra,
        value=None if "motor" in named else "tau",
    )  # fmt: skip
    with pytest.raises(bg.StructureError) as caught:
        bg.validate(bg.graph(nodes, BONDS, "shaft > drive > c", path))
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("told", "message"),
    [
        ({"stroke": "tail"}, "wire 'J' > 'f': unknown attribute 'stroke'; a wire may carry signal"),
        (
            {"signal": "omeg"},
            r"'J' has no signal 'omeg' (did you mean 'omega'?); there are e_J, omega",
        ),
        ({"port": "u"}, "wire 'J' > 'f': 'f' has no port 'u'; leave it out"),
        ({"signal": "e_J"}, "Function 'f' does not read e_J; it reads omega"),
    ],
)
def test_attributes_of_wires_are_checked(told: Mapping[str, object], message: str) -> None:
    graph = bg.graph(_motor(bg.Function("f", "2*omega"), value="tau"), BONDS)
    graph.add_edge("J", "f", **told)
    with pytest.raises(bg.StructureError) as caught:
        bg.validate(graph)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("ports", "message"),
    [
        (["t"], "node 'c': the port t has the name of the time; rename it"),
        (["z"], "node 'c': the port z has the name of what it keeps; rename it"),
        (["a", "a"], "two ports have one name"), ("a", "ports must be a list"),
        (["a b"], "cannot be a symbol"),
    ],
)  # fmt: skip
def test_names_of_ports_are_checked(ports: object, message: str) -> None:
    pi = bg.Controller(
        "c", every=1, states={"z": 0}, update={"z": "z + a"}, gives={"u": "z"}, ports=ports
    )
    with pytest.raises(bg.BondGraphError) as caught:
        bg.validate(bg.graph([pi]))
    assert message in str(caught.value)


def test_paths_begin_with_what_gives_and_end_with_what_reads() -> None:
    nodes = [bg.Function("x", "t"), bg.Controller("c", every=1, gives={"u": "e"}, ports=["e"])]
    with pytest.raises(bg.StructureError, match="'u' is where a signal comes out at 'c'"):
        bg.graph(nodes, "x > c.u")
    with pytest.raises(bg.StructureError, match="'e' is where a signal comes in at 'c'"):
        bg.graph(nodes, "c.e > x")


@pytest.mark.parametrize(
    ("told", "message"),
    [
        ({"outputs": 5}, "node 'c' gives nothing; name what it gives"),
        ({"outputs": "tau"}, "node 'c' gives nothing; name what it gives"),
        ({"outputs": {"u": "1"}, "ports": 5}, "node 'c': ports must be a list of 1 to 64 names, not 5"),
        ({"outputs": {"u": "1"}, "ports": []}, r"node 'c': ports must be a list of 1 to 64 names, not \[\]"),
        ({"outputs": {"u": "1"}, "reads": 3}, "Controller 'c' does not read y"),
        ({"kind": "Memristor"}, "node 'c': unknown kind 'Memristor'"),
        ({"kind": ["R"]}, "node 'c': unknown kind"), ({"kind": None}, "node 'c': unknown kind None"),
    ],
)  # fmt: skip
def test_nodes_at_wires_are_checked(told: Mapping[str, object], message: str) -> None:
    node = ("c", {"kind": "Controller", "every": 1, **told})
    graph = bg.graph([node, bg.Function("x", "2*u"), bg.State("y", "x")], "c > x > y > c")
    with pytest.raises(bg.BondGraphError, match=message):
        bg.validate(graph)


def test_a_terminal_without_attributes_has_no_kind() -> None:
    with pytest.raises(bg.StructureError, match="node 'a' has no kind; give one of"):
        bg.validate(bg.graph(["a", bg.Function("x", "2*a")], "a > x"))


@pytest.mark.parametrize(
    ("own", "other", "message"),
    [
        (
            '"target": "x"',
            '"target": "x", "signal": 1',
            "bond 'y' -> 'x', signal: 1 must be of type str",
        ),
        ('"target": "x"', '"target": "x", "signal": "k"', "'y' has no signal 'k'; there are y"),
        ('"target": "x"', '"target": "x", "port": "r"', "'x' has no port 'r'; there are q"),
        ('"ports": ["q"]', '"ports": [1]', "node 'x', ports: 1 must be of type str"),
        ('"ports": ["q"]', '"ports": ["q", "q"]', "two ports have one name"),
    ],
)
def test_wires_of_files_are_checked(own: str, other: str, message: str) -> None:
    text = bg.to_json(bg.graph([bg.Function("y", "t"), bg.State("x", "q", ports=["q"])], "y > x"))
    assert own in text
    with pytest.raises(bg.BondGraphError, match=message):
        bg.from_json(text.replace(own, other))


def test_a_wire_from_a_node_to_itself_is_refused() -> None:
    graph = bg.graph([bg.State("y", "-y")])
    graph.add_edge("y", "y")
    with pytest.raises(bg.StructureError, match="node 'y' is wired to itself; remove that edge"):
        bg.validate(graph)
