"""Tables at an operating point: refused where they have no value there, or more than one slope."""

from collections.abc import Callable

import sympy as sp

from bondgraph.algebra.lookups import Look
from bondgraph.errors import SignalError
from bondgraph.tables.edges import edges
from bondgraph.tables.looking import FREE, looked_up
from bondgraph.tables.pieces import pieces


def check_tables(expr: sp.Expr, what: str, there: Callable[[sp.Expr], sp.Expr]) -> None:
    """Refuse a point beyond a table that has no values there, and one at a corner of a table.

    ``what``: what the expression belongs to; ``there``: an expression at the point. Raises `SignalError`.
    """
    for look in sorted(expr.atoms(Look), key=sp.default_sort_key):
        places = [there(place) for place in look.places]
        cornered = any(_jumps(look, axis) for axis in range(len(places)))
        open_ = sorted({str(one) for place in places for one in place.free_symbols})
        if open_ and not look.GUARDS and (cornered or look.handle.table.outside == "refuse"):
            raise SignalError(
                f"{what}: where in table {look.handle.table.name!r} the operating point lies depends on "
                f"{', '.join(open_)}: give numbers for them in at, too"
            )
        if not open_:
            _check_place(look, what, [float(place) for place in places])


def _check_place(look: Look, what: str, places: list[float]) -> None:
    name, table = look.handle.table.name, pieces(look.handle.table)
    count = len(places)
    value = looked_up(table, (0,) * count, places)
    if value != value:
        raise SignalError(
            f"{what} leaves table {name!r}, which ends, at {', '.join(map(repr, places))}; give it "
            "more points, or another outside"
        )
    for axis, x in enumerate(places):
        if x in _jumps(look, axis):
            at = edges(table, axis).index(x)
            sides = [_slopes(look, places, axis, at + side) for side in (0, 1)]
            if sides[0] != sides[1]:
                raise SignalError(
                    f"{what} has a corner at the operating point, where table {name!r} has one at "
                    f"{look.places[axis]} = {x!r}; linearise on one side of it"
                )


def _jumps(look: Look, axis: int) -> tuple[float, ...]:
    """Where first slopes may jump: of a smooth table at its ends alone."""
    breaks, *_ = table = pieces(look.handle.table)
    ends = (breaks[axis][0], breaks[axis][-1])
    smooth = look.handle.table.smooth
    return tuple(x for x in edges(table, axis) if x in ends or not smooth)


def _slopes(look: Look, places: list[float], axis: int, region: int) -> list[float]:
    """The first derivatives by the polynomials of a stretch."""
    count = len(places)
    regions = [region if at == axis else FREE for at in range(count)]
    table = pieces(look.handle.table)
    units = [tuple(int(at == one) for at in range(count)) for one in range(count)]
    return [looked_up(table, orders, places, regions) for orders in units]
