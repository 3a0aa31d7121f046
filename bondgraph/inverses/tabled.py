"""Tables turned round: of straight lines that rise or fall all the way, by their points the other way."""

from collections.abc import Sequence
from itertools import pairwise

from bondgraph.algebra.lookups import Handle
from bondgraph.tables.record import Sampled

TURNED = "⁻¹"
"""How the name of a table that is turned round ends, which no declared one does."""


def turned_table(handle: Handle) -> Handle | None:
    """The table that gives back what this one was given; None where that is none, or no straight lines.

    Beyond its ends it goes on, or refuses, as this one does.

    >>> of = Sampled("charge", ((0.0, 1.0, 3.0),), (5.0, 4.0, 0.0), "linear", "extend")
    >>> back = turned_table(Handle(of, (0,))).table
    >>> back.name, back.axes, back.values
    ('charge⁻¹', ((0.0, 4.0, 5.0),), (3.0, 1.0, 0.0))
    """
    table = handle.table
    if table.method != "linear" or table.outside == "hold" or handle.orders != (0,):
        return None
    (x,), z = table.axes, table.values
    if all(a > b for a, b in pairwise(z)):
        x, z = x[::-1], z[::-1]
    if not all(a < b for a, b in pairwise(z)):
        return None
    return Handle(Sampled(table.name + TURNED, (z,), x, "linear", table.outside), (0,))


def fixed(tables: Sequence[Sampled]) -> frozenset[str]:
    """The names of tables that keep their values in what is generated: those turned round, either way.

    One of them by itself with other values would no longer be the other turned round.
    """
    turned = [table.name for table in tables if table.name.endswith(TURNED)]
    return frozenset([*turned, *(name.removesuffix(TURNED) for name in turned)])
