"""Tables turned round: of straight lines by their points the other way, of cubics by solving these."""

from collections.abc import Sequence

from bondgraph.algebra.lookups import Handle
from bondgraph.tables.looking import BACK
from bondgraph.tables.one_way import one_way
from bondgraph.tables.record import Sampled


def turned_table(handle: Handle) -> Handle | None:
    """The table that gives back what this one was given; None where that is none.

    Beyond its ends it goes on where this one goes on the same way; else it refuses what is outside, which
    this one gives nowhere, or as it turns back.

    >>> of = Sampled("charge", ((0.0, 1.0, 3.0),), (5.0, 4.0, 0.0), "linear", "extend")
    >>> back = turned_table(Handle(of, (0,))).table
    >>> back.name, back.axes, back.values
    ('charge⁻¹', ((0.0, 4.0, 5.0),), (3.0, 1.0, 0.0))
    """
    table = handle.table
    if len(table.axes) != 1 or handle.orders != (0,) or table.turned:
        return None
    told = one_way(table)
    if not told.way:
        return None
    x, z = table.axes[0][:: told.way], table.values[:: told.way]
    method = table.method + (BACK if table.smooth else "")
    outside = "extend" if table.outside == "extend" and told.beyond else "refuse"
    return Handle(Sampled(table.name + BACK, (z,), x, method, outside), (0,))


def fixed(tables: Sequence[Sampled]) -> frozenset[str]:
    """The names of tables that keep their values in what is generated: those turned round, either way.

    One of them by itself with other values would no longer be the other turned round.
    """
    turned = [table.name for table in tables if table.name.endswith(BACK)]
    return frozenset([*turned, *(name.removesuffix(BACK) for name in turned)])
