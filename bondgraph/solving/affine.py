"""Expressions that are linear in some names: their factors at these, and what is left."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass

import sympy as sp
from sympy.polys.polyerrors import PolynomialError

ONE = sp.Integer(1)


@dataclass(frozen=True)
class Affine:
    """``sum of factors[name] name + rest``, none of which holds any of the names."""

    factors: Mapping[sp.Symbol, sp.Expr]
    rest: sp.Expr


def affine(expr: sp.Expr, names: Collection[sp.Symbol]) -> Affine | None:
    """An expression as a linear one in names, exactly; None where it is none.

    >>> u, v, a, b = sp.symbols("u v a b")
    >>> affine(a*(u + b*v) + sp.sin(b), {u, v})
    Affine(factors={u: a, v: a*b}, rest=sin(b))
    >>> affine((u + 1)**2 - u**2, {u}), affine(abs(u), {u}), affine(u*v, {u, v})
    (Affine(factors={u: 2}, rest=1), None, None)
    """
    used = sorted(expr.free_symbols & set(names), key=str)
    found = _parts(expr, set(used))
    if found is None and expr.is_polynomial(*used):
        found = _of_polynomial(expr, used)
    if found is None:
        return None
    return Affine({name: found[name] for name in used if name in found}, found.get(ONE, sp.S.Zero))


def _parts(expr: sp.Expr, names: set[sp.Symbol]) -> dict[sp.Expr, sp.Expr] | None:
    """Factors at names, and the rest at 1, as the expression stands."""
    inside = expr.free_symbols & names
    if not inside:
        return {ONE: expr}
    if expr.is_Symbol:
        return {expr: ONE}
    if expr.is_Mul:
        holding = [part for part in expr.args if part.free_symbols & names]
        found = _parts(holding[0], names) if len(holding) == 1 else None
        beside = sp.Mul(*(part for part in expr.args if part not in holding))
        return found and {name: beside * factor for name, factor in found.items()}
    if not expr.is_Add:
        return None
    terms: dict[sp.Expr, list[sp.Expr]] = {}
    for part in expr.args:
        found = _parts(part, names)
        if found is None:
            return None
        for name, factor in found.items():
            terms.setdefault(name, []).append(factor)
    return {name: sp.Add(*factors) for name, factors in terms.items()}


def _of_polynomial(expr: sp.Expr, names: list[sp.Symbol]) -> dict[sp.Expr, sp.Expr] | None:
    """The same of what is linear only once it is multiplied out."""
    try:
        poly = sp.Poly(expr, *names)
    except PolynomialError:
        return None
    if poly.total_degree() > 1:
        return None
    return {sp.prod(n**p for n, p in zip(names, powers, strict=True)): factor
            for powers, factor in poly.terms()}  # fmt: skip
