"""Runs of one of the two engines in C and nothing else, kept whole."""

from collections.abc import Sequence

import numpy as np

from codegen.engine.fallback import Stopped
from codegen.engine.located import LocatedRuns
from codegen.engine.runs import CRuns, Outcome
from codegen.inputs.signal import Signal
from codegen.runs.completion import Beginning
from codegen.runs.track import Event, Settings
from codegen.taking.asked import Request
from codegen.taking.blocks import Whole
from codegen.taking.exact import run_exact
from codegen.taking.located import run_located


class Events:
    """A taker of events."""

    def __init__(self) -> None:
        self.events: list[Event] = []

    def begin(self) -> None:
        """None has been taken."""
        self.events = []

    def take(self, vectors, modes, largest) -> None:
        """Samples are not kept."""

    def happened(self, events: Sequence[Event]) -> None:
        """The next."""
        self.events += events


def exact(
    runs: CRuns, times: np.ndarray, start: np.ndarray, signals: Sequence[Signal]
) -> tuple[Outcome, list[Event]]:
    """How an exact run ended, and its events."""
    kept = Events()
    return run_exact(runs, kept, times, start, signals, (), True, True), kept.events


def located(
    runs: LocatedRuns, times: np.ndarray, states: np.ndarray, signals: Sequence[Signal],
    settings: Settings,
) -> Whole | Stopped:  # fmt: skip
    """All of a run with located events, or why there is none."""
    whole, nothing = Whole(len(times)), Beginning(states, (), {}, states)
    asked = Request(times, states, nothing, signals, settings, True)
    return run_located(runs, whole, asked) or whole
