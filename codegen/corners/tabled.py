"""Tables on one side of each of their corners, and what the sides hang on.

The stretches between a table's corners are numbered, and each bit of the number in Gray's code is a side: the
polynomial of a stretch goes on beyond its ends, and at an end one side alone changes.
"""

from collections.abc import Callable, Iterator, Sequence
from functools import partial

import sympy as sp

from bondgraph.algebra.lookups import Handle, Look, Tabled
from bondgraph.tables.backward import looked_back
from bondgraph.tables.edges import bits, edge, edges
from bondgraph.tables.looking import FREE, looked_up
from bondgraph.tables.pieces import pieces
from codegen.program.records import TableEnds


class LookOn(Tabled):
    """``LookOn(handle, x[, y], region_x[, region_y])``: a `Look` by the polynomials of these stretches.

    A region is a number, or `FREE`, where the argument tells the polynomial.
    """

    @property
    def numeric(self) -> Callable[..., float]:
        """Of arguments and regions."""
        handle = self.handle
        table, count = pieces(handle.table), len(handle.orders)
        look = looked_back if handle.table.turned else looked_up
        return lambda *told: look(table, handle.orders, told[:count], told[count:])


class Edge(Tabled):
    """``Edge(handle, axis, bit, x)``: changes its sign at the corners at which the bit does."""

    FIXED = 3

    @property
    def numeric(self) -> Callable[..., float]:
        """Of x, and of a region where there is one."""
        return partial(edge, pieces(self.handle.table), int(self.args[1]), int(self.args[2]))

    @property
    def all_bits(self) -> list["Edge"]:
        """Of every bit along this axis, the lowest first."""
        handle, axis, _, x, *_ = self.args
        count = bits(len(edges(pieces(handle.table), int(axis))))
        return [Edge(handle, axis, sp.Integer(bit), x) for bit in range(count)]


class EdgeOn(Edge):
    """``EdgeOn(handle, axis, bit, x, region)``: the same by the two corners of a stretch."""


def signs_of(look: Look, axis: int) -> list[Edge]:
    """What the sides of a table's corners along an axis hang on; none where it has no corners."""
    table = look.handle.table
    first = Edge(
        Handle(table, (0,) * len(table.axes)), sp.Integer(axis), sp.Integer(0), look.places[axis]
    )
    return first.all_bits


def region_of(sides: Sequence[sp.Expr]) -> sp.Expr:
    """The number of the stretch, from its bits in Gray's code: 1 where one is off, -1 where it is on.

    >>> region_of([sp.Integer(-1), sp.Integer(1)]), region_of([sp.Integer(-1), sp.Integer(-1)])
    (1, 2)
    """
    if not sides:
        return sp.Integer(FREE)
    found, product = sp.Integer(0), sp.Integer(1)
    for bit in reversed(range(len(sides))):
        product = product * sides[bit]
        found += sp.Integer(2) ** bit * (1 - product) / 2
    return found


def ends_of(sizes: Sequence[sp.Expr]) -> Iterator[TableEnds]:
    """The ends of tables that refuse what is outside."""
    for size in sizes:
        if isinstance(size, Edge) and int(size.args[2]) == 0:
            handle, axis, _, argument = size.args
            table = pieces(handle.table)
            if handle.table.outside == "refuse":
                places, knots = edges(table, int(axis)), table[0][int(axis)]
                sides = tuple(sizes.index(bit) for bit in size.all_bits)
                yield TableEnds(
                    handle.table.name, argument, (knots[0], knots[-1]), sides, len(places)
                )
