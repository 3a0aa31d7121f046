"""`Branch`: one of two expressions, as a side tells; and what has corners or jumps written with it."""

from collections.abc import Callable
from typing import Any

import sympy as sp
from sympy.core.relational import Ge, Gt, Le, Lt

from bondgraph.algebra.lookups import Look
from bondgraph.algebra.whole import Floor
from bondgraph.tables.looking import FREE
from codegen.corners.tabled import Edge, EdgeOn, LookOn, region_of, signs_of


class Branch(sp.Function):  # type: ignore[misc]
    """``Branch(side, above, below)``: ``above`` where the side is 1, ``below`` where it is -1.

    A side may be an expression of sides. Only one of the two is evaluated.

    >>> side, x = sp.symbols("side x")
    >>> f = sp.lambdify([side, x], Branch(side, x, 1/x))
    >>> f(1, 0), f(-1, 2)
    (0, 0.5)
    """

    nargs = 3

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """How much more it is for each more of an argument; a side does not move."""
        return (
            sp.S.Zero
            if argindex == 1
            else Branch(self.args[0], int(argindex == 2), int(argindex == 3))
        )

    def _pythoncode(self, printer: Any) -> str:
        side, above, below = map(printer._print, self.args)
        return f"(({above}) if ({side}) > 0 else ({below}))"

    _numpycode = _pythoncode


Side = Callable[[sp.Expr], tuple[sp.Symbol, int] | None]
"""The side of what is compared with zero, and 1, or -1 where it is that of its negative; None where it has
no side, as it does not move."""


class Sided:
    """Expressions on one side of each of their corners, which ``side`` names."""

    def __init__(self, side: Side) -> None:
        self._side = side
        self._done: dict[sp.Basic, sp.Basic] = {}

    def put(self, expr: sp.Expr) -> sp.Expr:
        """An expression with a branch for each corner and jump; itself where it has none."""
        if expr not in self._done:
            self._done[expr] = self._put(expr) if expr.has(*KINDS) else expr
        return self._done[expr]

    def _put(self, expr: sp.Expr) -> sp.Expr:
        if isinstance(expr, sp.Abs):
            inside = self.put(expr.args[0])
            return self._at(expr.args[0], inside, -inside, sp.Abs(inside))
        if isinstance(expr, sp.sign):
            one = sp.Integer(1)
            return self._at(expr.args[0], one, -one, sp.sign(self.put(expr.args[0])))
        if isinstance(expr, sp.Heaviside):
            plain = sp.Heaviside(self.put(expr.args[0]), *expr.args[1:])
            return self._at(expr.args[0], sp.Integer(1), sp.Integer(0), plain)
        if isinstance(expr, sp.Max | sp.Min):
            return self._extreme(expr)
        if isinstance(expr, Look):
            return self._look(expr)
        if isinstance(expr, Floor):
            inside = self.put(expr.args[0])
            above, below = (expr.on_side(inside, side) for side in (1, -1))
            return self._at(expr.size, above, below, Floor(inside))
        if isinstance(expr, Edge):
            region = self._region(expr.all_bits)
            return EdgeOn(*expr.args[:3], self.put(expr.args[3]), region)
        if isinstance(expr, sp.Piecewise):
            found = sp.nan
            for value, condition in reversed(expr.args):
                found = self.chosen(condition, self.put(value), found)
            return found
        return expr.func(*(self.put(part) for part in expr.args))

    def _extreme(self, expr: sp.Expr) -> sp.Expr:
        """The largest or least of several, two by two."""
        first, *others = sorted(expr.args, key=sp.default_sort_key)
        found = self.put(first)
        for other in others:
            mine = self.put(other)
            above, below = (found, mine) if isinstance(expr, sp.Max) else (mine, found)
            found = self._at(first - other, above, below, expr.func(found, mine))
            first = expr.func(first, other)
        return found

    def _at(self, size: sp.Expr, above: sp.Expr, below: sp.Expr, plain: sp.Expr) -> sp.Expr:
        told = self._side(size)
        if told is None:
            return plain
        side, way = told
        return Branch(side, above, below) if way > 0 else Branch(side, below, above)

    def _look(self, expr: Look) -> sp.Expr:
        """A table on the stretch that sides tell along each axis."""
        regions = [self._region(signs_of(expr, axis)) for axis in range(len(expr.places))]
        inside = map(self.put, expr.places)
        if all(region == FREE for region in regions):
            return Look(expr.handle, *inside)
        return LookOn(expr.handle, *inside, *regions)

    def _region(self, signs: list[Edge]) -> sp.Expr:
        told = [self._side(sign) for sign in signs]
        return region_of([way * side for side, way in filter(None, told)] if all(told) else [])

    def chosen(self, condition: sp.Basic, yes: sp.Expr, no: sp.Expr) -> sp.Expr:
        """One of two by a condition."""
        if condition in (sp.true, sp.false):
            return yes if condition == sp.true else no
        if isinstance(condition, Gt | Ge | Lt | Le):
            above, below = (yes, no) if isinstance(condition, Gt | Ge) else (no, yes)
            plain = sp.Piecewise((yes, condition), (no, True))
            return self._at(condition.lhs - condition.rhs, above, below, plain)
        return _either(self._holds(condition), yes, no)

    def _holds(self, condition: sp.Basic) -> sp.Expr:
        """1 where a condition holds, else -1."""
        one, parts = sp.Integer(1), sorted(condition.args, key=sp.default_sort_key)
        if isinstance(condition, sp.Not):
            return -self._holds(parts[0])
        if isinstance(condition, sp.And | sp.Or):
            first, *others = map(self._holds, parts)
            for other in others:
                both = isinstance(condition, sp.And)
                first = _either(first, *((other, -one) if both else (one, other)))
            return first
        told = None
        if isinstance(condition, Gt | Ge | Lt | Le):
            told = self._side(condition.lhs - condition.rhs)
        if told is not None:
            side, way = told
            return way * side if isinstance(condition, Gt | Ge) else -way * side
        # What is so at single points, or is no comparison, has no side.
        return sp.Piecewise((one, condition), (-one, True))


def _either(side: sp.Expr, above: sp.Expr, below: sp.Expr) -> sp.Expr:
    """A branch, of the side itself where that of its negative is asked for."""
    return Branch(-side, below, above) if (-side).is_Symbol else Branch(side, above, below)


KINDS = (sp.Abs, sp.sign, sp.Heaviside, sp.Max, sp.Min, sp.Piecewise, Floor, Look, Edge)
"""What has corners or jumps."""
