"""Factors against sympy's own, and entries whose factors were a matter of luck."""

import random

import pytest
import sympy as sp
from sympy.core.random import seed

from bondgraph.algebra.factored import factored

a, b, n, w, x, y, z = sp.symbols("a b n w x y z")


@pytest.mark.parametrize("number", range(60))
def test_what_is_linear_in_a_symbol_is_factored_as_by_sympy(number: int) -> None:
    """Products of some sums over products of others, multiplied out; rational numbers among them."""
    draw = random.Random(number)

    def some() -> sp.Expr:
        terms = [draw.choice((1, 2, -3, sp.Rational(1, 4))) * sp.prod(draw.sample((a, b, n, x, y), 2))
                 for _ in range(draw.randint(1, 3))]  # fmt: skip
        return sp.Add(*terms, draw.choice((0, 1, x)))

    over = sp.expand((w * some() + some()) * some() ** draw.randint(1, 2))
    under = sp.expand(some() * z)
    if under == 0:
        pytest.skip("a sum is zero")
    seed(number)
    assert factored(over / under) == sp.factor(over / under)


@pytest.mark.parametrize(
    ("expr", "expected"),
    [
        (sp.Integer(-6), sp.Integer(-6)),
        (x / 2 + y / 4, sp.Mul(sp.Rational(1, 4), 2 * x + y, evaluate=False)),
        (-x - 1, -x - 1),
        (x**2 + 2 * x + 1, (x + 1) ** 2),
        (x**4 - 1, (x - 1) * (x + 1) * (x**2 + 1)),
        (x**2 - y**2, (x - y) * (x + y)),
        (sp.sqrt(2) * x**2 + sp.sqrt(2) * x, None),
        (sp.sin(x) ** 2 + 2 * sp.sin(x) + 1, (sp.sin(x) + 1) ** 2),
        ((x * y + x) ** sp.Rational(1, 2), sp.sqrt(x * (y + 1))),
    ],
)
def test_forms(expr: sp.Expr, expected: sp.Expr | None) -> None:
    """None: it may have any form of the same value."""
    found = factored(expr)
    assert expected is None or found == expected
    assert sp.expand(found - expr) == 0


def test_a_polynomial_that_is_linear_in_none_stays_whole() -> None:
    """Four symbols, each squared: no search."""
    squares = sp.expand((a**2 + b**2 + x**2 + 1) * (a**2 + y**2 + 3))
    assert factored(squares) == squares


def test_nothing_is_drawn_at_random(monkeypatch: pytest.MonkeyPatch) -> None:
    """An entry of a torque vectoring differential, for which an unlucky draw took three minutes."""
    import sympy.polys.factortools as factortools

    def drawn(*_: object, **__: object) -> None:
        raise AssertionError("factors are searched for from numbers drawn at random")

    monkeypatch.setattr(factortools, "dmp_zz_wang", drawn)
    names = "I_1 I_c I_c1 I_c2 I_i I_r1 I_s1 I_s2 I_w1 h1 h2 i"
    text = ("I_1 + I_c/4 - I_c1*(2 - h1)*(h1/2 - 1)/((h1 - 1)*(2*h1 - 2)) + I_c2*h2**2/(4*(h2 - 1)**2)"
            " + I_i*i**2/4 + I_r1 + I_s1/4 + I_s2/4 + I_w1")  # fmt: skip
    entry = sp.sympify(text, {name: sp.Symbol(name) for name in names.split()})
    with pytest.raises(AssertionError, match="at random"):
        sp.factor(entry)
    found = factored(entry)
    assert sp.cancel(found - entry) == 0
    assert found.as_numer_denom()[1] == 4 * (sp.Symbol("h1") - 1) ** 2 * (sp.Symbol("h2") - 1) ** 2
