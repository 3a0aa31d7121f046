"""One run by each backend: C by exact steps or with events located, and numpy."""

from collections.abc import Sequence
from dataclasses import dataclass

from codegen.engine.fallback import Stopped
from codegen.engine.located import METHODS as LOCATED_METHODS
from codegen.engine.located import LocatedRuns, Recorded
from codegen.engine.runs import CRuns, not_affine
from codegen.engine.status import Status
from codegen.inputs.signal import Signal
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.program.records import stepped_in_python
from codegen.record.snapshots import snapshots
from codegen.runs.completion import Beginning
from codegen.runs.hybrid import run_hybrid
from codegen.runs.methods import EXACT
from codegen.runs.track import Settings, Track


@dataclass(frozen=True)
class Request:
    """A run ready to begin. ``states``: at its start, completed; ``events``: whether they are kept.

    ``corners``: whether those of laws are events.
    """

    times: Array
    states: Array
    begun: Beginning
    signals: Sequence[Signal]
    settings: Settings
    events: bool
    corners: bool = False


def in_numpy(model: ClosedModel, asked: Request) -> Recorded:
    """The run in numpy; `SimulationError` where it cannot go on."""
    run = run_hybrid(
        model, asked.times, asked.begun.s, asked.signals, asked.settings, first=asked.begun.mode,
        keeping=asked.events, corners=asked.corners,
    )  # fmt: skip
    return _recorded(model, asked, run.track, "numpy")


def in_c(
    model: ClosedModel, asked: Request, engine: CRuns | None, located: LocatedRuns
) -> Recorded | Stopped:
    """The run in C, or why it cannot go on there."""
    method, first = asked.settings.method, asked.begun.mode
    stopped = Stopped(_unknown(model, method), limit=method != EXACT)
    if model.program.steps:
        return Stopped(f"{stepped_in_python(model.program)}, which C cannot call", limit=True)
    if engine is not None and method in ("auto", EXACT):
        found = engine.run(
            asked.times, asked.begun.s, asked.signals, first, asked.events, patient=method == EXACT
        )
        if found.track is not None:
            return _recorded(model, asked, found.track, "c")
        stopped = found.stopped
        if found.status == Status.ENDLESS:
            # Step control would have no end either; the loop in Python tells why.
            return stopped
    if method not in LOCATED_METHODS:
        return stopped
    return located.run(
        asked.times, asked.states, asked.signals, asked.settings, first, asked.events, asked.corners
    )


def _unknown(model: ClosedModel, method: str) -> str:
    """Why C does not go by a method; exact steps of an affine model may have ended for other reasons."""
    reason = not_affine(model.program) if method == EXACT else None
    return f"C has no method {method!r}{f': {reason}' if reason else ''}"


def _recorded(model: ClosedModel, asked: Request, track: Track, backend: str) -> Recorded:
    shots = snapshots(model.within(track), asked.times, asked.signals, track)
    events = tuple(track.events) if track.keeping else ()
    return Recorded(events, shots, backend, tuple(track.modes))
