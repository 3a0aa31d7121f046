"""What an operating point does not tell and its equations do: rates of signals, and efforts that hold."""

from collections.abc import Iterable

import sympy as sp

from bondgraph.reduce.record import Reading


class Unknown(sp.Dummy):  # type: ignore[misc]
    """A number at the operating point that stands in rows until it is solved for."""


class Moment(sp.Dummy):  # type: ignore[misc]
    """The time since the operating point, in what moves along from there."""


class Unknowns:
    """One `Unknown` for each name's value, and one for its rate, made where it is asked for first."""

    def __init__(self) -> None:
        self.values: dict[sp.Symbol, Unknown] = {}
        self.rates: dict[sp.Symbol, Unknown] = {}

    def value(self, name: sp.Symbol) -> Unknown:
        """What stands for the value of a signal."""
        return self.values.setdefault(name, Unknown(name.name))

    def rate(self, name: sp.Symbol) -> Unknown:
        """What stands for how fast a signal changes."""
        return self.rates.setdefault(name, Unknown(name.name))


def still(expr: sp.Expr) -> sp.Expr:
    """An expression that moves along from the operating point, at that point."""
    return expr.xreplace(dict.fromkeys(expr.atoms(Moment), sp.Integer(0)))


def unknowns_in(rows: Iterable[Reading]) -> set[Unknown]:
    """All that stand in entries of rows."""
    return {
        u for row in rows for part in row.parts for e in part.values() for u in e.atoms(Unknown)
    }
