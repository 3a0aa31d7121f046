"""Factors of rational functions, in a time that is no matter of luck.

sympy's `factor` puts integers drawn at random for all symbols but one, and lifts the factors it finds then: a
bad draw took minutes for an entry that takes a quarter of a second. What graphs give is nearly always linear
in some symbol, and ``a x + b`` has no factors but common ones of a and b (Gauss's lemma).
"""

from collections.abc import Iterator

import sympy as sp
from sympy.polys.polyerrors import BasePolynomialError

MOST_TERMS = 12
MOST_SYMBOLS = 3
"""What has several symbols and is linear in none is searched for factors while it is this small."""


def factored(expr: sp.Expr) -> sp.Expr:
    """The expression over one denominator, both as products of factors.

    Factors that repeat, or of whatever is linear in some symbol, are all found; a polynomial of many terms
    that is linear in none stays whole.

    >>> a, b, n, t = sp.symbols("a b n t")
    >>> factored(a * n**2 / (1 + t) + 2 * a * n / (1 + t) + a / (1 + t) + b * n / (1 + t) + b / (1 + t))
    (n + 1)*(a*n + a + b)/(t + 1)
    """
    number, parts = sp.Integer(1), []
    for part in sp.Mul.make_args(sp.together(sp.sympify(expr))):
        if part.is_Number:
            number *= part
            continue
        base, power = part.as_base_exp()
        poly = _polynomial(base) if power.is_Integer else None
        if poly is None:
            parts.append(part)
            continue
        scale, factors = _primitive(poly)
        number *= scale**power
        parts += [factor.as_expr() ** power for factor in _split(factors)]
    product = sp.Mul(*parts)
    # A number is not multiplied into a sum.
    return sp.Mul(number, product, evaluate=abs(number) == 1 or not product.is_Add)


def _polynomial(base: sp.Expr) -> sp.Poly | None:
    """With rational numbers as coefficients; None where it is none."""
    try:
        poly = sp.Poly(base)
    except BasePolynomialError:
        return None
    return poly if poly.domain.is_ZZ or poly.domain.is_QQ else None


def _primitive(poly: sp.Poly) -> tuple[sp.Rational, sp.Poly]:
    """A number, times coprime integers as coefficients, the leading one positive."""
    under, whole = poly.clear_denoms(convert=True)
    content, left = whole.primitive()
    if left.LC() < 0:
        content, left = -content, -left
    return sp.Rational(content, under), left


def _split(poly: sp.Poly) -> Iterator[sp.Poly]:
    """Its factors, each as often as it is one."""
    if poly.is_ground:
        return
    degrees = [poly.degree(symbol) for symbol in poly.gens]
    linear = next((s for s, degree in zip(poly.gens, degrees, strict=True) if degree == 1), None)
    if linear is not None:
        slope = poly.diff(linear)
        common = _primitive(slope.gcd(poly - slope * sp.Poly(linear, *poly.gens)))[1]
        yield from _split(common)
        yield _primitive(poly.exquo(common))[1]
        return
    parts = poly.sqf_list()[1]
    if len(parts) == 1 and parts[0][1] == 1:
        yield from _searched(poly, sum(degree > 0 for degree in degrees))
        return
    for part, times in parts:
        for factor in _split(_primitive(part)[1]):
            yield from [factor] * times


def _searched(poly: sp.Poly, symbols: int) -> Iterator[sp.Poly]:
    """Of a polynomial without double factors that is linear in nothing."""
    if symbols > 1 and (symbols > MOST_SYMBOLS or len(poly.terms()) > MOST_TERMS):
        yield poly
        return
    for factor, times in poly.factor_list()[1]:
        yield from [factor] * times
