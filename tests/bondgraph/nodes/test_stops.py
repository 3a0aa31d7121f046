"""Stops as they are declared: what they are made of, what is refused, how they are drawn and kept."""

import networkx as nx
import pytest
import sympy as sp

import bondgraph as bg


def _ball(*bonds: tuple[str, str], **stop: object) -> "nx.DiGraph[object]":
    graph: nx.DiGraph[object] = nx.DiGraph()
    graph.add_nodes_from([bg.One("ball"), bg.I("m", "m", flow="v"), bg.Stop("floor", **stop)])
    graph.add_edges_from([("ball", "m"), *(bonds or [("ball", "floor")])])
    return graph


def test_a_bound_is_a_one_sided_switch_whose_gap_the_displacement_opens() -> None:
    derived = bg.derive(_ball(low="a", high="b"))
    place = sp.Symbol("q_floor")
    assert [str(name) for name in derived.integrals] == ["q_floor"]
    low, high = derived.switches
    assert (low.name, low.guard, low.side, low.gap) == (
        "floor.low",
        "stop",
        1,
        place - sp.Symbol("a"),
    )
    assert (high.name, high.side, high.gap) == ("floor.high", -1, sp.Symbol("b") - place)
    assert (low.opening, high.opening, low.held) == (1, -1, "off")


def test_one_bound_alone_has_the_name_of_the_stop() -> None:
    assert [one.name for one in bg.derive(_ball()).switches] == ["floor"]


def test_power_counts_into_it_whichever_way_its_bond_points() -> None:
    there, back = (bg.derive(_ball(bond)) for bond in (("ball", "floor"), ("floor", "ball")))
    assert there.B == back.B
    assert there.switches[0].side == back.switches[0].side == 1


def test_a_switch_that_says_the_same_is_one_too() -> None:
    graph: nx.DiGraph[object] = nx.DiGraph()
    graph.add_nodes_from([
        bg.One("ball"), bg.I("m", "m", flow="v"), bg.Df("at", integrate="x"),
        bg.Sw("wall", on="-2*e_wall", off="3*(x - 1)"),
    ])  # fmt: skip
    graph.add_edges_from([("ball", "m"), ("ball", "at"), ("ball", "wall")])
    (wall,) = bg.derive(graph).switches
    assert (wall.guard, wall.side, wall.gap, wall.opening) == ("stop", -1, 1 - sp.Symbol("x"), -1)


@pytest.mark.parametrize("off", ["x - v", "x*v", "2*v - x", "abs(x)"])
def test_other_conditions_are_general(off: str) -> None:
    graph: nx.DiGraph[object] = nx.DiGraph()
    graph.add_nodes_from([
        bg.One("ball"), bg.I("m", "m", flow="v"), bg.Df("at", integrate="x"),
        bg.Sw("wall", on="-e_wall", off=off),
    ])  # fmt: skip
    graph.add_edges_from([("ball", "m"), ("ball", "at"), ("ball", "wall")])
    assert [one.guard for one in bg.derive(graph).switches] == ["general"]


@pytest.mark.parametrize(
    ("stop", "told"),
    [
        ({"low": None}, "without a bound"),
        ({"low": 1, "high": 1}, "low 1 is not below high 1"),
        ({"restitution": 2}, "restitution 2 is not between 0 and 1"),
        ({"damping": 3}, "damping belongs to a stop with a stiffness"),
        ({"stiffness": 3, "restitution": "e"}, "not both"),
    ],
)
def test_what_stops_nothing_is_refused(stop: dict[str, object], told: str) -> None:
    with pytest.raises(bg.StructureError, match=told):
        bg.validate(_ball(**stop))


def test_what_yields_pushes_back_and_never_pulls() -> None:
    law = bg.derive(_ball(high=1, stiffness="k", damping="d")).laws
    at = {"q_floor": 2, "k": 10, "d": 3}
    values = [law["floor.high"].expression.subs({**at, "f_floor_high": f}) for f in (2, -1, -9)]
    assert values == [16, 7, 0]
    assert law["floor.low"].expression.subs({**at, "f_floor_low": 2}) == 0
    assert law["floor.low"].expression.subs({**at, "q_floor": -2, "f_floor_low": -1}) == -23


def test_files_keep_it_and_prefixes_rename_it() -> None:
    graph = _ball(low="a", high="b", restitution="e", start="(a + b)/2")
    for again in (bg.from_json(bg.to_json(graph)), bg.from_graphml(bg.to_graphml(graph))):
        found = bg.derive(again)
        assert found.switches == bg.derive(graph).switches
        assert found.starts == {sp.Symbol("q_floor"): (sp.Symbol("a") + sp.Symbol("b")) / 2}
    left = bg.derive(bg.prefixed(graph, "left_"))
    assert [one.gap for one in left.switches] == [
        sp.Symbol("q_left_floor") - sp.Symbol("a"), sp.Symbol("b") - sp.Symbol("q_left_floor"),
    ]  # fmt: skip


def test_it_is_drawn_as_one() -> None:
    text = bg.drawing(_ball(high="h")).text()
    assert "Stop: 0 ≤ q_floor ≤ h" in text
    assert "Df" not in text
