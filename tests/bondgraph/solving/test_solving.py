"""Inverses, blocks, eliminations and parts by name, against sympy's own solutions."""

import random
from collections.abc import Mapping, Sequence

import pytest
import sympy as sp
from references.resolved import rationals

from bondgraph.algebra.angles import joined
from bondgraph.algebra.exact import SingularError, solve
from bondgraph.solving.blocks import blocks, solved
from bondgraph.solving.eliminated import eliminated
from bondgraph.solving.inverse import inverse
from bondgraph.solving.polynomials import adjugate
from bondgraph.solving.steps import Steps, told

Rows = list[dict[int, sp.Expr]]
a, b, c, h, u, w = sp.symbols("a b c h u w")


def _random(rng: random.Random, size: int, symmetric: bool = False) -> Rows:
    """Rows of short expressions, about half of them zero but for the diagonal."""
    kinds = [a, b + c, 1 / h, a * b, sp.sin(h), sp.Integer(-2), sp.cos(h) * c, sp.sqrt(a)]
    rows: Rows = [{i: rng.choice(kinds) + sp.Symbol(f"d{i}")} for i in range(size)]
    for i in range(size):
        for j in range(i):
            if rng.random() < 0.4:
                rows[i][j] = rng.choice(kinds)
                rows[j][i] = rows[i][j] if symmetric else rng.choice(kinds)
    return rows


def _value(
    expr: sp.Expr, point: Mapping[sp.Symbol, sp.Expr], parts: Mapping[sp.Symbol, sp.Expr]
) -> sp.Expr:
    known = dict(point)
    for name, part in parts.items():
        known[name] = sp.N(part.xreplace(known), 50)
    return sp.N(expr.xreplace(known), 50)


def _expected(
    rows: Rows, right: Sequence[sp.Expr], point: Mapping[sp.Symbol, sp.Expr]
) -> sp.Matrix:
    """By sympy's LU decomposition, in numbers of fifty digits."""
    full = sp.Matrix(len(rows), len(rows), lambda i, j: rows[i].get(j, 0)).xreplace(point)
    return full.evalf(50).LUsolve(sp.Matrix(right).xreplace(point).evalf(50))


def _point(rows: Rows) -> dict[sp.Symbol, sp.Expr]:
    names = {s for row in rows for e in row.values() for s in e.free_symbols} | {u, w, a}
    return {name: abs(value) for name, value in rationals(names).items()}


@pytest.mark.parametrize("way", ["solved", "eliminated", "inverse"])
@pytest.mark.parametrize("seed", range(12))
def test_solutions_are_those_of_an_lu_decomposition(seed: int, way: str) -> None:
    rng = random.Random(seed)
    rows = _random(rng, rng.randint(1, 3 if way == "inverse" else 7), symmetric=seed % 2 == 0)
    right = [rng.choice([u, w, u * w, sp.Integer(0), u + a]) for _ in rows]
    steps = Steps()
    if way == "solved":
        found = solved(rows, right, steps)
    elif way == "eliminated":
        found = eliminated(rows, right, steps)
    else:
        fractions = inverse(rows)
        assert fractions is not None
        found = [sp.Add(*(e * right[j] for j, e in f.over.items())) / f.under for f in fractions]
    point = _point(rows)
    for most in (10**9, 0):
        whole = told(found, steps.parts, most)
        assert whole.parts.keys() <= set() if most else True
        for one, other in zip(whole.results, _expected(rows, right, point), strict=True):
            assert abs(_value(one, point, whole.parts) - other) < 1e-30 * (1 + abs(other))


def test_an_inverse_of_a_diagonal_and_one_product_stays_short() -> None:
    """``diag(d) + s s^T`` of six rows, whose determinant has seven terms (Sherman and Morrison 1950)."""
    d, s = sp.symbols("d0:6"), sp.symbols("s0:6")
    rows = [{j: s[i] * s[j] + (d[i] if i == j else 0) for j in range(6)} for i in range(6)]
    found = inverse(rows)
    assert found is not None
    below = sp.expand(found[0].under)
    expected = sp.prod(d) * (1 + sum(t**2 / e for t, e in zip(s, d, strict=True)))
    assert len(below.args) == 7
    assert (
        sp.cancel(found[0].over[1] / below + s[0] * s[1] * sp.prod(d[2:]) / sp.expand(expected))
        == 0
    )


def test_a_full_matrix_of_own_symbols_is_not_multiplied_out() -> None:
    rows = [{j: sp.Symbol(f"a{min(i, j)}_{max(i, j)}") for j in range(8)} for i in range(8)]
    assert adjugate(rows) is None
    assert inverse(rows) is None


def test_what_is_singular_by_an_identity_is_refused() -> None:
    s, k = sp.sin(a), sp.cos(a)
    rows = [{0: s, 1: k}, {0: 1 - k**2, 1: s * k}]
    for way in (
        lambda: solve(rows, [{0: u}, {}]),
        lambda: solved(rows, [u, w], Steps()),
        lambda: eliminated(rows, [u, w], Steps()),
        lambda: inverse(rows),
        lambda: solved([{0: s**2 + k**2 - 1}], [u], Steps()),
        lambda: blocks([{0: a, 1: b}, {}]),
    ):
        with pytest.raises(SingularError):
            way()


def test_moduli_with_sines_are_solved_in_lowest_terms() -> None:
    """Cramer's rule, over one symbol for each sine and each cosine."""
    s, k = sp.sin(a), sp.cos(a)
    (first, second) = solve([{0: b, 1: c * s}, {0: c * s, 1: c * k}], [{0: u}, {}])
    below = b * k - c * s**2
    assert sp.cancel(first[0] - u * k / below) == 0
    assert sp.cancel(second[0] + u * s / below) == 0


@pytest.mark.parametrize("seed", range(10))
def test_sums_of_angles_are_put_together_and_stay_what_they_are(seed: int) -> None:
    rng = random.Random(seed)
    sines = [sp.sin(a), sp.cos(a), sp.sin(b), sp.cos(b), sp.sin(2 * c)]
    terms = [rng.choice([1, -1, u]) * rng.choice(sines) * rng.choice(sines) for _ in range(6)]
    whole = sp.Add(*terms)
    found = joined(whole)
    assert sp.expand_trig(found - whole).rewrite(sp.exp).expand() == 0
    assert found.count_ops() <= whole.count_ops()
