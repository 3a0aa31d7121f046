"""Corners of tables along an axis, many told by few: the stretches between them are numbered in Gray's code.

Stretches side by side differ in one bit of it. So to each bit belongs a function of the argument that
changes its sign where that bit does: a table of a thousand corners has ten such functions.
"""

from bisect import bisect_right

from bondgraph.tables.looking import FREE, Patches


def edges(table: Patches, axis: int) -> tuple[float, ...]:
    """Where one polynomial takes over from another along an axis, and ends that do not go on.

    There slopes jump, or those of slopes: to an integrator of high order all of them are corners.
    """
    breaks, _, outside, _ = table
    return breaks[axis][1:-1] if outside == "extend" else breaks[axis]


def bits(count: int) -> int:
    """How many bits number the stretches between so many corners."""
    return count.bit_length()


def edge(table: Patches, axis: int, bit: int, x: float, region: float = FREE) -> float:
    """The distance to the nearest corner at which a bit changes, with a sign that changes there.

    ``region``: the stretch whose two corners are looked at, beyond them, too; a bit that changes at neither
    is a constant.
    """
    places = edges(table, axis)
    count, step = len(places), 1 << bit
    at = bisect_right(places, x) if region == FREE else min(max(int(region), 0), count)
    sign = -1.0 if (at ^ (at >> 1)) & step else 1.0
    if region != FREE:
        if at > 0 and at & -at == step:
            return sign * (x - places[at - 1])
        if at < count and (at + 1) & -(at + 1) == step:
            return sign * (places[at] - x)
        return sign * (table[0][axis][-1] - table[0][axis][0]) + 0.0 * x
    whole = at // step
    low = whole if whole % 2 else whole - 1
    found = []
    if low > 0:
        found.append(x - places[low * step - 1])
    if (low + 2) * step <= count:
        found.append(places[(low + 2) * step - 1] - x)
    return sign * min(found)
