"""How far two runs are apart: signals over their range, events in time."""

from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from codegen.runs.track import Event
from oracles.methods import Outcome


@dataclass(frozen=True)
class Apart:
    """``signals``: the largest difference over the signal's range, and which signal's it is.

    A signal that does not move is measured in its unit. ``events`` [s]: the largest difference in time;
    infinite unless each port has the same events in the same order.
    """

    signals: float
    worst: str
    events: float


def apart(found: Outcome, expected: Outcome, names: Iterable[str] | None = None) -> Apart:
    """``names``: the signals to compare, all that both have if none are given."""
    chosen = [*(expected.columns if names is None else names)]
    errors = {
        name: _error(found.columns[name], expected.columns[name])
        for name in chosen
        if name in found.columns
    }
    worst = max(errors, key=errors.__getitem__)
    return Apart(errors[worst], worst, _events_apart(found.events, expected.events))


def _error(found: np.ndarray, expected: np.ndarray) -> float:
    measure = float(np.ptp(expected)) or 1.0
    difference = float(np.abs(found - expected).max()) / measure
    return difference if np.isfinite(difference) else np.inf


def _events_apart(found: Sequence[Event], expected: Sequence[Event]) -> float:
    ours, theirs = _by_port(found), _by_port(expected)
    if [(event.port, event.kind) for event in ours] != [(e.port, e.kind) for e in theirs]:
        return np.inf
    return max((abs(a.time - b.time) for a, b in zip(ours, theirs, strict=True)), default=0.0)


def _by_port(events: Sequence[Event]) -> list[Event]:
    ports: list[Hashable] = sorted({event.port for event in events}, key=str)
    return [event for port in ports for event in events if event.port == port]


def order(steps: Sequence[float], errors: Sequence[float]) -> float:
    """The exponent with which errors fall as steps do, by least squares."""
    return float(np.polyfit(np.log(steps), np.log(errors), 1)[0])
