"""Rates of states as text and as LaTeX, one line each; denominators that repeat are shown once."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import count

import sympy as sp

from bondgraph.show.ruled import Ruled
from bondgraph.show.sums import rate, typeset
from bondgraph.solving.steps import size

Told = Mapping[sp.Symbol, sp.Expr]

SHORT = 6
"""A denominator of fewer operands is written wherever it stands."""

LEFT = "nonlinear laws at once, left to be solved:"
"""Above equations in which a name stands on both sides."""


@dataclass(frozen=True)
class Lines:
    """What is shown: rates, equations that are left, and what names in both stand for."""

    rates: Told
    implicit: Told
    where: Told


def once(rates: Told, implicit: Told, where: Told) -> Lines:
    """The same with a name for each long denominator that repeats: ``Delta``, ``Delta_1`` and so on.

    >>> x, y, a, b = sp.symbols("x y a b")
    >>> shown = once({x: x/(a*b + 2*a + b), y: y/(a*b + 2*a + b)}, {}, {})
    >>> shown.rates, shown.where
    ({x: x/Delta, y: y/Delta}, {Delta: a*b + 2*a + b})
    """
    every = (*rates.values(), *implicit.values(), *where.values())
    found = Counter(base for expr in every for base in _below(expr))
    repeated = [base for base, times in found.items() if times > 1]
    if not repeated:
        return Lines(rates, implicit, where)
    taken = {name.name for expr in (*every, *rates, *where) for name in expr.free_symbols}
    free = (n for at in count(1) if (n := f"Delta_{at}") not in taken)
    single = len(repeated) == 1 and "Delta" not in taken
    names = {base: sp.Symbol("Delta" if single else next(free)) for base in repeated}
    short = [{name: _shortened(e, names) for name, e in told.items()}
             for told in (rates, implicit, where)]  # fmt: skip
    return Lines(short[0], short[1], _in_order(short[2], names))


def _below(expr: sp.Expr) -> list[sp.Expr]:
    """The long sums below fraction lines."""
    return [
        part.base
        for part in sp.preorder_traversal(expr)
        if part.is_Pow and part.exp.is_Integer and part.exp < 0
        and part.base.is_Add and size(part.base, {}) >= SHORT
    ]  # fmt: skip


def _shortened(expr: sp.Expr, names: Mapping[sp.Expr, sp.Symbol]) -> sp.Expr:
    return expr.replace(
        lambda part: part.is_Pow and part.exp.is_Integer and part.exp < 0 and part.base in names,
        lambda part: names[part.base] ** part.exp,
    )


def _in_order(where: Told, names: Mapping[sp.Expr, sp.Symbol]) -> dict[sp.Symbol, sp.Expr]:
    """Denominators beside other parts, each as soon as what it is over is told."""
    waiting = {name: base for base, name in names.items()}
    found: dict[sp.Symbol, sp.Expr] = {}
    for left in range(len(where), -1, -1):
        open_ = set(list(where)[len(where) - left :])
        ready = [name for name, base in waiting.items() if not base.free_symbols & open_]
        found |= {name: waiting.pop(name) for name in ready}
        if left:
            name = list(where)[len(where) - left]
            found[name] = where[name]
    return found


def rates_text(
    rates: Told, implicit: Told, where: Told, ruled: Mapping[sp.Symbol, Ruled] | None = None
) -> str:
    """``v' = ...`` for each state, equations that are left by name, and below what names stand for."""
    ruled = ruled or {}
    shown = once({name: e for name, e in rates.items() if name not in ruled}, implicit, where)
    told = {name: f"{rate(name)} = {expr}" for name, expr in shown.rates.items()}
    told |= {name: f"{one.left} = {one.text()}" for name, one in ruled.items()}
    lines = _by_states(told, rates)
    if shown.implicit:
        lines += [LEFT, *(f"  {name} = {expr}" for name, expr in shown.implicit.items())]
    if shown.where:
        lines += ["where", *(f"  {name} = {expr}" for name, expr in shown.where.items())]
    return "\n".join(lines)


def _by_states(told: Mapping[sp.Symbol, str], rates: Told) -> list[str]:
    """States in their order, then what has a value."""
    return [told[name] for name in (*rates, *(one for one in told if one not in rates))]


def rates_latex(
    rates: Told, implicit: Told, where: Told, ruled: Mapping[sp.Symbol, Ruled] | None = None
) -> str:
    r"""The same in LaTeX, each line with ``&=``.

    >>> v, F, m = sp.symbols("v F m")
    >>> print(rates_latex({v: F/m}, {}, {}))
    \dot{v} &= \frac{F}{m}
    """
    ruled = ruled or {}
    shown = once({name: e for name, e in rates.items() if name not in ruled}, implicit, where)
    told = {name: f"{typeset(rate(name))} &= {typeset(e)}" for name, e in shown.rates.items()}
    told |= {name: f"{typeset(one.left)} &= {one.latex()}" for name, one in ruled.items()}
    lines = _by_states(told, rates)
    if shown.implicit:
        lines.append(rf"&\text{{{LEFT}}}")
        lines += [f"{typeset(name)} &= {typeset(e)}" for name, e in shown.implicit.items()]
    if shown.where:
        lines.append(r"&\text{where}")
        lines += [f"{typeset(name)} &= {typeset(e)}" for name, e in shown.where.items()]
    return " \\\\\n".join(lines)
