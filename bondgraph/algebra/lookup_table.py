"""`LookupTable`: a function by its points, called by its name wherever a value or a law may stand."""

import os
from typing import Any, Self

import sympy as sp

from bondgraph.algebra.atoms import symbol
from bondgraph.algebra.conditions import PIECEWISE
from bondgraph.algebra.expressions import TIME, expression
from bondgraph.algebra.functions import FUNCTIONS
from bondgraph.algebra.lookups import Handle, Look
from bondgraph.errors import ExpressionError, TableError
from bondgraph.tables.points import checked, points
from bondgraph.tables.read import read_points
from bondgraph.tables.record import Sampled


class LookupTable(Sampled):
    """A function of one argument or two by its points, which values and laws call by its name.

    ``LookupTable("map", x, z)`` or ``LookupTable("map", x, y, z)``: x and y increase, z has a row for each x
    and, over two axes, a column for each y. Instead of arrays one pandas Series, by its index, or DataFrame,
    by its index and columns. ``method``: "linear" (numpy's `interp`), "pchip" (`PchipInterpolator`, monotone
    where the points are), "akima" (`Akima1DInterpolator`); over two axes "bilinear", which "linear" means
    there, or "bicubic" (`RectBivariateSpline` with ``s=0``). ``outside``, beyond the ends: "hold" the value
    at the end, "extend" the polynomial there, or "refuse", where a run ends that goes there.

    Text calls a table where the graph or whoever reads the text has it: ``networkx.DiGraph(tables=[map])``,
    ``expression("map(w)", "law", [map])``. A table that is called itself gives an expression that needs
    none of this. Units are those of the points.

    Raises `TableError`, naming table and row, for points that are no table.

    >>> torque = LookupTable("torque", [0, 100, 200], [10, 30, 20])
    >>> torque("omega"), torque("omega").diff("omega"), float(torque(150))
    (torque(omega), torque'(omega), 25.0)
    """

    def __init__(
        self, name: str, *samples: Any, method: str = "linear", outside: str = "hold"
    ) -> None:
        try:
            told = symbol(name, "a table's name").name
        except ExpressionError as error:
            raise TableError(str(error)) from None
        if told in FUNCTIONS or told in (PIECEWISE, TIME.name):
            raise TableError(f"table {told!r}: that is a name of expressions' own; take another")
        axes, values = points(told, samples)
        for field, value in vars(checked(told, axes, values, method, outside)).items():
            object.__setattr__(self, field, value)

    def __call__(self, *arguments: object) -> sp.Expr:
        """The expression that looks in at these arguments: texts, numbers or expressions."""
        if len(arguments) != len(self.axes):
            raise TableError(
                f"table {self.name!r} takes {len(self.axes)} argument(s), not {len(arguments)}"
            )
        where = f"argument of table {self.name!r}"
        places = [expression(argument, where) for argument in arguments]
        return looked_in(self, *places)

    @classmethod
    def read(
        cls, name: str, path: str | os.PathLike[str], method: str = "linear", outside: str = "hold"
    ) -> Self:
        """The table in a CSV file, by commas, semicolons or tabs.

        Two columns are x and z, below a header or none. More are a table over two axes: the first line has
        anything and then y, each further one an x and the values there.

        Raises `TableError` naming the file's line.
        """
        return cls(name, *read_points(name, path), method=method, outside=outside)


def looked_in(table: Sampled, *places: sp.Expr) -> sp.Expr:
    """A table at expressions."""
    return Look(Handle(table, (0,) * len(table.axes)), *places)
