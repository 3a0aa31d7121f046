"""Rates of random graphs with a symbol of its own for each value, put into their matrices at rationals."""

import random

import pytest
import sympy as sp
from references.large_graphs import coupled_shafts, ring_of_capacitors
from references.random_graphs import random_graph
from references.resolved import left_over, rates_at, rationals
from soak.families import seeds

import bondgraph as bg

TINY = sp.Rational(1, 10**30)


@pytest.mark.parametrize("seed", seeds("explicit-graphs"))
def test_rates_of_a_random_graph_solve_its_matrices(seed: int) -> None:
    try:
        equations = bg.derive(
            random_graph(random.Random(seed), 6 + seed % 12, mesh=0.3), outputs=[]
        )
    except bg.BondGraphError:
        return
    assert not any(left_over(equations, bg.explicit(equations), seed))


@pytest.mark.parametrize("moving", [False, True])
@pytest.mark.parametrize("seed", seeds("explicit-shafts"))
def test_rates_of_coupled_shafts_solve_their_matrices(seed: int, moving: bool) -> None:
    equations = bg.derive(coupled_shafts(seed, 3 + seed % 8, 2 + seed % 7, moving), outputs=[])
    left = left_over(equations, bg.explicit(equations), seed)
    assert max(map(abs, left)) < (TINY if moving else TINY**2)


@pytest.mark.parametrize(("seed", "masses"), [(0, 15), (1, 40)])
def test_forty_states_with_symbols_of_their_own_are_told_in_steps(seed: int, masses: int) -> None:
    equations = bg.derive(coupled_shafts(seed, 40, masses), outputs=[])
    found = bg.explicit(equations)
    assert not any(left_over(equations, found))
    assert len(found) == 40
    # What is on a page each, and a page of parts to it.
    assert len(found.where) < 200
    assert len(str(found)) < 20_000


@pytest.mark.parametrize("resistance", ["1/G{}", "R{}"])
@pytest.mark.parametrize("count", [3, 5])
def test_a_ring_of_capacitors_has_the_rates_that_are_found_by_hand(
    count: int, resistance: str
) -> None:
    """With the ring's current i, ``C_k v_k' = i_k`` where ``i_k = i - sum up to k of e_j/R_j``.

    Nodes' efforts e_k are ``e_0 - v_0 - ... - v_k-1``, where no current leaves them: ``sum of e_k/R_k = 0``;
    around, ``v_0 + ... + v_n-1 = 0``, so that ``sum of i_k/C_k = 0``.
    """
    equations = bg.derive(ring_of_capacitors(count, resistance), outputs=[])
    found = bg.explicit(equations)
    point = rationals({*equations.parameters, *equations.states})
    rates = rates_at(found, point)
    last = next(k for k in range(count) if sp.Symbol(f"v{k}") not in rates)
    v = {k: point[sp.Symbol(f"v{k}")] for k in range(count) if k != last}
    v[last] = -sp.Add(*v.values())
    G = [point[sp.Symbol(f"G{k}")] if "G" in resistance else 1 / point[sp.Symbol(f"R{k}")]
         for k in range(count)]  # fmt: skip
    C = [point[sp.Symbol(f"C{k}")] for k in range(count)]
    below = [sp.Add(*(v[j] for j in range(k))) for k in range(count)]
    e0 = sp.Add(*(g * b for g, b in zip(G, below, strict=True))) / sp.Add(*G)
    out = [g * (e0 - b) for g, b in zip(G, below, strict=True)]
    lost = [sp.Add(*out[: k + 1]) for k in range(count)]
    i = sp.Add(*(s / c for s, c in zip(lost, C, strict=True))) / sp.Add(*(1 / c for c in C))
    assert [rates[sp.Symbol(f"v{k}")] for k in v if k != last] == [
        (i - lost[k]) / C[k] for k in v if k != last
    ]


def test_the_same_graph_has_the_same_rates_to_the_last_letter() -> None:
    graph = coupled_shafts(3, 6, 5)
    texts = {str(bg.explicit(bg.derive(graph, outputs=[]))) for _ in range(2)}
    assert len(texts) == 1
