"""Marks at events: hairlines with labels above them, and shaded spans in which a port sticks."""

from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from codegen.pictures.labels import plain
from codegen.pictures.style import FAINT, QUIET, SHADE, SMALL, curve
from codegen.runs.events import Event

MOST = 40
"""With more marks than that only those are drawn that stand apart."""

APART = 1 / 60
"""How far, as a part of what is shown."""

ROWS = 4
"""Of labels; those that fit in none are left out."""

WIDE, LETTER = 0.8, 0.6
"""An axis as a part of its figure, and a letter as a part of its height: about."""


@dataclass(frozen=True)
class Marks:
    """What is marked along the time: events, and spans in which something sticks.

    ``owners``: where there are several runs, the number of each event's run, whose colour and line it has.
    """

    events: tuple[Event, ...] = ()
    spans: tuple[tuple[float, float], ...] = ()
    owners: tuple[int, ...] = ()

    def look(self, at: int) -> dict[str, object]:
        """Colour and line of an event's mark."""
        return curve(self.owners[at]) if self.owners else {"color": FAINT, "linestyle": "-"}


def stuck_spans(events: Iterable[Event], end: float) -> list[tuple[float, float]]:
    """Begin and end of every stretch in which a friction port sticks after its first event."""
    begun: dict[Hashable, float] = {}
    spans: list[tuple[float, float]] = []
    for event in events:
        if event.kind == "stick":
            begun[event.port] = event.time
        elif event.port in begun:
            spans.append((begun.pop(event.port), event.time))
    return spans + [(begin, end) for begin in begun.values()]


def apart(times: Sequence[float], span: float) -> list[int]:
    """Which of sorted times are marked: all if they are few, else those that stand apart."""
    if len(times) <= MOST:
        return list(range(len(times)))
    kept: list[int] = []
    for at, time in enumerate(times):
        if not kept or time - times[kept[-1]] >= APART * span:
            kept.append(at)
    return kept


def draw(axes: Sequence[Any], marks: Marks, begin: float, end: float) -> str:
    """Draw marks across axes below one another, with labels above the first; what is to be said of them."""
    for first, last in marks.spans:
        for axis in axes:
            axis.axvspan(first, last, color=SHADE, linewidth=0, zorder=0)
    inside = [at for at, event in enumerate(marks.events) if begin <= event.time <= end]
    inside.sort(key=lambda at: marks.events[at].time)
    kept = [inside[k] for k in apart([marks.events[at].time for at in inside], end - begin)]
    for at in kept:
        for axis in axes:
            axis.axvline(
                marks.events[at].time, linewidth=0.6, zorder=1, gid="event", **marks.look(at)
            )
    _label(axes[0], marks, kept, begin, end)
    said = ["grey: sticking"] if marks.spans else []
    if len(kept) < len(inside):
        said.append(f"{len(kept)} of {len(inside)} events marked")
    return "; ".join(said)


def _label(axis: Any, marks: Marks, kept: Sequence[int], begin: float, end: float) -> None:
    """Labels over an axis, in rows, so that none is over another or over another's line."""
    points = axis.figure.get_figwidth() * 72 * WIDE
    starts = [float("inf")] * ROWS
    for at in reversed(kept):
        event, color = marks.events[at], marks.look(at)["color"]
        text = f"{event.port}: {event.kind}"
        place = (event.time - begin) / (end - begin) * points
        stop = place + LETTER * SMALL * len(text)
        # Lines of later events pass through the rows below theirs.
        row = next((row for row in range(ROWS) if stop <= min(starts[row:])), None)
        if row is None:
            continue
        starts[row] = place
        axis.annotate(
            plain(text), (event.time, 1.0), xycoords=axis.get_xaxis_transform(),
            xytext=(0, 3 + 1.3 * SMALL * row), textcoords="offset points", ha="left", va="bottom",
            fontsize=SMALL, color=color if marks.owners else QUIET, annotation_clip=False, gid="event",
            arrowprops={
                "arrowstyle": "-", "linewidth": 0.6, "color": color, "shrinkA": 0, "shrinkB": 0,
                "relpos": (0, 0),
            },
        )  # fmt: skip
