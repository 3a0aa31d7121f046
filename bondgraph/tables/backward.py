"""Tables of cubics looked into the other way: where a table that rises, or falls, has a value.

A table that is turned round has the degree -3. Its breaks are the values that the other has at its
breaks; of each cell it has ``(c3, c2, c1, x)``: at ``x + w`` the other is ``c3*w**3 + c2*w**2 + c1*w`` above
the break. C has the same in model_table.c.
"""

import math
from collections.abc import Sequence

from bondgraph.searching import place_where
from bondgraph.tables.looking import FREE, Patches, placed, polynomial


def looked_back(
    table: Patches,
    orders: Sequence[int],
    places: Sequence[float],
    regions: Sequence[float] = (FREE,),
) -> float:
    """The place where the other table has this value, or its derivative of this order, up to the third.

    ``regions``: the stretch whose cubic is solved, beyond that, too, as far as it goes one way.
    """
    (knots,), _, outside, factors = table
    at, above, _ = placed(knots, 3, outside, places[0], regions[0])
    if math.isnan(above):
        return math.nan
    *powers, begin = factors[4 * at : 4 * at + 4]
    cubic = (*powers, 0.0)

    def sloped(w: float) -> tuple[float, float, float]:
        slope = polynomial(cubic, 1, w)
        return polynomial(cubic, 0, w), slope, slope * powers[2]

    w = place_where(sloped, above)
    return begin + w if orders[0] == 0 else slope_back(cubic, orders[0], w)


def slope_back(cubic: Sequence[float], order: int, w: float) -> float:
    """The derivative of an order, 1 to 3, of the inverse of a polynomial, at this place of it."""
    slope, bend, third = (polynomial(cubic, one, w) for one in (1, 2, 3))
    if order == 1:
        return 1.0 / slope
    if order == 2:
        return -bend / slope / slope / slope
    return (3.0 * bend * bend / slope - third) / slope / slope / slope / slope
