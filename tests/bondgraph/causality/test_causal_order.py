"""The order in which signals follow from each other."""

import random

import sympy as sp

from bondgraph.causality.signals import causal_groups

ONE = sp.Integer(1)


def _terms(sources: list[list[int]]) -> list[list[tuple[int, sp.Expr]]]:
    return [[(source, ONE) for source in row] for row in sources]


def test_each_signal_comes_after_what_it_follows_from() -> None:
    rng = random.Random(0)
    names = rng.sample(range(200), 200)
    sources: list[list[int]] = [[] for _ in names]
    for at, name in enumerate(names):
        sources[name] = rng.sample(names[:at], min(at, rng.randint(0, 3)))
    groups = list(causal_groups(_terms(sources)))
    assert sorted(groups) == [(name,) for name in range(200)]
    place = {name: at for at, (name,) in enumerate(groups)}
    assert all(place[source] < place[name] for name in names for source in sources[name])


def test_loops_come_as_one_group_each_in_order() -> None:
    """1 and 2 follow from each other and from 0, 3 follows from them, 4 and 5 from 3 in a loop."""
    sources = [[], [0, 2], [1], [2], [3, 5], [4]]
    assert list(causal_groups(_terms(sources))) == [(0,), (1, 2), (3,), (4, 5)]


def test_signal_that_follows_from_itself_is_a_group_of_one() -> None:
    assert list(causal_groups(_terms([[0], [0]]))) == [(0,), (1,)]
