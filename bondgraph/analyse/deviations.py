"""Rows whose coefficients change in time, for small deviations from an operating point."""

from collections.abc import Callable, Sequence

import sympy as sp

from bondgraph.algebra.called import unguarded
from bondgraph.algebra.expressions import TIME
from bondgraph.algebra.table_corners import check_tables
from bondgraph.analyse.slopes import Point
from bondgraph.analyse.unknowns import Moment, Unknowns
from bondgraph.equations import StateEquations
from bondgraph.errors import SignalError
from bondgraph.reduce.motion import slope_of
from bondgraph.reduce.record import Reading, ReadingSum


class Deviations:
    """The coefficients of equations at an operating point, and what rows gain as it is left.

    ``states``, ``columns``: the symbols behind the columns of rows. ``given``: inputs that laws and held
    ports give; where the point lacks one, an `Unknown` stands for it, as for the rates. ``moment``: the time
    since the point, where rows move along from there.
    """

    def __init__(
        self, equations: StateEquations, states: Sequence[sp.Symbol], columns: Sequence[sp.Symbol],
        given: set[sp.Symbol], point: Point, unknowns: Unknowns, moment: Moment | None = None,
    ) -> None:  # fmt: skip
        self._equations, self._point, self._unknowns = equations, point, unknowns
        self._states, self._columns, self._given, self._moment = states, columns, given, moment
        self._varying = {*equations.varying} & {*states, *columns}
        self._moving = {*equations.varying, *states, *columns, TIME}

    def there(self, expr: sp.Expr) -> sp.Expr:
        """An expression at the operating point."""
        names = sorted(expr.free_symbols & self._moving, key=str)
        missing = [name for name in names if not self._told(name)]
        if missing:
            raise SignalError(
                f"values of the graph change with {', '.join(map(str, missing))}: give a value in at"
            )
        return unguarded(expr).subs({name: self.value(name) for name in names})

    def value(self, name: sp.Symbol) -> sp.Expr:
        """A state or an input at the point; `SignalError` for one that nothing tells."""
        if not self._told(name):
            raise SignalError(
                f"where values of the graph change, {name} counts at the operating point: give it a value "
                "in at"
            )
        if name in self._point:
            return self._point[name]
        moved = 0 if self._moment is None else self._moment * self._unknowns.rate(name)
        return self._unknowns.value(name) + moved

    def _told(self, name: sp.Symbol) -> bool:
        return name in self._point or name in self._given

    def row(self, row: Reading, signal: Callable[[sp.Symbol], Reading]) -> Reading:
        """What a row deviates by: ``g(xi) v`` by ``g v`` at the point, and by the slope of g by each xi
        times v there. v is a state or an input, or the rate of one. ``signal``: xi as a row.
        """
        if not self._equations.varying:
            return row
        there = [{j: self.there(entry) for j, entry in part.items()} for part in row.parts]
        kept = ({j: value for j, value in part.items() if value != 0} for part in there)
        result = ReadingSum(Reading(*kept))
        for part, told in zip(row.parts, self.variables, strict=True):
            for j, entry in part.items():
                check_tables(entry, f"the value {entry}", self.there)
                for name in sorted(entry.free_symbols & self._varying, key=str):
                    slope = self.there(slope_of(entry, name))
                    if slope != 0:
                        result.add(signal(name), slope * told(j))
        return result.whole()

    @property
    def variables(self) -> tuple[Callable[[int], sp.Expr], ...]:
        """What each part of a row multiplies, at the point, by the column."""
        states, columns, unknowns = self._states, self._columns, self._unknowns
        return (
            lambda j: self.value(states[j]), lambda j: self.value(columns[j]),
            lambda j: unknowns.rate(states[j]), lambda j: unknowns.rate(columns[j]),
        )  # fmt: skip
