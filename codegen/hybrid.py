"""The event-driven loop: smooth legs between breakpoints, sticking, release and zero crossings."""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bondgraph import SimulationError
from codegen.arrays import Array
from codegen.closed import ClosedModel, Mode
from codegen.events import Event
from codegen.exact import ExactLeg
from codegen.guards import fallen_guards
from codegen.legs import EXACT, Leg, Settings, Track
from codegen.modes import LOOK_AHEAD, Peaks, decide, scales
from codegen.pieces import Piece
from codegen.signals import Signal

STALLED = 60
"""So many events in a row are a run that goes nowhere, if they are hardly apart."""

APART = 1e-9
"""Hardly apart: closer than this fraction of the run, or than what decides ties."""


@dataclass(frozen=True)
class Stretch:
    """How far a run came: the end of its time, or the first instant at which guards fell.

    ``ahead`` [s]: a time too short to matter, in which ties are decided.
    """

    track: Track
    t: float
    s: Array
    mode: Mode
    fallen: frozenset[int]
    ahead: float


def run_hybrid(
    model: ClosedModel,
    times: Array,
    start: Array,
    signals: Sequence[Signal],
    settings: Settings,
    begin: float,
    span: float,
) -> Stretch:
    """Integrate from ``begin`` to the last of ``times`` [s], recording the vector at each of them.

    At a breakpoint or an event a sample shows the instant just after. ``span`` [s]: the length of the
    whole run, of which this may be the rest. Ends where a guard falls below zero.
    """
    t, end, s = begin, float(times[-1]), start
    track = Track(np.zeros((len(times), model.size)), [], np.abs(start))
    breaks = sorted({b for signal in signals for b in signal.breakpoints if t < b <= end})
    mode: Mode = tuple(1 for _ in model.friction_inputs)
    touched, started, peaks = frozenset[int](), False, Peaks.none(model)
    rounds: deque[float] = deque(maxlen=STALLED)
    while not started or t < end or touched or t in breaks:
        pieces = [signal.piece(t) for signal in signals]
        peaks.see(model, t, s, pieces, mode)
        leg = Leg(model, pieces, mode, settings, span, peaks)
        watched = bool(mode) or bool(model.program.guards.results)
        peaks.time = 1 / max(leg.fastest(t, s), 100.0 / span) if watched else 0.0
        ahead = LOOK_AHEAD * peaks.time
        # A breakpoint may set the slips anew, so sticking ports are decided again with the others.
        loose = touched | {i for i, sign in enumerate(mode) if sign == 0}
        at_zero = _still(model, t, s, pieces, mode, loose, peaks)
        new = decide(model, t, s, pieces, mode, at_zero, ahead, peaks, touched)
        if started:
            _note(model, track.events, t, mode, new)
            if touched:
                _check_progress(rounds, t, max(APART * span, 2 * STALLED * ahead), track.events)
        mode = new
        s = _at_rest(model, t, s, pieces, mode)
        fallen = fallen_guards(model, t, s, pieces, mode, peaks) if started else frozenset()
        if fallen:
            return Stretch(track, t, s, mode, fallen, ahead)
        started = True
        if t >= end:
            break
        stop = next((b for b in breaks if b > t), end)
        exact = _exact(model, pieces, mode, settings, t, s, stop, peaks)
        if exact is not None:
            t, s, ended = exact.run(stop, times, track)
        else:
            leg = Leg(model, pieces, mode, settings, span, peaks)
            t, s, ended = leg.run(t, s, stop, times, track)
        fallen = frozenset(i - len(mode) for i in ended if i >= len(mode))
        if fallen:
            return Stretch(track, t, s, mode, fallen, ahead)
        touched = ended
    track.record(s, mode)
    return Stretch(track, t, s, mode, frozenset(), ahead)


def _exact(
    model: ClosedModel, pieces: Sequence[Piece], mode: Mode, settings: Settings, t: float, s: Array,
    stop: float, peaks: Peaks,
) -> ExactLeg | None:  # fmt: skip
    """The stretch ahead as an exact one, where the mode is affine and exact steps are asked for."""
    if settings.method not in ("auto", EXACT) or model.program.guards.results:
        return None
    affine = model.affine_map(mode, len(pieces))
    leg = None if affine is None else ExactLeg(model, affine, pieces, mode, t, s, peaks)
    if leg is not None and leg.steppable(stop):
        return leg
    if settings.method == EXACT:
        raise SimulationError(
            f"at t = {t:.9g} the model is not affine, or too stiff for exact steps; let method be auto"
        )
    return None


def _still(
    model: ClosedModel,
    t: float,
    s: Array,
    pieces: Sequence[Piece],
    mode: Mode,
    ports: frozenset[int],
    peaks: Peaks,
) -> frozenset[int]:
    """Those of the ports that are at rest, or close enough for it to be the event's own rounding."""
    if not ports:
        return frozenset()
    now = model.at(t, s, pieces, tuple(sign or 1 for sign in mode))
    slips = np.abs(now.y[model.friction_readings])
    limits = 1e3 * scales(model, now, t, peaks).slip
    return frozenset(i for i in ports if slips[i] <= limits[i] or model.coupled_directly(i))


def _at_rest(model: ClosedModel, t: float, s: Array, pieces: Sequence[Piece], mode: Mode) -> Array:
    """Remove what slip is left at sticking ports, along ``A^-1 F^T``: no energy but the slip's own."""
    if all(mode):
        return s
    now = model.at(t, s, pieces, mode)
    held = model.hold(mode, now.numbers)
    n = len(model.program.states)
    s = s.copy()
    s[:n] += held.take_away @ (held.slip_x @ now.x + held.slip_u @ now.u)
    return s


def _note(model: ClosedModel, events: list[Event], t: float, old: Mode, new: Mode) -> None:
    for port, before, after in zip(model.program.friction, old, new, strict=True):
        if before != after:
            kind = "stick" if after == 0 else ("slip" if before == 0 else "cross")
            events.append(Event(t, port.name, kind))


def _check_progress(rounds: deque[float], t: float, least: float, events: list[Event]) -> None:
    """Refuse to go on when too many of the latest legs end in an event within ``least`` [s]."""
    rounds.append(t)
    if len(rounds) == STALLED and t - rounds[0] < least:
        latest = ", ".join(f"{e.kind} {e.port!r} at {e.time:.12g}" for e in events[-4:])
        raise SimulationError(
            f"{STALLED} events within {least:.3g} s of t = {t:.12g}: the run makes no progress "
            f"(latest: {latest or 'none that changed a mode'})"
        )
