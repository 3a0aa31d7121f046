"""Fewer junctions, the same equations: by hand, and random graphs with junctions put in."""

import random

import networkx as nx
import numpy as np
import pytest
import sympy as sp
from references.bond_equations import is_input, kind
from references.brute_force import port, transfer
from references.build import Graph, bond_graph
from references.random_graphs import random_graph
from soak.families import seeds

import bondgraph as bg

NODES = [
    bg.Se("push", "F"), bg.One("a"), bg.I("m", "m", flow="v"), bg.One("b"), bg.R("drag", "r"), bg.Zero("z"),
    bg.TF("lever", "n"), bg.One("o"), bg.C("spring", "1/k"),
]  # fmt: skip
BONDS = "push>a>m a>b>drag b>z>lever>o>spring"


def _with(name: str, **more: object) -> Graph:
    graph = bond_graph(NODES, BONDS)
    graph.nodes[name].update(more)
    return graph


def test_junctions_of_one_kind_and_those_that_hand_on_are_taken_out() -> None:
    graph = bond_graph(NODES, BONDS)
    before = nx.DiGraph(graph)
    found = bg.merged(graph)
    assert set(found) == {"push", "a", "m", "drag", "lever", "spring"}
    assert set(found.edges) == {
        ("push", "a"), ("a", "m"), ("a", "drag"), ("a", "lever"), ("lever", "spring"),
    }  # fmt: skip
    assert nx.utils.graphs_equal(graph, before)
    assert bg.explicit(bg.derive(found)) == bg.explicit(bg.derive(graph))
    assert [one.rule for one in bg.check(found)] == []


def test_a_name_that_a_junction_gives_is_kept() -> None:
    assert "z" in bg.merged(_with("z", effort="F_z"))
    assert bg.merged(_with("b", flow="w")).nodes["a"]["flow"] == "w"
    both = _with("b", flow="v")
    both.nodes["a"]["flow"] = "v"
    assert {"a", "b"} <= set(bg.merged(both))


def test_a_junction_whose_variable_is_read_stays() -> None:
    """By its default name, by a value, and by another node that shares it."""
    assert "z" in bg.merged(_with("drag", value="r*(1 + e_z**2)"))
    assert "b" in bg.merged(_with("drag", value="r*(1 + f_b**2)"))
    assert "z" in bg.merged(_with("m", value="m*e_z"))


def test_a_controlled_junction_stays() -> None:
    assert "o" in bg.merged(_with("o", on="gate - 1/2"))


def test_two_nodes_get_no_two_bonds() -> None:
    """Two transformers side by side: without a junction between, the ends would be bonded twice."""
    nodes = [
        bg.Se("u", "u"), bg.One("a"), bg.I("m", "m"), bg.Zero("p"), bg.One("x"), bg.One("y"),
        bg.R("r", "r"), bg.R("q", "q"), bg.Zero("e"), bg.C("c", "c"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "u>a>m a>p>x>r x>e>c p>y>q y>e")
    assert set(bg.merged(graph)) == set(graph)
    ring = bond_graph(
        [bg.Se("u", "u"), bg.One("a"), bg.I("m", "m"), bg.Zero("p"), bg.R("r", "r"), bg.Zero("q")],
        "u>a>m a>p>r a>q p>q",
    )
    assert set(bg.merged(ring)) == set(ring)


def test_ports_of_fields_keep_their_bonds() -> None:
    graph = bond_graph(
        [bg.Se("u", "u"), bg.One("a"), bg.I("coils", ports=["p", "q"]), bg.One("w"), bg.R("load", "b"),
         bg.Zero("t")],
        "u>a w>load w>t",
    )  # fmt: skip
    graph.nodes["coils"]["value"] = [["L1", "M"], ["M", "L2"]]
    graph.add_edge("a", "coils", port="p")
    graph.add_edge("t", "coils", port="q")
    found = bg.merged(graph)
    assert found.edges["u", "coils"] == {"port": "p"}
    assert set(found.edges) == {("u", "coils"), ("load", "coils")} or "w" in found
    one, other = (bg.derive(which, outputs=[]) for which in (graph, found))
    assert (one.A, one.J, one.B) == (other.A, other.J, other.B)


def test_the_graphs_name_and_tables_come_along() -> None:
    table = bg.LookupTable("soft", [0, 1], [1, 2])
    graph = bond_graph(NODES, BONDS)
    graph.graph.update(name="lever", tables=[table])
    graph.nodes["drag"]["value"] = "soft(v)"
    found = bg.merged(graph)
    assert found.graph["name"] == "lever"
    assert found.nodes["drag"]["value"] == "soft(v)"
    assert bg.explicit(bg.derive(found)) == bg.explicit(bg.derive(graph))


def _longer(graph: Graph, rng: random.Random) -> Graph:
    """The graph with junctions put into bonds, and junctions taken apart into two of their kind."""
    result: Graph = nx.DiGraph()
    result.add_nodes_from((name, dict(data)) for name, data in graph.nodes(data=True))
    junctions = [name for name in graph if kind(graph, name) in ("Zero", "One")]
    apart = {name: f"{name}_b" for name in junctions if rng.random() < 0.4}
    for name, other in apart.items():
        result.add_node(other, kind=kind(graph, name))
        result.add_edge(*rng.sample([name, other], 2))
    for at, bond in enumerate(graph.edges):
        ends = [rng.choice([end, apart.get(end, end)]) for end in bond]
        if rng.random() < 0.5:
            result.add_node(f"put_{at}", kind=rng.choice(["Zero", "One"]))
            nx.add_path(result, [ends[0], f"put_{at}", ends[1]])
        else:
            result.add_edge(*ends)
    return result


@pytest.mark.parametrize("seed", seeds("merged-graphs"))
def test_merged_graphs_respond_as_the_longer_ones_by_brute_force(seed: int) -> None:
    rng = random.Random(seed)
    longer = _longer(random_graph(rng, rng.randint(4, 12), mesh=0.3), rng)
    sources = [node for node in longer if is_input(longer, node)]
    names = (data.get("value") for _, data in longer.nodes(data=True))
    values = {name: rng.uniform(0.3, 2) for name in names if isinstance(name, str)}
    at = complex(rng.uniform(0.2, 1), rng.uniform(0.2, 2))
    try:
        judges = transfer(longer, at, values), transfer(bg.merged(longer), at, values)
    except np.linalg.LinAlgError:
        with pytest.raises(bg.BondGraphError):
            bg.derive(bg.merged(longer))
        return
    found = bg.merged(longer)
    assert set(found) <= set(longer)
    assert [one for one in bg.check(found) if one.rule in ("pass-through", "same kind")] == []
    for node in found:
        if kind(longer, node) in ("I", "C", "R", "Se", "Sf"):
            pair = (
                port(graph, judge, node)
                for graph, judge in zip((longer, found), judges, strict=True)
            )
            for one, other in zip(*pair, strict=True):
                assert all(abs(one[u] - other[u]) <= 1e-9 * max(1, abs(one[u])) for u in sources), (
                    node
                )
    assert bg.derive(found, outputs=[]).inputs == bg.derive(longer, outputs=[]).inputs


def test_symbols_of_states_stay() -> None:
    graph = bond_graph(NODES, BONDS)
    assert bg.derive(bg.merged(graph)).states == bg.derive(graph).states
    assert sp.Symbol("v") in bg.derive(bg.merged(graph)).states
