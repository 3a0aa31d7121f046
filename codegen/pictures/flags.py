"""Flags above an axis: short texts on poles, in rows so that none is over another."""

from collections.abc import Sequence
from typing import Any, NamedTuple

from codegen.pictures.labels import plain
from codegen.pictures.style import FAINT, QUIET, SMALL

ROWS = 4
"""Flags that fit in none are left out."""

ROW = 1.3 * SMALL
"""How far rows are apart [pt]."""

WIDE, LETTER = 0.8, 0.6
"""An axis as a part of its figure, and a letter as a part of its height: about."""


class Flag(NamedTuple):
    """A text at a place along an axis, and that place as a part of the axis; None for the usual greys."""

    place: float
    part: float
    text: str
    color: object = None


def raise_flags(axis: Any, flags: Sequence[Flag]) -> float:
    """Draw flags above an axis, from left to right, each to the right of its pole; how high they are [pt]."""
    points = axis.figure.get_figwidth() * 72 * WIDE
    spans = [(f.part * points, f.part * points + LETTER * SMALL * len(f.text)) for f in flags]
    highest = 0.0
    for flag, row in zip(flags, rows(spans), strict=True):
        if row is None:
            continue
        highest = max(highest, 3 + ROW * (row + 1))
        axis.annotate(
            plain(flag.text), (flag.place, 1.0), xycoords=axis.get_xaxis_transform(),
            xytext=(0, 3 + ROW * row), textcoords="offset points", ha="left", va="bottom",
            fontsize=SMALL, color=flag.color or QUIET, annotation_clip=False, gid="flag",
            arrowprops={
                "arrowstyle": "-", "linewidth": 0.6, "color": flag.color or FAINT,
                "shrinkA": 0, "shrinkB": 0, "relpos": (0, 0),
            },
        )  # fmt: skip
    return highest


def rows(spans: Sequence[tuple[float, float]]) -> list[int | None]:
    """A row for each span from left to right, so that neither texts nor poles cross a text.

    >>> rows([(0, 5), (3, 8), (9, 12)])
    [1, 0, 0]
    """
    found: list[int | None] = []
    starts = [float("inf")] * ROWS
    for start, stop in reversed(spans):
        # Poles of flags further right pass through the rows below theirs.
        row = next((row for row in range(ROWS) if stop <= min(starts[row:])), None)
        found.append(row)
        if row is not None:
            starts[row] = start
    return found[::-1]
