"""The integral of a table, which energies are told by."""

from bondgraph.tables.looking import Patches


def integrated(table: Patches, low: float, high: float) -> Patches:
    """The integral over one axis, from its first point on; beyond held ends it is straight.

    ``low``, ``high``: the values at the ends.
    """
    (knots,), degree, outside, factors = table
    size, cells = degree + 1, [list[float]() for _ in knots[1:]]
    total = 0.0
    for at, cell in enumerate(cells):
        width = knots[at + 1] - knots[at]
        powers = factors[at * size : (at + 1) * size]
        cell += [factor / (size - k) for k, factor in enumerate(powers)] + [total]
        total = sum(factor * width ** (size - k) for k, factor in enumerate(cell))
    if outside == "hold":
        flat, span = [0.0] * degree, knots[-1] - knots[0]
        knots = (knots[0] - span, *knots, knots[-1] + span)
        cells = [[*flat, low, -low * span], *cells, [*flat, high, total]]
    beyond = "refuse" if outside == "refuse" else "extend"
    return (knots,), size, beyond, tuple(factor for cell in cells for factor in cell)
