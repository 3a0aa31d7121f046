"""Tables inside expressions: opaque functions that carry their points and know their slopes."""

import re
from collections.abc import Callable
from functools import lru_cache
from typing import Any, Self

import sympy as sp

from bondgraph.algebra.called import Called
from bondgraph.tables.backward import looked_back
from bondgraph.tables.integral import integrated
from bondgraph.tables.looking import Patches, looked_up
from bondgraph.tables.pieces import pieces
from bondgraph.tables.record import Sampled

INTEGRAL = (-1,)
"""The orders of the integral of a table over one axis, which energies are told by."""


class Handle(sp.AtomicExpr):  # type: ignore[misc]
    """A table and which of its derivatives is meant: the first argument of a `Look`; no number, no name."""

    __slots__ = ("orders", "table")
    is_commutative = True
    is_number = False

    table: Sampled
    orders: tuple[int, ...]

    def __new__(cls, table: Sampled, orders: tuple[int, ...]) -> Self:
        """The same object to sympy where table and orders are equal."""
        made: Self = sp.AtomicExpr.__new__(cls)
        made.table, made.orders = table, orders
        return made

    def __getnewargs__(self) -> tuple[Sampled, tuple[int, ...]]:
        return self.table, self.orders

    def _hashable_content(self) -> tuple[str, str]:
        return self.table.digest, str(self.orders)

    @property
    def code(self) -> str:
        """A text that no other table and no other derivative has."""
        orders = "whole" if self.orders == INTEGRAL else "".join(map(str, self.orders))
        plain = re.sub(r"\W", "_", self.table.name, flags=re.ASCII)
        return f"{plain}_{orders}_{self.table.digest}"

    def _sympystr(self, printer: Any) -> str:
        return self.code

    def _sympyrepr(self, printer: Any) -> str:
        return f"Handle({self.code!r})"

    def looked_up(self, *places: float) -> float:
        """The value at numbers."""
        if self.orders == INTEGRAL:
            return looked_up(_integral(self.table), (0,), places)
        look = looked_back if self.table.turned else looked_up
        return look(pieces(self.table), self.orders, places)


@lru_cache(maxsize=64)
def _integral(table: Sampled) -> Patches:
    return integrated(pieces(table), table.values[0], table.values[-1])


OVERSHOOTING = ("akima", "bicubic")
"""Methods by which values between points may be beyond these."""


class Tabled(Called):
    """What numbers come of by a table, its first argument a `Handle`, and by arguments that have numbers."""

    @property
    def handle(self) -> Handle:
        """The table that is looked into."""
        found: Handle = self.args[0]
        return found

    @property
    def code(self) -> str:
        """What it is called in Python over numpy, where names that begin so are nobody else's."""
        fixed = "".join(f"_{one}" for one in self.args[1 : self.FIXED])
        return f"_{type(self).__name__.lower()}_{self.handle.code}{fixed}"


class Look(Tabled):
    """``Look(handle, x[, y])``: a table, or one of its derivatives, at these arguments.

    To exact algebra it is a function that nothing is known of; only where numbers are asked for, it has
    those of `looked_up`.
    """

    @property
    def numeric(self) -> Callable[..., float]:
        """Of its arguments."""
        return self.handle.looked_up

    @property
    def bounds(self) -> tuple[sp.Expr, sp.Expr] | None:
        """Between what all its values lie, where that is told by the points alone."""
        table = self.handle.table
        if any(self.handle.orders) or table.outside == "extend" or table.method in OVERSHOOTING:
            return None
        return sp.Rational(min(table.values)), sp.Rational(max(table.values))

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """The derivative by one argument: the same table, one order higher along that."""
        axis, handle = argindex - 2, self.handle
        orders = tuple(one + (at == axis) for at, one in enumerate(handle.orders))
        if handle.table.turned and orders == (4,):
            x1, x2, x3 = (Look(Handle(handle.table, (one,)), *self.places) for one in (1, 2, 3))
            # The derivatives of a cubic's inverse follow from the first three.
            return 10 * x2 * x3 / x1 - 15 * x2**3 / x1**2
        if orders[axis] > (3 if handle.table.smooth else 1):
            return sp.Integer(0)
        return Look(Handle(handle.table, orders), *self.places)

    def _sympystr(self, printer: Any) -> str:
        return f"{_title(self.handle)}({', '.join(map(printer._print, self.places))})"

    def _latex(self, printer: Any, exp: str | None = None) -> str:
        inside = ", ".join(map(printer._print, self.places))
        name = printer._hprint_Function(self.handle.table.name)
        marks = _marks(self.handle)
        text = rf"{name}{f'_{{{marks}}}' if marks else ''}\left({inside}\right)"
        return text if exp is None else rf"{{{text}}}^{{{exp}}}"


def _marks(handle: Handle) -> str:
    return "".join(letter * order for letter, order in zip("xy", handle.orders, strict=False))


def _title(handle: Handle) -> str:
    """The table's name; of a derivative with a mark for each time, which no text can call."""
    if handle.orders == INTEGRAL:
        return f"{handle.table.name}'integral"
    if len(handle.orders) == 1:
        return handle.table.name + "'" * handle.orders[0]
    marks = _marks(handle)
    return f"{handle.table.name}'{marks}" if marks else handle.table.name
