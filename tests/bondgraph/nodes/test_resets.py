"""What may be reset, and how: names, refusals, prefixes, files, explanations, drawings."""

import networkx as nx
import pytest
import sympy as sp
from references.build import bond_graph

import bondgraph as bg

STOP = {"n": "n + 1"}
BOTH = {"on": {"v": "v/2", "n": "n + 1"}, "off": {sp.Symbol("v"): 3}}


def _graph(switch: object, stop: object = None) -> nx.DiGraph:
    """A mass that a spring holds between stops, a count, and a switch that carries no power."""
    nodes = [
        bg.One("mass"), bg.I("m", "m", flow="v"), bg.C("spring", "1/k", effort="F"),
        bg.Stop("end", low=None, high="L", reset=stop), bg.One("pivot"), bg.R("rest", 1),
        bg.Sw("sw", on="F - 1", reset=switch), bg.Df("counter", integrate="n"),
    ]  # fmt: skip
    return bond_graph(nodes, "mass>m mass>spring mass>end pivot>rest pivot>sw pivot>counter")


def _told(graph: nx.DiGraph) -> list[tuple[str, str, sp.Expr, str]]:
    return [
        (str(one.name), str(reset.state), reset.value, reset.event)
        for one in bg.derive(graph).switches for reset in one.switch.resets
    ]  # fmt: skip


def test_states_are_reset_as_it_turns_on_or_both_ways_and_at_impacts() -> None:
    v, n = sp.symbols("v n")
    assert _told(_graph({"v": "-v"}, STOP)) == [("end", "n", n + 1, "hit"), ("sw", "v", -v, "on")]
    assert _told(_graph(BOTH)) == [
        ("sw", "v", v / 2, "on"), ("sw", "n", n + 1, "on"), ("sw", "v", sp.Integer(3), "off")
    ]  # fmt: skip
    assert _told(_graph({})) == []


@pytest.mark.parametrize(
    ("switch", "stop", "says"),
    [
        ("v", None, "node 'sw': reset is 'v'; it must map names of states"),
        ({"up": {"v": 0}}, None, "reset at 'up'; there is 'on', 'off'"),
        ({"on": {"v": 0}, "v": 1}, None, "reset at 'v'; there is 'on', 'off'"),
        ({"v": 0, sp.Symbol("v"): 1}, None, "v is reset twice at one event"),
        ({"w": 0}, None, "node 'sw': reset of w, which is no state; there is v, F, q_end, n"),
        (None, {"m": 1}, "node 'end': reset of m, which is no state"),
        (None, {"on": {"v": 1}}, "reset at 'on'; there is 'hit'"),
    ],
)  # fmt: skip
def test_what_is_refused(switch: object, stop: object, says: str) -> None:
    with pytest.raises(bg.StructureError, match=says):
        bg.derive(_graph(switch, stop))


def test_what_follows_from_states_is_not_reset() -> None:
    nodes = [bg.One("n"), bg.I("m", "m", flow="v"), bg.I("m2", "m2", flow="v2", priority=-1),
             bg.Sw("sw", on="t - 1", reset={"v2": 0})]  # fmt: skip
    with pytest.raises(bg.StructureError, match="reset of v2: the storage 'm2' is dependent"):
        bg.derive(bond_graph(nodes, "n>m n>m2 n>sw"))


def test_a_stop_that_yields_has_no_impacts() -> None:
    with pytest.raises(bg.StructureError, match="a stop that yields has no impacts"):
        bg.derive(bond_graph(
            [bg.One("n"), bg.I("m", 1), bg.Stop("s", stiffness=9, reset={"q_s": 0})], "n>m n>s"
        ))  # fmt: skip


def test_a_controlled_junction_resets_too() -> None:
    nodes = [bg.Se("u", "u"), bg.One("valve", on="t - 1", reset={"h": "0*h"}), bg.R("r", 1),
             bg.C("tank", 1, effort="h")]  # fmt: skip
    assert [told[1:] for told in _told(bond_graph(nodes, "u>valve>r valve>tank"))] == [
        ("h", 0, "on")
    ]


def test_a_prefix_renames_states_and_what_they_become() -> None:
    part = bg.prefixed(_graph(BOTH, STOP), "left_", parameters=True)
    v, n = sp.symbols("left_v left_n")
    assert _told(part) == [
        ("left_end", "left_n", n + 1, "hit"), ("left_sw", "left_v", v / 2, "on"),
        ("left_sw", "left_n", n + 1, "on"), ("left_sw", "left_v", sp.Integer(3), "off"),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("write", "read"), [(bg.to_json, bg.from_json), (bg.to_graphml, bg.from_graphml)]
)
def test_files_keep_resets(write: object, read: object) -> None:
    graph = _graph(BOTH, STOP)
    assert _told(read(write(graph))) == _told(graph)


@pytest.mark.parametrize("reset", ['{"v": ["2"]}', '{"on": {"v": {}}}', '["v"]'])
def test_files_with_something_else_are_refused(reset: str) -> None:
    text = bg.to_json(_graph({"v": "17"}))
    assert '{"v": "17"}' in text
    with pytest.raises(bg.FileFormatError, match="node 'sw', reset"):
        bg.from_json(text.replace('{"v": "17"}', reset))


def test_explanations_and_drawings_tell() -> None:
    text = " ".join(str(bg.explain(_graph({"v": "v/2"}, STOP))).split())
    assert "as it turns on v becomes v/2" in text
    assert "at each impact n becomes n + 1" in text
    drawn = bg.drawing(_graph({"v": "v/2"}, STOP)).text()
    assert "v := v/2" in drawn
    assert "n := n + 1" in drawn


def test_a_linear_model_is_the_same_with_resets() -> None:
    """They act at events, about which nothing is linear."""
    kept, reset = (
        bg.linearize(bg.derive(_graph(one)), mode={"sw": "off", "end": "apart"})
        for one in (None, {"v": "-v"})
    )
    assert (kept.A, kept.J, kept.B) == (reset.A, reset.J, reset.B)
