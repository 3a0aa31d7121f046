"""`Sampled`: the points of a table, checked and frozen."""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

from bondgraph.errors import TableError, nearest
from bondgraph.tables.looking import BACK

METHODS = ("linear", "pchip", "akima", "bilinear", "bicubic")
"""Between points: the first three over one axis, the last two over two."""

OUTSIDE = ("hold", "extend", "refuse")
"""Beyond the ends: the value there, the polynomial there, no number."""

FEWEST = {"linear": 2, "pchip": 2, "akima": 3, "bilinear": 2, "bicubic": 4}
"""Points that a method needs along each axis."""

MOST = 100_000
"""Values in one table; generated code carries each."""


@dataclass(frozen=True)
class Sampled:
    """Values over one axis or two: ``axes[0]`` is x, ``axes[1]`` is y; ``values`` row by row of x.

    Two tables are equal where all of this is. Only `checked` vouches for what it holds.
    """

    name: str
    axes: tuple[tuple[float, ...], ...]
    values: tuple[float, ...]
    method: str
    outside: str

    @cached_property
    def digest(self) -> str:
        """Tells the table from others, whatever they are called."""
        parts = (self.name, self.axes, self.values, self.method, self.outside)
        return hashlib.sha256(repr(parts).encode()).hexdigest()[:16]

    @property
    def turned(self) -> bool:
        """Whether it is one of cubics that is turned round."""
        return self.method.endswith(BACK)

    @property
    def smooth(self) -> bool:
        """Whether its slope has no jumps between its ends."""
        return self.method not in ("linear", "bilinear")


def check_choices(name: str, count: int, method: object, outside: object) -> str:
    """The method for a table over so many axes, by its own name; refused where there is none."""
    if outside not in OUTSIDE:
        raise TableError(
            f"table {name!r}: outside={outside!r}{nearest(str(outside), OUTSIDE)}; "
            f"there are {', '.join(OUTSIDE)}"
        )
    fitting = METHODS[:3] if count == 1 else METHODS[3:]
    if count == 2 and method == "linear":
        return "bilinear"
    if method not in fitting:
        raise TableError(
            f"table {name!r}: method={method!r}{nearest(str(method), fitting)}; over "
            f"{'one axis' if count == 1 else 'two axes'} there are {', '.join(fitting)}"
        )
    return str(method)


def check_axis(name: str, letter: str, axis: Sequence[float], method: str) -> None:
    """Refuse an axis that does not increase, or has too few points."""
    fewest = FEWEST[method]
    if len(axis) < fewest:
        raise TableError(
            f"table {name!r}: {letter} has {len(axis)} point(s); {method} needs {fewest} at least"
        )
    for row, (before, after) in enumerate(pairwise(axis), 1):
        if not after > before:
            raise TableError(
                f"table {name!r}: {letter} must increase, but row {row + 1} has {after!r} after "
                f"{before!r}; sort the rows, and keep one of each"
            )
