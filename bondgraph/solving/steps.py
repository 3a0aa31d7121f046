"""Long expressions told in steps: parts by name, each over others, put in where that stays short."""

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import sympy as sp

FEW = 8
"""A part of fewer operands is put in wherever it is used."""

MOST = 4_000
"""Results in which nothing is named have so many operands at most, all together."""

Parts = Mapping[sp.Symbol, sp.Expr]
"""What names stand for; none is over itself, by way of others or not."""


@dataclass(frozen=True)
class Told:
    """Results over names, and what those names are that stand for parts, each over earlier ones."""

    results: tuple[sp.Expr, ...]
    parts: Parts


class Steps:
    """Parts of expressions in the making; equal parts have one name.

    >>> steps, x = Steps(), sp.Symbol("x")
    >>> steps.named(x + 1) == steps.named(1 + x), steps.named(x)
    (True, x)
    """

    def __init__(self) -> None:
        self.parts: dict[sp.Symbol, sp.Expr] = {}
        self._names: dict[sp.Expr, sp.Symbol] = {}

    def named(self, expr: sp.Expr) -> sp.Expr:
        """A name for an expression; itself where it is a name or a number, perhaps with a minus."""
        if expr.is_Atom or (expr.is_Mul and len(expr.args) == 2 and expr.args[0] == -1):
            return expr
        if expr not in self._names:
            name = self._names[expr] = sp.Dummy("s")
            self.parts[name] = expr
        return self._names[expr]


def told(results: Iterable[sp.Expr], parts: Parts, most: int = MOST) -> Told:
    """Results with all parts put in, if they have no more operands than ``most`` then.

    Else parts that are short or used once are put in, and the others stay, in the order of their use.

    >>> x, y, a, b = sp.symbols("x y a b")
    >>> parts = {b: a**2 + x, a: (x + 1)*y*sp.sin(x + y)}
    >>> told([a + sp.sqrt(b)], {b: a + x, a: x*y}).results
    (x*y + sqrt(x*y + x),)
    >>> told([a + b], parts, most=9).parts
    {a: y*(x + 1)*sin(x + y)}
    """
    results = tuple(results)
    order = _order(results, parts)
    kept = (
        set[sp.Symbol]() if _size(results, parts, order) <= most else _kept(results, parts, order)
    )
    put_in: dict[sp.Symbol, sp.Expr] = {}
    left: dict[sp.Symbol, sp.Expr] = {}
    for name in order:
        (left if name in kept else put_in)[name] = parts[name].xreplace(put_in)
    return Told(tuple(result.xreplace(put_in) for result in results), left)


def size(expr: sp.Expr, known: Mapping[sp.Expr, int]) -> int:
    """How many operands an expression has; ``known``: how many those names have that are counted."""
    if not expr.args:
        return known.get(expr, 1)
    return 1 + sum(size(part, known) for part in expr.args)


def _size(results: Iterable[sp.Expr], parts: Parts, order: Iterable[sp.Symbol]) -> int:
    """How many operands results have with all parts put in."""
    known: dict[sp.Expr, int] = {}
    for name in order:
        known[name] = size(parts[name], known)
    return sum(size(result, known) for result in results)


def _kept(results: Iterable[sp.Expr], parts: Parts, order: list[sp.Symbol]) -> set[sp.Symbol]:
    """The parts that stay names: those used more than once that are not short."""
    uses = Counter(
        name
        for expr in (*results, *(parts[name] for name in order))
        for name in sp.preorder_traversal(expr)
        if name in parts
    )
    known: dict[sp.Expr, int] = {}
    kept = set[sp.Symbol]()
    for name in order:
        known[name] = size(parts[name], known)
        if uses[name] > 1 and known[name] >= FEW:
            known[name] = 1
            kept.add(name)
    return kept


def _order(results: Iterable[sp.Expr], parts: Parts) -> list[sp.Symbol]:
    """The parts that results are over, each after those that it is over itself."""
    place = {name: at for at, name in enumerate(parts)}
    found: dict[sp.Symbol, None] = {}
    waiting = [(name, False) for result in results for name in _used(result, place)]
    waiting.reverse()
    while waiting:
        name, is_last = waiting.pop()
        if is_last:
            found[name] = None
        elif name not in found:
            waiting.append((name, True))
            waiting += [(one, False) for one in _used(parts[name], place)[::-1] if one not in found]
    return list(found)


def _used(expr: sp.Expr, place: Mapping[sp.Symbol, int]) -> list[sp.Symbol]:
    """The parts in an expression, in their own order."""
    return sorted(expr.free_symbols & place.keys(), key=place.__getitem__)
