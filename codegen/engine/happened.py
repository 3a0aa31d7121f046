"""What C says has happened, as events."""

from collections.abc import Hashable, Sequence
from itertools import repeat
from typing import Any

import numpy as np

from codegen.runs.track import KINDS, Event

EVENT = np.dtype(
    [("time", np.float64), ("port", np.intc), ("kind", np.intc), ("impulse", np.float64)],
    align=True,
)
"""``bg_event``."""


def told_events(ffi: Any, events: Any, count: int, names: Sequence[Hashable]) -> list[Event]:
    """The first so many of an array of ``bg_event``, ports by these names."""
    if not count:
        return []
    told = np.frombuffer(ffi.buffer(events, count * ffi.sizeof("bg_event")), EVENT)
    ports = map(names.__getitem__, told["port"].tolist())
    kinds = map(KINDS.__getitem__, told["kind"].tolist())
    # A tuple's own constructor takes half the time of the record's, and there may be many.
    rows = zip(told["time"].tolist(), ports, kinds, told["impulse"].tolist(), strict=True)
    return list(map(tuple.__new__, repeat(Event), rows))
