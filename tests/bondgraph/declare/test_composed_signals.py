"""Parts with functions, states and controllers, copied under prefixes: signals carry them, ports do not."""

from typing import Any

import networkx as nx
import numpy as np
import pytest
import sympy as sp

import bondgraph as bg
import codegen

BONDS = "motor > shaft > J, shaft > b"


def _axis(*nodes: Any, value: object = "1*tau") -> list[Any]:
    return [
        bg.Se("motor", value),
        bg.One("shaft"),
        bg.I("J", "J", flow="omega"),
        bg.R("b", "b"),
        *nodes,
    ]


def _pi() -> Any:
    return bg.Controller(
        "pi",
        every="1/20",
        states={"z": 0},
        update={"z": "z + T*e"},
        gives={"tau": "K*e + z"},
        reads=["e"],
    )


def by_names() -> Any:
    """A sampled loop whose error is a function, whose reference a state with a bound that is a parameter."""
    nodes = _axis(bg.Function("e", "r - omega"), bg.State("r", "a", high="most"), _pi())
    return bg.graph(nodes, BONDS)


def by_wires() -> Any:
    nodes = _axis(
        bg.Function("e", "plus - minus", ports=["plus", "minus"]), bg.State("r", "a", high="most"), _pi(),
        value=None,
    )  # fmt: skip
    return bg.graph(nodes, BONDS, "r > e.plus, J > e.minus, e > pi > motor")


NUMBERS = {"J": 0.5, "b": 0.2, "K": 2.0, "T": 0.1, "a": 4.0, "most": 1.5}


def _run(graph: Any, numbers: dict[str, float]) -> Any:
    return codegen.simulator(bg.derive(graph), numbers).run(np.linspace(0, 1, 11))


@pytest.mark.parametrize("part", [by_names, by_wires])
def test_a_prefixed_part_runs_as_the_part(part: Any) -> None:
    alone = _run(part(), NUMBERS)
    copied = _run(bg.prefixed(part(), "left_"), NUMBERS)
    for name in ("omega", "tau", "z", "r", "e"):
        assert np.array_equal(copied[f"left_{name}"], alone[name]), name
    assert float(alone["omega"][-1]) > 0.5


@pytest.mark.parametrize("part", [by_names, by_wires])
def test_two_parts_are_controlled_each_by_its_own(part: Any) -> None:
    """Side by side they run as alone; each with its own inertia."""
    both = bg.assemble(
        bg.prefixed(part(), "left_", parameters=["J"]), bg.prefixed(part(), "right_", parameters=["J"])
    )  # fmt: skip
    with pytest.raises(bg.StructureError, match="share neither a bond nor a signal"):
        bg.derive(both)
    both.add_nodes_from(
        [bg.Function("apart", "left_omega - right_omega"), bg.State("far", "apart")]
    )
    numbers = {name: value for name, value in NUMBERS.items() if name != "J"}
    run = _run(both, {**numbers, "left_J": 0.5, "right_J": 0.25})
    for side, inertia in (("left", 0.5), ("right", 0.25)):
        alone = _run(part(), {**NUMBERS, "J": inertia})
        assert np.allclose(run[f"{side}_omega"], alone["omega"], rtol=1e-9, atol=1e-12)
    assert [str(task.name) for task in bg.derive(both).tasks] == ["left_pi", "right_pi"]


def test_names_of_signals_and_of_their_parts_carry_the_prefix() -> None:
    part = bg.prefixed(by_names(), "l_")
    assert part.nodes["l_pi"]["states"] == {"l_z": 0}
    assert part.nodes["l_pi"]["reads"] == ["l_e"]
    assert {*part.nodes["l_pi"]["outputs"]} == {"l_tau"}
    assert part.nodes["l_r"] == {"kind": "State", "rate": "a", "high": "most"}
    assert part.nodes["l_e"]["value"] == sp.Symbol("l_r") - sp.Symbol("l_omega")
    assert part.nodes["l_motor"]["value"] == "1*l_tau"
    reading = bg.graph(
        [bg.Function("x", "e_pi_z + rate_r + f_e + e_r_high"), *by_names().nodes(data=True)]
    )
    assert bg.prefixed(reading, "l_").nodes["l_x"]["value"] == sp.sympify(
        "e_l_pi_l_z + rate_l_r + f_l_e + e_l_r_high"
    )


def test_ports_are_nobodys_names() -> None:
    part = bg.prefixed(by_wires(), "l_", parameters=True)
    assert part.nodes["l_e"] == {
        "kind": "Function",
        "value": "plus - minus",
        "ports": ["plus", "minus"],
    }
    assert part.edges["l_J", "l_e"] == {"port": "minus"}
    assert part.nodes["l_J"]["value"] == "l_J"
    with pytest.raises(
        bg.StructureError, match="parameters: 'plus' is not a parameter of the part"
    ):
        bg.prefixed(by_wires(), "l_", parameters=["plus"])


def test_signals_named_on_wires_carry_the_prefix() -> None:
    nodes = _axis(bg.Function("f", "2*u", ports=["u"]), bg.State("x", "-f"), value="tau")
    graph = bg.graph(nodes, BONDS)
    graph.add_edge("b", "f", signal="e_b")
    graph.add_edge("J", "x", signal="omega")
    graph.nodes["x"]["rate"] = "omega - f"
    part = bg.prefixed(graph, "l_")
    assert part.edges["l_b", "l_f"] == {"signal": "e_l_b"}
    assert part.edges["l_J", "l_x"] == {"signal": "l_omega"}
    assert bg.derive(part).A == bg.derive(graph).A


def test_a_kept_signal_is_a_terminal() -> None:
    """One reference for two axes: a function of elsewhere, which keeps its name or gets another."""
    axis = bg.graph(_axis(bg.Function("tau", "K*(ref - omega)")), BONDS)
    wired = bg.graph(["ref", *_axis(bg.Function("tau", "K*(ref - omega)"))], BONDS, "ref > tau")
    reference = bg.graph([bg.Function("goal", "sin(t)")])
    by_wire = bg.assemble(
        bg.prefixed(wired, "l_", keep={"ref": "goal"}),
        bg.prefixed(wired, "r_", keep={"ref": "goal"}), reference,
    )  # fmt: skip
    by_name = bg.assemble(
        bg.prefixed(axis, "l_"), bg.prefixed(axis, "r_"), bg.graph([bg.Function("ref", "sin(t)")])
    )
    omega, K, J, b, t = sp.symbols("l_omega K J b t")
    for graph in (by_wire, by_name):
        rate = bg.explicit(bg.derive(graph))[omega]
        assert sp.expand(rate - (K * (sp.sin(t) - omega) - b * omega) / J) == 0
    assert ("goal", "l_tau") in by_wire.edges


def test_a_kept_function_keeps_its_name() -> None:
    part = bg.prefixed(by_wires(), "l_", keep={"e": "error"})
    assert part.nodes["l_pi"]["reads"] == ["error"]
    assert part.nodes["l_pi"]["outputs"]["l_tau"] == sp.sympify("K*error + l_z")
    kept = bg.prefixed(by_wires(), "l_", keep=["pi"])
    assert {*kept.nodes["pi"]["states"]} == {"z"}
    assert {*kept.nodes["pi"]["outputs"]} == {"tau"}


def test_a_python_function_goes_on_with_the_names_that_it_knows() -> None:
    def step(now: Any) -> dict[str, float]:
        return {"z": now["z"] + 0.1 * now["e"], "tau": 2 * now["e"] + now["z"]}

    def made(**more: Any) -> Any:
        return bg.Controller("pi", every="1/20", states={"z": 0}, gives=["tau"], step=step, **more)

    named = bg.graph(_axis(bg.Function("e", "3 - omega"), made(reads=["e"])), BONDS)
    wired = bg.graph(
        _axis(bg.Function("off", "3 - omega"), made(reads=["e"], ports=["e"]), value=None), BONDS,
        "J > off > pi > motor",
    )  # fmt: skip
    told = bg.graph(
        _axis(bg.Function("e", "3 - omega"),
              bg.Controller("pi", every="1/20", states={"z": 0}, update={"z": "z + e/10"},
                            gives={"tau": "2*e + z"})),
        BONDS,
    )  # fmt: skip
    right = _run(told, {"J": 0.5, "b": 0.2})["omega"]
    for graph, name in ((named, "omega"), (wired, "omega"), (bg.prefixed(wired, "l_"), "l_omega")):
        assert np.allclose(_run(graph, {"J": 0.5, "b": 0.2})[name], right, rtol=1e-9, atol=1e-12)
    with pytest.raises(
        bg.FileFormatError, match="its step is a Python function, which no file can hold"
    ):
        bg.to_json(named)


def test_a_part_that_reads_a_table_is_copied() -> None:
    table = bg.LookupTable("map", [0, 1], [2, 4])
    part = bg.graph(
        [bg.State("s", "map(u)"), bg.Controller("c", every=1, gives={"u": "map(s)/8"})],
        tables=[table],
    )
    task = bg.derive(bg.prefixed(part, "l_")).tasks[0]
    assert float(task.resets[0].value.subs("l_s", 0.5)) == pytest.approx(3 / 8)


def test_merging_keeps_wires_and_what_they_start_from() -> None:
    """Two 1-junctions become one; a junction that only hands on stays where a wire leads on from it."""
    nodes = [
        bg.Se("motor"), bg.One("a"), bg.I("J", "J"), bg.One("b"), bg.R("R", "R"), bg.Zero("n"),
        bg.TF("gear", "m"), bg.One("c"), bg.I("m", "m_2"), bg.Function("tau", "K*(ref - w)", ports=["w"]),
        bg.Function("p", "u**2", ports=["u"]), bg.State("x", "p"),
    ]  # fmt: skip
    graph = bg.graph(
        nodes, "motor > a > J, a > b > R, b > n > gear > c > m", "b > tau > motor, n > p > x"
    )  # fmt: skip
    small = bg.merged(graph)
    assert "b" not in small or "a" not in small
    assert "n" in small
    assert "c" not in small
    wires = {(tail, head) for tail, head in small.edges if {tail, head} & {"tau", "p", "x"}}
    assert {head for _, head in wires} == {"tau", "motor", "p", "x"}
    names = sp.symbols("f_J x")
    one, other = (bg.explicit(bg.derive(one)) for one in (graph, small))
    shared = {sp.Symbol("f_a"): names[0], sp.Symbol("f_b"): names[0]}
    for state in other:
        assert sp.simplify(one[state].xreplace(shared) - other[state].xreplace(shared)) == 0


def test_checks_see_through_signals() -> None:
    wired = by_wires()
    assert len(bg.check(wired, parameters=NUMBERS)) == 0
    (found,) = bg.check(wired, parameters={**NUMBERS, "mots": 1})
    assert "no value or law reads the parameter mots" in str(found)
    (found,) = bg.check(wired, parameters={**NUMBERS, "r": 1})
    assert "r is a signal of the graph, not a parameter" in str(found)
    (found,) = bg.check(wired, parameters={**NUMBERS, "plus": 1})
    assert "no value or law reads the parameter plus" in str(found)
    backwards = bg.graph(
        _axis(bg.Function("tau", "K*omega"), value=None), "shaft > motor, shaft > J, shaft > b",
        "J > tau > motor",
    )  # fmt: skip
    (found,) = bg.check(backwards)
    assert "no source supplies power" in str(found)


def test_strokes_are_judged_of_bonds_alone() -> None:
    graph = by_wires()
    graph.edges["shaft", "J"]["stroke"] = "head"
    verdicts = bg.check(graph).strokes
    assert [one.bond for one in verdicts] == [("motor", "shaft"), ("shaft", "J"), ("shaft", "b")]
    with pytest.raises(bg.StructureError, match=r"there is no bond \('J', 'e'\)"):
        bg.check(by_wires(), strokes={("J", "e"): "e"})


def test_modes_of_graphs_with_signals() -> None:
    nodes = [
        bg.Se("E"), bg.One("wire"), bg.Sw("key", on="u - 1"), bg.C("cap", "C"), bg.R("R", "R"),
        bg.Function("u", "3*sin(t)"), bg.Function("v", "x + 5"), bg.State("x", "-x + e_cap"),
    ]  # fmt: skip
    graph = bg.graph(nodes, "E > wire > key, wire > cap, wire > R", "u > key, v > E, cap > x > v")
    closed = bg.explicit(bg.derive(bg.in_mode(graph, on=["key"])))
    e, x, R, C = sp.symbols("e_cap x R C")
    assert sp.expand(closed[e] - (x + 5 - e) / (R * C)) == 0
    assert bg.explicit(bg.derive(bg.in_mode(graph)))[e] == 0
    assert isinstance(graph, nx.DiGraph)
