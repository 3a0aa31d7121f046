"""Marks at events: hairlines with labels above them, and shaded spans in which a port sticks."""

from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from codegen.pictures.flags import Flag, raise_flags
from codegen.pictures.style import FAINT, SHADE, curve
from codegen.runs.track import Event

MOST = 40
"""With more marks than that only those are drawn that stand apart."""

APART = 1 / 60
"""How far, as a part of what is shown."""


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


def draw(axes: Sequence[Any], marks: Marks, begin: float, end: float
) -> tuple[str, float]:  # fmt: skip
    """Draw marks across axes below one another, with labels above the first; what is to be said of them.

    Second comes how high the labels are [pt].
    """
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
    height = raise_flags(axes[0], [_flag(marks, at, begin, end) for at in kept])
    said = ["grey: sticking"] if marks.spans else []
    if len(kept) < len(inside):
        said.append(f"{len(kept)} of {len(inside)} events marked")
    return "; ".join(said), height


def _flag(marks: Marks, at: int, begin: float, end: float) -> Flag:
    event = marks.events[at]
    part = (event.time - begin) / (end - begin) if end > begin else 0.0
    color = marks.look(at)["color"] if marks.owners else None
    return Flag(event.time, part, f"{event.port}: {event.kind}", color)
