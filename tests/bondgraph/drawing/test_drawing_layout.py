"""Layers, orders and columns of drawings against slow and plain calculations."""

import random
from itertools import combinations, product

import networkx as nx
import pytest
from references.random_graphs import random_graph

import bondgraph as bg
from bondgraph.algebra.expressions import expression
from bondgraph.drawing.layers import layered
from bondgraph.drawing.rich import GREEK, Run, formula, named, plain
from bondgraph.drawing.subject import subject
from bondgraph.layout.order import crossings, mirrored, ordered
from bondgraph.layout.tight import extremes


def slow_crossings(graph: "nx.DiGraph[int]", order: list[list[int]]) -> int:
    """Pairs of bonds of one gap whose ends are in opposite orders."""
    place = {
        vertex: (row, at) for row, layer in enumerate(order) for at, vertex in enumerate(layer)
    }
    return sum(
        place[a][0] == place[c][0] and (place[a][1] - place[c][1]) * (place[b][1] - place[d][1]) < 0
        for (a, b), (c, d) in combinations(graph.edges, 2)
    )


@pytest.mark.parametrize("seed", range(12))
def test_every_bond_goes_one_layer_down_and_orders_only_save_crossings(seed: int) -> None:
    what = subject(random_graph(random.Random(seed), 8 + 2 * seed, mesh=0.6), values=True)
    found = layered(what)
    row = {vertex: at for at, layer in enumerate(found.layers) for vertex in layer}
    assert sorted(row) == sorted(found.graph)
    assert all(row[lower] == row[upper] + 1 for upper, lower in found.graph.edges)
    beside = [item for own in found.beside.values() for item in own]
    items = [vertex for vertex in row if vertex < len(what.items)]
    assert sorted(items + beside) == list(range(len(what.items)))
    before = [list(layer) for layer in found.layers]
    after = ordered(found.graph, found.layers)
    assert list(map(sorted, after)) == list(map(sorted, before))
    assert crossings(found.graph, after) == slow_crossings(found.graph, after)
    assert crossings(found.graph, before) == slow_crossings(found.graph, before)
    assert crossings(found.graph, after) <= crossings(found.graph, before)
    turned = mirrored(found.graph, after, dict.fromkeys(row, 1), dict.fromkeys(row, ""))
    assert list(map(sorted, turned)) == list(map(sorted, before))
    assert slow_crossings(found.graph, turned) <= slow_crossings(found.graph, after)


@pytest.mark.parametrize("seed", range(8))
def test_extremes_against_all_numbers(seed: int) -> None:
    """Of all whole numbers up to a bound, those that cost least; their least and greatest."""
    dice = random.Random(seed)
    count, most = 4, 4
    gaps = [(0, 2, 1.0), (1, 3, float(dice.randint(1, 2)))]
    pulls = [
        (one, two, float(dice.randint(1, 3)), float(dice.randint(0, 1)))
        for one, two in ((0, 1), (1, 2), (2, 3), (0, 3))
    ]
    costs = {}
    for rest in product(range(-most, most + 1), repeat=count - 1):
        x = (0, *rest)
        if all(x[b] - x[a] >= gap for a, b, gap in gaps):
            costs[x] = sum(w * max(abs(x[b] - x[a]) - free, 0) for a, b, w, free in pulls)
    best = [x for x, cost in costs.items() if cost == min(costs.values())]
    low, high = extremes(count, gaps, pulls)
    assert tuple(low) == tuple(map(min, zip(*best, strict=True)))
    assert tuple(high) == tuple(map(max, zip(*best, strict=True)))


def test_numbers_that_no_pull_connects_lie_close_to_the_first() -> None:
    """Two pairs, three apart by a gap: the second pair is as near as that lets it; a single one is at 0."""
    pulls = [(0, 1, 1.0, 0.0), (2, 3, 1.0, 0.0)]
    gaps = [(0, 1, 1.0), (2, 3, 2.0), (1, 2, 3.0)]
    assert extremes(5, gaps, pulls) == ([0, 1, 4, 6, 0], [0, 1, 4, 6, 0])


def test_parts_that_signals_alone_connect_stand_side_by_side() -> None:
    """A force by a controller whose integrator has bonds of its own: both sources on top."""
    g = nx.DiGraph()
    g.add_nodes_from([
        bg.Se("force", "k*x_i"), bg.One("mass"), bg.I("m", "m", flow="v"),
        bg.Sf("error", "r - v"), bg.Zero("sum"), bg.C("integral", 1, effort="x_i"),
    ])  # fmt: skip
    g.add_edges_from([("force", "mass"), ("mass", "m"), ("error", "sum"), ("sum", "integral")])
    boxes = {node.name: node.box for node in bg.drawing(g).scene.nodes}
    force, error, mass, sums = (boxes[name] for name in ("force", "error", "mass", "sum"))
    assert force.top == error.top < mass.top == sums.top
    assert force.right < error.left or error.right < force.left


def test_letters_and_subscripts() -> None:
    assert named("omega_1") == (Run("ω"), Run("1", -1))
    assert plain(named("omega_1")) == "ω₁"
    assert plain(named("I_w1")) == "I_w1"
    assert plain(named("final_drive")) == "final_drive"
    assert plain(formula(expression("1/(h_1 - 1)", "here"))) == "1/(h₁ − 1)"
    assert plain(formula(expression("r*sin(theta)**2", "here"))) == "r·sin(θ)²"
    assert plain(formula(expression("k*1e-7", "here"))).endswith("k/10000000")
    assert (GREEK["lambda"], GREEK["Omega"]) == ("λ", "Ω")
    assert len(plain(named("x" * 400))) == 24
