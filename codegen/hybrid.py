"""The event-driven loop: smooth legs between breakpoints, sticking, release and zero crossings."""

from collections.abc import Sequence

import numpy as np

from bondgraph import SimulationError
from codegen.arrays import Array
from codegen.closed import ClosedModel, Mode
from codegen.events import Event
from codegen.legs import Leg, Settings, Track
from codegen.modes import LOOK_AHEAD, decide, scales
from codegen.pieces import Piece
from codegen.signals import Signal

STALLED = 60
"""So many events within a billionth of the run are a run that goes nowhere."""


def run_hybrid(
    model: ClosedModel,
    times: Array,
    start: Array,
    signals: Sequence[Signal],
    settings: Settings,
) -> Track:
    """Integrate from the first to the last of ``times`` [s], recording the vector at each of them.

    At a breakpoint or an event a sample shows the instant just after.
    """
    t, end, s = float(times[0]), float(times[-1]), start
    track = Track(np.zeros((len(times), model.size)), [])
    breaks = sorted({b for signal in signals for b in signal.breakpoints if t < b < end})
    mode: Mode = tuple(1 for _ in model.friction_inputs)
    touched = frozenset[int]()
    started, span = False, end - t
    while t < end:
        pieces = [signal.piece(t) for signal in signals]
        fastest = Leg(model, pieces, mode, settings, end - t).fastest(t, s)
        ahead = LOOK_AHEAD / max(fastest, 100.0 / (end - t))
        # A breakpoint may set the slips anew, so sticking ports are decided again with the others.
        loose = touched | {i for i, sign in enumerate(mode) if sign == 0}
        at_zero = _still(model, t, s, pieces, mode, loose)
        new = decide(model, t, s, pieces, mode, at_zero, ahead)
        if started:
            _note(model, track.events, t, mode, new)
            _check_progress(track.events, span)
        mode, started = new, True
        s = _at_rest(model, t, s, pieces, mode)
        stop = next((b for b in breaks if b > t), end)
        t, s, touched = Leg(model, pieces, mode, settings, span).run(t, s, stop, times, track)
    track.record(s, mode)
    return track


def _still(
    model: ClosedModel,
    t: float,
    s: Array,
    pieces: Sequence[Piece],
    mode: Mode,
    ports: frozenset[int],
) -> frozenset[int]:
    """Those of the ports that are at rest, or close enough for it to be the event's own rounding."""
    if not ports:
        return frozenset()
    now = model.at(t, s, pieces, tuple(sign or 1 for sign in mode))
    slips = np.abs(now.y[model.friction_readings])
    limits = 1e3 * scales(model, now).slip
    return frozenset(i for i in ports if slips[i] <= limits[i] or model.coupled_directly(i))


def _at_rest(model: ClosedModel, t: float, s: Array, pieces: Sequence[Piece], mode: Mode) -> Array:
    """Remove what slip is left at sticking ports, along ``A^-1 F^T``: no energy but the slip's own."""
    if all(mode):
        return s
    held, now = model.hold(mode), model.at(t, s, pieces, mode)
    n = len(model.program.states)
    s = s.copy()
    s[:n] += held.take_away @ (held.slip_x @ now.x + held.slip_u @ now.u)
    return s


def _note(model: ClosedModel, events: list[Event], t: float, old: Mode, new: Mode) -> None:
    for port, before, after in zip(model.program.friction, old, new, strict=True):
        if before != after:
            kind = "stick" if after == 0 else ("slip" if before == 0 else "cross")
            events.append(Event(t, port.name, kind))


def _check_progress(events: list[Event], span: float) -> None:
    """Refuse to go on when too many of the latest events fall together."""
    if len(events) >= STALLED and events[-1].time - events[-STALLED].time < 1e-9 * span:
        latest = ", ".join(f"{e.kind} {e.port!r} at {e.time:.12g}" for e in events[-4:])
        raise SimulationError(
            f"{STALLED} events within {1e-9 * span:.3g} s: the run makes no progress ({latest})"
        )
