"""A run in a few lines of text."""

from collections.abc import Mapping, Sequence

from bondgraph.show.blocks import aligned
from codegen.numbers.arrays import Array
from codegen.runs.track import Event

MOST = 20
"""Signals or events; more are counted."""


def summary(
    time: Array, signals: Mapping[str, Array], units: Mapping[str, str], events: Sequence[Event]
) -> str:
    """How long, how many samples, where signals begin, end and turn, and what happened."""
    lines = [
        f"{len(time)} samples from {time[0]:g} to {time[-1]:g} s, {len(events)} event"
        + ("s" if len(events) != 1 else "")
    ]
    if signals:
        rows: list[tuple[str, ...]] = [("", "first", "last", "least", "most")]
        for name, values in list(signals.items())[:MOST]:
            told = f"{name} [{units[name]}]" if name in units else name
            shown = (values[0], values[-1], values.min(), values.max())
            rows.append((told, *(f"{value:.5g}" for value in shown)))
        lines += aligned(rows) + _rest(len(signals), "states")
    lines += [f"  {event.time:.6g} s  {event.port}: {event.kind}" for event in events[:MOST]]
    return "\n".join(lines + _rest(len(events), "events"))


def _rest(count: int, what: str) -> list[str]:
    return [f"  and {count - MOST} more {what}"] if count > MOST else []
