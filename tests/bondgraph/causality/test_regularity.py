"""Singular structures that valid strokes do not show: refused by exact rank, with names."""

import random

import pytest
from references.brute_force import regular, regular_port_choices, valid_strokes
from references.build import bond_graph
from references.random_graphs import random_graph

import bondgraph as bg

SINGULAR = {
    # z0 and z2 have one effort, so that none is left for the source at j.
    "source_on_a_short_circuit": (
        [
            bg.Zero("z0"),
            bg.Zero("z2"),
            bg.One("j"),
            bg.Se("s", "u"),
            bg.I("a", "a"),
            bg.I("b", "b"),
        ],
        "z0>j>z2 z0>z2>b j>s z0>a",
        bg.CausalityError,
        "'s' imposes its effort where the structure alone determines it",
    ),
    # e = r f at the gyrator, so the port's effort is r times the source's flow.
    "port_that_follows_from_a_source": (
        [bg.Zero("z"), bg.Sf("s", "u"), bg.R("p"), bg.One("j"), bg.GY("g", "r")],
        "s>z p>j j>z j>g>z",
        bg.CausalityError,
        "'s', 'p' exclude each other",
    ),
    "two_sources_around_a_mesh": (
        [
            bg.Zero("z"),
            bg.Zero("y"),
            bg.One("j"),
            bg.Sf("s", "u"),
            bg.Sf("v", "w"),
            bg.GY("g", "r"),
            bg.I("m", "m"),
        ],
        "g>z v>z>j j>y>s y>z j>m y>g",
        bg.CausalityError,
        "'(s|v)', '(s|v)' exclude each other",
    ),
    # Flow may circulate from z0 over z1 and z2.
    "ring_of_0_junctions": (
        [bg.Zero("z0"), bg.Zero("z1"), bg.Zero("z2"), bg.C("c", "c"), bg.I("m", "m")],
        "z2>z1>z0>z2>c z0>m",
        bg.AlgebraicLoopError,
        "the flow of bond 'z[012]' -> 'z[012]' stays undetermined",
    ),
    "ring_of_1_junctions": (
        [bg.One("j0"), bg.One("j1"), bg.One("j2"), bg.C("c", "c"), bg.I("m", "m")],
        "j2>j1>j0>j2>c j0>m",
        bg.AlgebraicLoopError,
        "the effort of bond 'j[012]' -> 'j[012]' stays undetermined",
    ),
}


@pytest.mark.parametrize("name", SINGULAR)
def test_singular_structure_is_refused(name: str) -> None:
    nodes, bonds, error, message = SINGULAR[name]
    graph = bond_graph(nodes, bonds)
    assert not regular(graph)
    assert regular_port_choices(graph) == []
    with pytest.raises(error, match=message):
        bg.assign_causality(graph)


@pytest.mark.parametrize(
    ("modulus", "singular"), [(1, True), (-1, False), ("n/(1 + n - 1)", True), ("n", False)]
)
def test_ring_of_one_transformer_is_singular_at_ratio_one(modulus: object, singular: bool) -> None:
    """e = m e leaves the effort open and the flow too at m = 1, and only there."""
    nodes = [bg.Zero("z0"), bg.Zero("z1"), bg.TF("g", modulus), bg.C("c", "c"), bg.I("m", "m")]
    graph = bond_graph(nodes, "z0>z1>g>z0>m z1>c")
    if singular:
        with pytest.raises(bg.AlgebraicLoopError, match=r"bond '(z0|z1|g)' -> '(z0|z1|g)'"):
            bg.assign_causality(graph)
    else:
        assert bg.assign_causality(graph).integral == ("m",)


@pytest.mark.parametrize("seed", range(6))
def test_large_mesh_is_decided_as_exact_rank_decides_it(seed: int) -> None:
    """Of two hundred bonds, with few sources, so that some are regular."""
    rng = random.Random(seed)
    graph = random_graph(rng, 200, mesh=0.3, symbols=False)
    for at, attributes in enumerate(list(graph.nodes.values())):
        if attributes["kind"] in ("Se", "Sf") or "gives" in attributes:
            attributes.clear()
            attributes.update(kind="R", value=f"w{at}")
    try:
        bg.assign_causality(graph)
        accepted = True
    except bg.BondGraphError:
        accepted = False
    assert accepted == regular(graph)


def test_some_of_these_have_valid_strokes() -> None:
    """Strokes alone do not tell a singular structure."""
    graphs = [bond_graph(nodes, bonds) for nodes, bonds, _, _ in SINGULAR.values()]
    assert sum(bool(valid_strokes(graph)) for graph in graphs) >= 2


def test_ring_of_0_junctions_with_a_transformer_is_regular() -> None:
    """With a ratio other than one all efforts vanish: the mass keeps its speed."""
    nodes = [bg.Zero("z0"), bg.Zero("z1"), bg.TF("g", "n"), bg.C("c", "c"), bg.I("m", "m")]
    graph = bond_graph(nodes, "z0>z1>g>z0>m z1>c")
    assert regular(graph)
    equations = bg.derive(graph, outputs=["c", "m"])
    assert [str(state) for state in equations.states] == ["f_m"]
    assert equations.J.todok() == equations.F.todok() == {}
