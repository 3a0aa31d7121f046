"""Strokes judged: by hand, and against every assignment that brute force finds."""

import random
from itertools import islice

import pytest
from references.brute_force import given_by, regular, regular_port_choices, valid_strokes
from references.build import Graph, bond_graph
from references.random_graphs import random_graph
from soak.families import seeds

import bondgraph as bg

NODES = [
    bg.Se("push", "F"), bg.One("mass"), bg.I("m", "m"), bg.R("drag", "b"), bg.TF("lever", "n"),
    bg.I("J", "J"),
]  # fmt: skip
BONDS = "push>mass>m mass>drag mass>lever>J"
GOOD = {
    ("push", "mass"): "mass", ("mass", "m"): "m", ("mass", "drag"): "mass", ("mass", "lever"): "mass",
    ("lever", "J"): "lever",
}  # fmt: skip


def _judged(**turned: str) -> dict[str, tuple[str, object]]:
    """The verdicts by the bond's second node, with strokes at other ends, or left out by an empty text."""
    drawn = {bond: turned.get(bond[1], end) for bond, end in GOOD.items()}
    found = bg.check(bond_graph(NODES, BONDS), strokes={b: e for b, e in drawn.items() if e})
    return {one.bond[1]: (one.verdict, one.node) for one in found.strokes}


def test_the_engines_own_strokes_are_right() -> None:
    graph = bond_graph(NODES, BONDS)
    assert dict(bg.assign_causality(graph).strokes) == GOOD
    found = bg.check(graph, strokes=GOOD)
    assert {one.verdict for one in found.strokes} == {"right"}
    assert len(found) == 0


def test_the_other_of_two_rigidly_coupled_inertias_may_be_the_state() -> None:
    other = {"m": "mass", "lever": "lever", "J": "J"}
    assert {verdict for verdict, _ in _judged(**other).values()} == {"right"}


def test_a_source_a_transformer_and_a_junction_have_their_rules() -> None:
    assert _judged(mass="push")["mass"] == ("wrong", "push")
    assert _judged(J="J")["J"] == ("wrong", "lever")
    assert _judged(drag="drag")["drag"] == ("wrong", "mass")


def test_derivative_causality_without_need_is_not_preferred() -> None:
    found = _judged(m="mass", drag="drag")
    assert found["m"] == ("not preferred", "m")
    assert [verdict for verdict, _ in found.values()].count("right") == 4


def test_what_is_missing_follows_or_is_free() -> None:
    graph = bond_graph(NODES, BONDS)
    found = bg.check(graph, strokes={("mass", "drag"): "drag"})
    told = {one.bond[1]: one for one in found.strokes}
    assert told["drag"].verdict == "not preferred"
    assert told["m"].text.startswith(
        "it has to be at 'mass': 1-junction 'mass' takes its flow from one"
    )
    assert told["mass"].text.startswith("it has to be at 'mass': Se 'push' imposes its effort")
    (missing,) = (one for one in found if one.kind == "hint")
    assert missing.text.startswith("without a stroke: 'push' -> 'mass', 'mass' -> 'm'")
    free = bg.check(graph, strokes={("push", "mass"): "mass"}).strokes[1]
    assert free.text == "no stroke is drawn, and none follows yet; at 'm' it would be preferred"


def test_strokes_as_attributes_of_bonds_and_in_files() -> None:
    graph = bond_graph(NODES, BONDS)
    for (tail, head), end in GOOD.items():
        graph.edges[tail, head]["stroke"] = "tail" if end == tail else "head"
    for again in (graph, bg.from_json(bg.to_json(graph)), bg.from_graphml(bg.to_graphml(graph))):
        found = bg.check(again)
        assert [one.verdict for one in found.strokes] == ["right"] * 5
        assert bg.derive(again).A == bg.derive(bond_graph(NODES, BONDS)).A
    copied = bg.check(bg.prefixed(graph, "left_"))
    assert [one.verdict for one in copied.strokes] == ["right"] * 5


def test_strokes_that_mean_nothing_are_refused() -> None:
    graph = bond_graph(NODES, BONDS)
    with pytest.raises(bg.StructureError, match="no bond"):
        bg.check(graph, strokes={("mass", "push"): "mass"})
    with pytest.raises(bg.StructureError, match="no end of bond"):
        bg.check(graph, strokes={("push", "mass"): "m"})
    graph.edges["push", "mass"]["stroke"] = "tail"
    with pytest.raises(bg.StructureError, match="is told to have it at"):
        bg.check(graph, strokes=GOOD)
    graph.edges["push", "mass"]["stroke"] = "mass"
    with pytest.raises(bg.StructureError, match="'tail' or 'head'"):
        bg.check(graph)


def test_complete_strokes_whose_loop_has_no_solution_are_doubted() -> None:
    """A ring of two paths that are equal: the rules are kept, and nothing says how power divides."""
    for graph in islice(_singular(), 3):
        strokes = next(one for one in valid_strokes(graph) if _choice(graph, one) is None)
        found = bg.check(graph, strokes=strokes)
        assert "wrong" not in {one.verdict for one in found.strokes}
        assert any("no solution" in one.text for one in found)


def _choice(graph: Graph, strokes: dict[tuple[str, str], str]) -> dict[str, str] | None:
    given = given_by(graph, strokes)
    return next((one for one in regular_port_choices(graph) if one == given), None)


def _singular() -> "list[Graph]":
    """Small graphs of which some strokes keep all rules and still are singular."""
    found = []
    for seed in range(2_000):
        graph = random_graph(random.Random(seed), 8, mesh=0.5)
        if graph.number_of_edges() <= 8 and regular(graph):
            strokes = valid_strokes(graph)
            if any(_choice(graph, one) is None for one in strokes):
                found.append(graph)
        if len(found) == 3:
            break
    return found


@pytest.mark.parametrize("seed", seeds("drawn-strokes"))
def test_random_strokes_against_all_that_are_possible(seed: int) -> None:
    rng = random.Random(seed)
    graph = random_graph(rng, rng.randint(4, 10), mesh=0.7)
    possible = valid_strokes(graph)
    if not regular(graph) or not possible:
        return
    base = rng.choice(possible)
    flips = {bond for bond in graph.edges if rng.random() < 0.2}
    drawn = {
        (a, b): (a if base[a, b] == b else b) if (a, b) in flips else base[a, b]
        for a, b in graph.edges if rng.random() < 0.7
    }  # fmt: skip
    _held_against_all(graph, drawn)


@pytest.mark.parametrize("seed", [772, 822, 2130, 2628, 3270])
def test_strokes_in_rings_against_all_that_are_possible(seed: int) -> None:
    """Rules that are broken far from the stroke, and strokes that only together leave no others."""
    rng = random.Random(seed)
    graph = random_graph(rng, rng.randint(6, 12), mesh=0.8)
    assert graph.number_of_edges() <= 8
    drawn = {bond: rng.choice(bond) for bond in graph.edges if rng.random() < 0.4}
    _held_against_all(graph, drawn)


def _held_against_all(graph: Graph, drawn: dict[tuple[str, str], str]) -> None:
    """Strokes that are not wrong go together; each wrong one goes with none of what they leave."""
    found = {one.bond: one for one in bg.check(graph, strokes=drawn).strokes}
    assert bool(found) == bool(drawn)
    kept = {bond: end for bond, end in drawn.items() if found[bond].verdict != "wrong"}
    left = [one for one in valid_strokes(graph) if kept.items() <= one.items()]
    assert left
    for bond, one in found.items():
        if one.verdict == "wrong":
            assert all(other[bond] != drawn[bond] for other in left), bond
        if one.verdict == "missing" and one.text.startswith("it has to be at "):
            assert {repr(other[bond]) for other in left} == {one.text.split()[5].rstrip(":")}


@pytest.mark.parametrize("seed", seeds("drawn-causality"))
def test_as_many_storages_are_blamed_as_have_derivative_causality_without_need(seed: int) -> None:
    rng = random.Random(seed)
    graph = random_graph(rng, rng.randint(3, 8), mesh=0.3)
    choices = regular_port_choices(graph)
    possible = [one for one in valid_strokes(graph) if given_by(graph, one) in choices]
    if not regular(graph) or not possible:
        return
    drawn = rng.choice(possible)
    dependent = [_derivative(graph, one) for one in choices]
    fewest = min(map(len, dependent))
    own = _derivative(graph, given_by(graph, drawn))
    excused = max(len(own & one) for one in dependent if len(one) == fewest)
    found = bg.check(graph, strokes=drawn).strokes
    assert {one.verdict for one in found} <= {"right", "not preferred"}
    blamed = {one.node for one in found if one.verdict == "not preferred"}
    assert len(blamed) == len(own) - excused
    assert blamed <= own


def _derivative(graph: Graph, given: dict[str, str]) -> set[str]:
    prefers = {"I": "flow", "C": "effort"}
    kinds = {node: graph.nodes[node]["kind"] for node in given}
    return {n for n, gives in given.items() if kinds[n] in prefers and gives != prefers[kinds[n]]}


def _dragged(*, drag: bool) -> Graph:
    nodes = [bg.Se("push", "F"), bg.One("mass"), bg.I("m", "m"), *[bg.R("drag", "b")] * drag]
    return bond_graph(nodes, "push>mass>m" + " mass>drag" * drag)


def test_derivative_causality_is_judged_where_it_is_asked() -> None:
    """By hand: the drag may give the flow, F/b, which the mass then receives, its stroke at the junction."""
    derivative = {("push", "mass"): "mass", ("mass", "m"): "mass", ("mass", "drag"): "drag"}
    integral = {("push", "mass"): "mass", ("mass", "m"): "m", ("mass", "drag"): "mass"}
    graph = _dragged(drag=True)
    for strokes, asked, other in ((derivative, True, False), (integral, False, ["m"])):
        assert len(bg.check(graph, strokes=strokes, derivative=asked)) == 0
        found = bg.check(graph, strokes=strokes, derivative=other)
        assert {one.verdict for one in found.strokes} == {"right", "not preferred"}
        assert len(found.doubts) == 1
    assert "has integral causality, though it could have derivative: receive the flow" in str(found)


def test_a_hint_names_what_cannot_have_derivative_causality() -> None:
    """Nothing but the mass itself tells the speed under a force."""
    assert len(bg.check(_dragged(drag=True), derivative=True)) == 0
    (hint,) = (
        one for one in bg.check(_dragged(drag=False), derivative=True) if one.rule == "causality"
    )
    assert (hint.kind, hint.node) == ("hint", "m")
    with pytest.raises(bg.StructureError, match="'drag' is no storage"):
        bg.check(_dragged(drag=True), derivative=["drag"])
