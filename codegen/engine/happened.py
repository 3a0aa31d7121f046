"""What C says has happened, as events."""

import gc
from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import repeat
from typing import Any

import numpy as np

from codegen.runs.track import KINDS, Event

EVENT = np.dtype(
    [("time", np.float64), ("port", np.intc), ("kind", np.intc), ("impulse", np.float64)],
    align=True,
)
"""``bg_event``."""


def told_events(
    ffi: Any, events: Any, count: int, names: Sequence[Hashable], taken: Mapping[int, str]
) -> list[Event]:
    """The first so many of an array of ``bg_event``, ports by these names; ``taken``: transitions by port."""
    if not count:
        return []
    told = np.frombuffer(ffi.buffer(events, count * ffi.sizeof("bg_event")), EVENT)
    ports = map(names.__getitem__, told["port"].tolist())
    kinds: Iterable[str] = map(KINDS.__getitem__, told["kind"].tolist())
    if taken:
        kinds = (taken.get(at, kind) for at, kind in zip(told["port"].tolist(), kinds, strict=True))
    # A tuple's own constructor takes half the time of the record's, and there may be many.
    rows = zip(told["time"].tolist(), ports, kinds, told["impulse"].tolist(), strict=True)
    with uncollected():
        return list(map(tuple.__new__, repeat(Event), rows))


@contextmanager
def uncollected() -> Iterator[None]:
    """Nothing is looked for inside that could be thrown away.

    Of a million tuples of numbers none is: to look through all that lives each time some thousands more do
    takes three times as long as to make them.
    """
    before = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if before:
            gc.enable()
