"""`assign_causality`: strokes, the choice of storages, priority, and the words of `why`."""

import random

import pytest
from references.brute_force import regular, valid_strokes
from references.build import Graph, bond_graph, shuffled
from references.random_graphs import chain, random_graph

import bondgraph as bg


def _assert_obeyed(graph: Graph, causal: bg.CausalGraph) -> None:
    """The rule of every node: how many of its bonds bring it their effort."""
    assert set(causal.strokes) == set(graph.edges)
    for name, attributes in graph.nodes(data=True):
        bonds = [bond for bond in graph.edges if name in bond]
        assert all(causal.strokes[bond] in bond for bond in bonds)
        count = sum(causal.strokes[bond] == name for bond in bonds)
        allowed = {
            "Se": {0}, "Sf": {1}, "TF": {1}, "GY": {0, 2}, "Zero": {1}, "One": {len(bonds) - 1},
            "I": {0, 1}, "C": {0, 1}, "R": {0, 1},
        }[attributes["kind"]]  # fmt: skip
        if attributes["kind"] == "R" and attributes.get("value") is None:
            allowed = {int(attributes.get("gives") == "flow")}
        assert count in allowed, name


@pytest.mark.parametrize("seed", range(100))
def test_every_node_has_its_strokes(seed: int) -> None:
    rng = random.Random(seed)
    graph = random_graph(rng, rng.randint(3, 40))
    if regular(graph):
        causal = bg.assign_causality(graph)
        _assert_obeyed(graph, causal)
        for name, attributes in graph.nodes(data=True):
            if attributes["kind"] in ("I", "C"):
                (bond,) = (bond for bond in graph.edges if name in bond)
                gives_flow = causal.strokes[bond] == name
                integral = gives_flow == (attributes["kind"] == "I")
                assert name in (causal.integral if integral else causal.derivative)


@pytest.mark.parametrize("seed", range(100, 140))
def test_strokes_of_a_small_graph_are_among_all_valid_ones(seed: int) -> None:
    rng = random.Random(seed)
    graph = random_graph(rng, rng.randint(3, 8))
    if regular(graph):
        assert dict(bg.assign_causality(graph).strokes) in valid_strokes(graph)


def test_first_valid_strokes_may_be_singular_and_are_then_given_up() -> None:
    """Strokes allow C0 in integral causality, but the loop of the three junctions is then singular."""
    nodes = [
        bg.One("j0"),
        bg.One("j1"),
        bg.Zero("j2"),
        bg.C("C0", "c0"),
        bg.C("C2", "c2"),
        bg.Se("Se", "u"),
    ]
    graph = bond_graph(nodes, "j1>j0 j2>j0 j1>j2 j0>C0 Se>j1 j2>C2")
    causal = bg.assign_causality(graph)
    assert (causal.integral, causal.derivative) == (("C2",), ("C0",))
    _assert_obeyed(graph, causal)
    assert "otherwise its loop would be singular" in " ".join(causal.why("C0"))


def test_first_declared_storage_may_be_the_dependent_one_in_a_mesh() -> None:
    """The bond between j0 and j1 makes their flows equal, so that none is left for I4 at z."""
    nodes = [
        bg.Se("Se", "u"), bg.One("j1"), bg.One("j0"), bg.Zero("z"), bg.I("I4", "i4"), bg.I("I3", "i3"),
        bg.I("I6", "i6"),
    ]  # fmt: skip
    causal = bg.assign_causality(bond_graph(nodes, "Se>j1>I6 j1>z I3>j0 z>j0 z>I4 j0>j1"))
    assert (causal.integral, causal.derivative) == (("I3",), ("I4", "I6"))


def test_compliance_in_a_mesh_that_an_open_port_drives_is_dependent() -> None:
    nodes = [
        bg.R("R", "r"), bg.C("C", "c"), bg.TF("TF", "m"), bg.One("j0"), bg.Zero("z"), bg.One("j2"),
        bg.R("open"),
    ]  # fmt: skip
    causal = bg.assign_causality(bond_graph(nodes, "R>z C>TF>j0 z>j0 j2>z j2>open j2>j0"))
    assert (causal.integral, causal.derivative) == ((), ("C",))


def _shaft(*inertias: object) -> Graph:
    nodes = [bg.Se("s", "u"), bg.One("j"), *inertias]
    return bond_graph(nodes, "s>j " + " ".join(f"j>{name}" for name, _ in inertias))


def test_earlier_storage_is_the_state_of_two_that_move_together() -> None:
    causal = bg.assign_causality(_shaft(bg.I("a", "a"), bg.I("b", "b")))
    assert (causal.integral, causal.derivative) == (("a",), ("b",))


@pytest.mark.parametrize(
    "inertias",
    [
        (bg.I("a", "a"), bg.I("b", "b", priority=1)),
        (bg.I("a", "a", priority=-0.5), bg.I("b", "b")),
        (bg.I("a", "a", priority=-2), bg.I("b", "b", priority=-1)),
    ],
)
def test_higher_priority_is_the_state_of_two_that_move_together(inertias: tuple) -> None:
    causal = bg.assign_causality(_shaft(*inertias))
    assert (causal.integral, causal.derivative) == (("b",), ("a",))


@pytest.mark.parametrize("seed", range(200, 260))
def test_priority_acts_like_the_order_of_declaration(seed: int) -> None:
    rng = random.Random(seed)
    graph = random_graph(rng, rng.randint(6, 16), mesh=0.4)
    if not regular(graph):
        return
    storages = [node for node in graph if graph.nodes[node]["kind"] in ("I", "C")]
    wanted = rng.sample(storages, len(storages))
    reordered = bond_graph(
        [(node, dict(graph.nodes[node])) for node in graph if node not in wanted], ""
    )
    reordered.add_nodes_from((node, graph.nodes[node]) for node in wanted)
    reordered.add_edges_from(graph.edges)
    for rank, node in enumerate(wanted):
        graph.nodes[node]["priority"] = -rank
    by_priority, by_order = bg.assign_causality(graph), bg.assign_causality(reordered)
    assert set(by_priority.integral) == set(by_order.integral)
    assert by_priority.integral == tuple(n for n in storages if n in set(by_order.integral))


def test_number_of_states_does_not_depend_on_the_order_of_declaration() -> None:
    for seed in range(300, 340):
        rng = random.Random(seed)
        graph = random_graph(rng, rng.randint(5, 16), mesh=0.4)
        if regular(graph):
            other = shuffled(graph, rng)
            counts = {len(bg.assign_causality(one).integral) for one in (graph, other)}
            assert len(counts) == 1


def test_why_tells_the_chain_of_reasons_choices_first() -> None:
    nodes = [
        bg.Se("engine", "u"), bg.One("in"), bg.TF("gear", "n"), bg.Zero("mid"), bg.GY("motor", "r"),
        bg.I("wheel", "m"), bg.I("shaft", "i"),
    ]  # fmt: skip
    causal = bg.assign_causality(bond_graph(nodes, "engine>in>shaft in>gear>mid>motor>wheel"))
    assert causal.integral == ("wheel", "shaft")
    assert causal.why("shaft") == (
        "Se 'engine' imposes its effort, so on bond 'engine' -> 'in' 'in' receives the effort",
        "I 'wheel' is tried in integral causality first, so on bond 'motor' -> 'wheel' "
        "'wheel' receives the effort",
        "GY 'motor' gyrates what it receives, so on bond 'mid' -> 'motor' "
        "'mid' receives the effort",
        "Zero 'mid' takes its effort from one bond only, so on bond 'gear' -> 'mid' "
        "'gear' receives the effort",
        "TF 'gear' passes causality through, so on bond 'in' -> 'gear' 'in' receives the effort",
        "One 'in' has one bond left to take its flow from, so on bond 'in' -> 'shaft' "
        "'shaft' receives the effort",
    )
    assert causal.why("gear") == causal.why("shaft")[1:5]


def test_why_names_the_storage_that_took_the_place() -> None:
    causal = bg.assign_causality(_shaft(bg.I("first", "a"), bg.I("second", "b")))
    assert causal.why("second") == (
        "I 'first' is tried in integral causality first, so on bond 'j' -> 'first' "
        "'first' receives the effort",
        "One 'j' takes its flow from one bond only, so on bond 'j' -> 'second' "
        "'j' receives the effort",
    )


def test_long_chain_needs_no_recursion() -> None:
    causal = bg.assign_causality(chain(1_000))
    assert len(causal.integral) == 2_000
    assert causal.derivative == ()


def test_long_story_is_shortened() -> None:
    """One stroke runs through a row of transformers and forces the last element's."""
    count = 2_000
    gears = [bg.TF(f"g{k}", "n") for k in range(count)]
    path = ">".join(["s", *(f"g{k}" for k in range(count)), "m"])
    story = bg.assign_causality(bond_graph([bg.Se("s", "u"), *gears, bg.I("m", "m")], path)).why(
        "m"
    )
    assert len(story) < 20
    assert story[0].startswith("Se 's' imposes its effort")
    assert any(f"({count + 1 - 12} more strokes)" in line for line in story)
    assert story[-1].endswith("'m' receives the effort")


def test_result_can_not_be_changed() -> None:
    causal = bg.assign_causality(_shaft(bg.I("a", "a")))
    with pytest.raises(TypeError, match="does not support item assignment"):
        causal.strokes["s", "j"] = "s"  # type: ignore[index]
