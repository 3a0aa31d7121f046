"""Expressions of time that are sums of polynomials times exponentials, as the exact terms of a piece."""

from collections.abc import Mapping

import sympy as sp

from bondgraph.algebra.expressions import TIME
from codegen.inputs.pieces import Term

Waves = Mapping[sp.Expr, tuple[complex, ...]]
"""By the exact rate [1/s] the coefficients of its polynomial, lowest power first."""

MOST_SLOTS = 48
"""Sums with more terms, real ones counted once and complex ones twice, are left to polynomials."""

MOST_POWER = 64
"""Powers up to this one are multiplied out."""


def terms_of(expr: sp.Expr, start: sp.Expr = sp.S.Zero) -> tuple[Term, ...] | None:
    """The terms of a piece that begins at ``start`` [s]; None for an expression that has none.

    Polynomials, exp, sin, cos, sinh and cosh of linear time, their sums, products and powers: all
    numbers in ``expr`` are known, and rates are added exactly.

    >>> t = sp.Symbol("t")
    >>> sorted((rate.imag, poly[0].imag) for rate, poly in terms_of(4*sp.sin(t)**3))
    [(1.0, -3.0), (3.0, 1.0)]
    >>> terms_of(sp.sin(t**2)) is None
    True
    """
    waves = _waves(expr, start)
    if waves is None or _slots(waves) > MOST_SLOTS:
        return None
    terms: list[Term] = []
    for rate, polynomial in waves.items():
        number = complex(sp.N(rate, 20))
        if number.imag < 0 or not any(polynomial):
            continue
        # A wave and its mirror image are twice the real part of one.
        factor = 2.0 if number.imag else 1.0
        kept = tuple(factor * c if number.imag else complex(c.real) for c in polynomial)
        terms.append((number if number.imag else number.real, kept))
    return tuple(terms) or ((0.0, (0.0,)),)


def _waves(expr: sp.Expr, start: sp.Expr) -> Waves | None:
    if TIME not in expr.free_symbols:
        return {sp.Integer(0): (_number(expr),)}
    if expr == TIME:
        return {sp.Integer(0): (_number(start), 1.0)}
    if isinstance(expr, sp.Add | sp.Mul):
        return _joined(expr, start)
    if isinstance(expr, sp.Pow) and expr.exp.is_Integer and 0 < expr.exp <= MOST_POWER:
        base = _waves(expr.base, start)
        return None if base is None else _power(base, int(expr.exp))
    return _exponential(expr, start)


def _joined(expr: sp.Expr, start: sp.Expr) -> Waves | None:
    join = _sum if isinstance(expr, sp.Add) else _product
    total: Waves | None = None
    for argument in expr.args:
        part = _waves(argument, start)
        if part is None or _slots(part) > 2 * MOST_SLOTS:
            return None
        total = part if total is None else join(total, part)
    return total


def _exponential(expr: sp.Expr, start: sp.Expr) -> Waves | None:
    """exp, sin, cos, sinh and cosh of linear time as sums of exponentials; a constant's power, too."""
    if isinstance(expr, sp.Pow) and TIME not in expr.base.free_symbols and expr.base.is_positive:
        expr = sp.exp(expr.exp * sp.log(expr.base), evaluate=False)
    if not expr.args:
        return None
    slope = sp.diff(expr.args[0], TIME)
    if TIME in slope.free_symbols or type(expr) not in _PARTS:
        return None
    slope, there = sp.nsimplify(slope) if slope.is_Float else slope, expr.args[0].subs(TIME, start)
    total: Waves = {}
    for factor, turn in _PARTS[type(expr)]:
        rate = sp.expand(turn * slope)
        total = _sum(total, {rate: (factor * _number(sp.exp(sp.expand(turn * there))),)})
    return total


_PARTS: Mapping[type, tuple[tuple[complex, sp.Expr], ...]] = {
    sp.exp: ((1.0, sp.Integer(1)),),
    sp.sin: ((-0.5j, sp.I), (0.5j, -sp.I)),
    sp.cos: ((0.5, sp.I), (0.5, -sp.I)),
    sp.sinh: ((0.5, sp.Integer(1)), (-0.5, sp.Integer(-1))),
    sp.cosh: ((0.5, sp.Integer(1)), (0.5, sp.Integer(-1))),
}


def _number(expr: sp.Expr) -> complex:
    return complex(sp.N(expr, 20))


def _sum(one: Waves, other: Waves) -> Waves:
    total = dict(one)
    for rate, polynomial in other.items():
        total[rate] = _added(total.get(rate, ()), polynomial)
    return total


def _added(one: tuple[complex, ...], other: tuple[complex, ...]) -> tuple[complex, ...]:
    long, short = (one, other) if len(one) >= len(other) else (other, one)
    return tuple(c + (short[k] if k < len(short) else 0.0) for k, c in enumerate(long))


def _product(one: Waves, other: Waves) -> Waves:
    total: dict[sp.Expr, tuple[complex, ...]] = {}
    for rate, p in one.items():
        for turn, q in other.items():
            product = [0j] * (len(p) + len(q) - 1)
            for i, a in enumerate(p):
                for j, b in enumerate(q):
                    product[i + j] += a * b
            key = sp.expand(rate + turn)
            total[key] = _added(total.get(key, ()), tuple(product))
    return total


def _power(base: Waves, power: int) -> Waves | None:
    total = base
    for _ in range(power - 1):
        if _slots(total) > 2 * MOST_SLOTS:
            return None
        total = _product(total, base)
    return total


def _slots(waves: Waves) -> int:
    return sum(map(len, waves.values()))
