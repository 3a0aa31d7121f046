"""Bounds on an expression of time over complex discs: where it is analytic there, and how large.

A disc's centre is a real time, so values at centres are real. What a function is over a disc lies in a disc
about its value at the centre; the rules are the mean value theorem's and the addition theorems'.
"""

from collections.abc import Callable, Mapping

import numpy as np
import scipy
import sympy as sp
from numpy.typing import NDArray

from bondgraph.algebra.expressions import TIME
from codegen.numbers.arrays import Array

Disc = tuple[Array, Array]
"""Centres and radii of many discs; a radius is infinite where a function need not be analytic."""


def disc_of(expr: sp.Expr, centre: Array, radius: Array) -> Disc:
    """Discs that hold all values of an expression over discs of time; `KeyError` for an unknown function.

    >>> value, off = disc_of(sp.exp(sp.Symbol("t")), np.zeros(1), np.ones(1))
    >>> value, off.round(3)
    (array([1.]), array([1.718]))
    """
    if TIME not in expr.free_symbols:
        return np.full_like(centre, float(expr)), np.zeros_like(centre)
    if expr == TIME:
        return centre, radius
    parts = [disc_of(argument, centre, radius) for argument in expr.args]
    if isinstance(expr, sp.Add):
        return _folded(_add, parts)
    if isinstance(expr, sp.Mul):
        return _folded(_multiply, parts)
    if isinstance(expr, sp.Pow):
        return _raised(expr, parts[0], parts[1])
    return FUNCTIONS[expr.func](*parts[0])


def known(expr: sp.Expr) -> bool:
    """Whether there is a rule for every function of time in an expression."""
    moving = [part for part in sp.preorder_traversal(expr) if TIME in part.free_symbols]
    return all(isinstance(part, PLAIN) or part.func in FUNCTIONS for part in moving)


PLAIN = (sp.Symbol, sp.Add, sp.Mul, sp.Pow)


def _folded(rule: Callable[[Disc, Disc], Disc], parts: list[Disc]) -> Disc:
    total = parts[0]
    for part in parts[1:]:
        total = rule(total, part)
    return total


def _add(one: Disc, other: Disc) -> Disc:
    return one[0] + other[0], one[1] + other[1]


def _multiply(one: Disc, other: Disc) -> Disc:
    (a, r), (b, s) = one, other
    return a * b, np.abs(a) * s + np.abs(b) * r + r * s


def _raised(expr: sp.Expr, base: Disc, power: Disc) -> Disc:
    if expr.exp.is_Integer:
        count = abs(int(expr.exp))
        total = _integer_power(base, count)
        return total if expr.exp > 0 else _inverse(*total)
    return _exp(*_multiply(power, _log(*base)))


def _integer_power(base: Disc, count: int) -> Disc:
    """``|(a + z)^n - a^n| <= (|a| + r)^n - |a|^n``."""
    a, r = base
    return a**count, (np.abs(a) + r) ** count - np.abs(a) ** count


def _inverse(a: Array, r: Array) -> Disc:
    size = np.abs(a)
    return 1 / a, _where(size > r, r / (size * (size - r)))


def _exp(a: Array, r: Array) -> Disc:
    """``e^(a + r) - e^a``, in a form that does not overflow where it is small."""
    return np.exp(a), np.exp(a + r) * -np.expm1(-r)


def _log(a: Array, r: Array) -> Disc:
    return np.log(a), _where(a > r, -np.log1p(-r / a))


def _sin(a: Array, r: Array) -> Disc:
    off = np.abs(np.sin(a)) * (np.cosh(r) - 1) + np.abs(np.cos(a)) * np.sinh(r)
    return np.sin(a), off


def _cos(a: Array, r: Array) -> Disc:
    off = np.abs(np.cos(a)) * (np.cosh(r) - 1) + np.abs(np.sin(a)) * np.sinh(r)
    return np.cos(a), off


def _sinh(a: Array, r: Array) -> Disc:
    return np.sinh(a), np.abs(np.sinh(a)) * (np.cosh(r) - 1) + np.cosh(a) * np.sinh(r)


def _cosh(a: Array, r: Array) -> Disc:
    return np.cosh(a), np.cosh(a) * (np.cosh(r) - 1) + np.abs(np.sinh(a)) * np.sinh(r)


def _tan(a: Array, r: Array) -> Disc:
    return _multiply(_sin(a, r), _inverse(*_cos(a, r)))


def _cot(a: Array, r: Array) -> Disc:
    return _multiply(_cos(a, r), _inverse(*_sin(a, r)))


def _sec(a: Array, r: Array) -> Disc:
    return _inverse(*_cos(a, r))


def _csc(a: Array, r: Array) -> Disc:
    return _inverse(*_sin(a, r))


def _tanh(a: Array, r: Array) -> Disc:
    """By ``1 - 2 e/(1 + e)`` with ``e = exp(-2|a|)``, which does not overflow."""
    e = _exp(-2 * np.abs(a), 2 * r)
    share = _multiply(e, _inverse(1 + e[0], e[1]))
    return np.tanh(a), 2 * share[1]


def _by_slope(value: Callable[[Array], Array], least: Callable[[Array, Array], Array], root: float):  # type: ignore[no-untyped-def]
    """A function whose slope is at most ``least ** -root`` over a disc, if that is positive."""

    def rule(a: Array, r: Array) -> Disc:
        below = least(a, r)
        return value(a), _where(below > 0, r * below**-root)

    return rule


def _erf(a: Array, r: Array) -> Disc:
    slope = 2 / np.sqrt(np.pi) * np.exp(-(a**2) + 2 * np.abs(a) * r + r**2)
    return np.asarray(scipy.special.erf(a)), r * slope


def _erfc(a: Array, r: Array) -> Disc:
    value, off = _erf(a, r)
    return 1 - value, off


def _where(analytic: NDArray[np.bool_], radius: Array) -> Array:
    return np.where(analytic, radius, np.inf)


FUNCTIONS: Mapping[type, Callable[[Array, Array], Disc]] = {
    sp.exp: _exp, sp.log: _log, sp.sin: _sin, sp.cos: _cos, sp.tan: _tan, sp.cot: _cot, sp.sec: _sec,
    sp.csc: _csc, sp.sinh: _sinh, sp.cosh: _cosh, sp.tanh: _tanh, sp.erf: _erf, sp.erfc: _erfc,
    sp.atan: _by_slope(np.arctan, lambda a, r: 1 + a**2 - 2 * np.abs(a) * r - r**2, 1.0),
    sp.asin: _by_slope(np.arcsin, lambda a, r: 1 - a**2 - 2 * np.abs(a) * r - r**2, 0.5),
    sp.acos: _by_slope(np.arccos, lambda a, r: 1 - a**2 - 2 * np.abs(a) * r - r**2, 0.5),
    sp.asinh: _by_slope(np.arcsinh, lambda a, r: 1 + a**2 - 2 * np.abs(a) * r - r**2, 0.5),
}  # fmt: skip
"""The rule for each function."""
