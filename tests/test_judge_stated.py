"""The judge of what equations state sees wrong laws, rates and rows, and a name that nothing explains."""

import random
from dataclasses import replace

import pytest
import sympy as sp
from oracles.stated import Instant, instant, misfits, misfits_somewhere
from references.build import bond_graph

import bondgraph as bg


def _derived(spring: str = "k*q_k**3", force: str = "a*sin(w*t)") -> bg.StateEquations:
    """Two sources, of which one drives a dependent mass; a law that has a state; an angle."""
    nodes = [bg.Se("F", force), bg.One("j"), bg.I("m", "m", flow="v"), bg.C("k", law=spring),
             bg.Df("way", integrate="x"), bg.Zero("z"), bg.Sf("V", "V"), bg.One("o"),
             bg.I("m_2", "m_2", priority=-1), bg.R("b", "b")]  # fmt: skip
    bonds = "F>j>m j>k j>way j>z V>z>o>m_2 j>b"
    return bg.derive(bond_graph(nodes, bonds), outputs=["o", "m"])


@pytest.fixture(scope="module")
def equations() -> bg.StateEquations:
    return _derived()


@pytest.fixture(scope="module")
def at(equations: bg.StateEquations) -> Instant:
    return instant(equations, random.Random(0))


def test_what_is_right_is_told_nothing_of(equations: bg.StateEquations, at: Instant) -> None:
    assert misfits(equations, at) == []
    assert misfits_somewhere(equations, 1) == []


def _doubled(equations: bg.StateEquations, letter: str) -> bg.StateEquations:
    matrix = getattr(equations, letter)
    assert matrix.todok()
    return replace(equations, **{letter: sp.ImmutableSparseMatrix(2 * matrix)})


@pytest.mark.parametrize("letter", "AJBEFDG")
def test_a_wrong_matrix_is_seen(equations: bg.StateEquations, at: Instant, letter: str) -> None:
    assert misfits(_doubled(equations, letter), at)


@pytest.mark.parametrize(
    "law", [{"spring": "k*q_k**2"}, {"spring": "-k*q_k**3"}, {"force": "a*cos(w*t)"}]
)
def test_a_wrong_law_is_seen(equations: bg.StateEquations, at: Instant, law: dict) -> None:
    assert misfits(replace(equations, laws=_derived(**law).laws), at)


def test_a_wrong_rate_is_seen(equations: bg.StateEquations, at: Instant) -> None:
    (angle,) = equations.integrals
    assert misfits(replace(equations, integrals={angle: sp.Symbol("V")}), at)


def test_a_name_that_nothing_explains_is_seen(equations: bg.StateEquations, at: Instant) -> None:
    with pytest.raises(KeyError, match="unheard"):
        misfits(replace(equations, laws=_derived("unheard*q_k").laws), at)
