"""A run in a few lines of text."""

from collections.abc import Mapping, Sequence

from bondgraph.show.blocks import aligned
from bondgraph.show.display import counted
from codegen.numbers.arrays import Array
from codegen.runs.track import Event

MOST = 20
"""Signals or events; more are counted."""


def summary(
    time: Array, signals: Mapping[str, Array], units: Mapping[str, str], events: Sequence[Event]
) -> str:
    """How long, how many samples, where signals begin, end and turn, and what happened."""
    lines = [head_line(time, events)]
    if signals:
        lines += aligned(state_rows(signals, units)) + _rest(len(signals), "states")
    return "\n".join(lines + [f"  {line}" for line in event_lines(events)])


def head_line(time: Array, events: Sequence[Event]) -> str:
    """Samples, times [s] and how many events."""
    samples, happened = counted(len(time), "sample"), counted(len(events), "event")
    return f"{samples} from {time[0]:g} to {time[-1]:g} s, {happened}"


def state_rows(signals: Mapping[str, Array], units: Mapping[str, str]) -> list[tuple[str, ...]]:
    """A head, and of each of the first signals where it begins, ends and turns."""
    rows: list[tuple[str, ...]] = [("", "first", "last", "least", "most")]
    for name, values in list(signals.items())[:MOST]:
        told = f"{name} [{units[name]}]" if name in units else name
        shown = (values[0], values[-1], values.min(), values.max())
        rows.append((told, *(f"{value:.5g}" for value in shown)))
    return rows


def event_lines(events: Sequence[Event]) -> list[str]:
    """When, where and what, of the first events; the others are counted."""
    lines = [f"{event.time:.6g} s  {event.port}: {event.kind}" for event in events[:MOST]]
    return lines + [line.strip() for line in _rest(len(events), "events")]


def _rest(count: int, what: str) -> list[str]:
    return [f"  and {count - MOST} more {what}"] if count > MOST else []
