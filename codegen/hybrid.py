"""The event-driven loop: smooth legs between breakpoints, sticking, release and zero crossings."""

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.integrate import DOP853, Radau
from scipy.optimize import brentq, minimize_scalar

from bondgraph import SimulationError
from codegen.arrays import Array
from codegen.closed import ClosedModel, Mode, Snapshot
from codegen.modes import LOOK_AHEAD, Scales, decide, scales
from codegen.signals import Piece, Signal

METHODS = {"DOP853": DOP853, "Radau": Radau}

STIFF = 2e5
"""Time span over shortest time constant from which the implicit method is chosen."""

STEP_BOUND = 1.0
"""An explicit step's length in shortest time constants: beyond, its interpolant is unreliable."""

CHECKS = 6
"""Points inside each step at which events are looked for."""

SMALLEST_SPAN = 200
"""Steps are never longer than the span of the run divided by this."""

STALLED = 60
"""Events within a millionth of the shortest time scale that count as a run that goes nowhere."""


@dataclass(frozen=True)
class Event:
    """What happened at a friction port: "stick", "slip" (it was released) or "cross" (through zero)."""

    time: float
    port: Hashable
    kind: str


@dataclass
class Track:
    """What a run has recorded: the integrated vector and the mode at each sample, and the events."""

    vectors: Array
    modes: list[Mode]
    events: list[Event] = field(default_factory=list)
    recorded: int = 0

    def record(self, vector: Array, mode: Mode) -> None:
        """The next sample."""
        self.vectors[self.recorded] = vector
        self.modes.append(mode)
        self.recorded += 1


@dataclass(frozen=True)
class Settings:
    """How to integrate: method, relative and absolute tolerance."""

    method: str
    rtol: float
    atol: float


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
    first, guard = True, _Guard(end - t)
    while t < end:
        pieces = [signal.piece(t) for signal in signals]
        # A breakpoint may set the slips anew, so sticking ports are decided again with the others.
        loose = touched | {i for i, sign in enumerate(mode) if sign == 0 and not first}
        lam = _fastest(model, t, s, pieces, mode)
        ahead = LOOK_AHEAD / max(lam, 100.0 / (end - t))
        new = decide(
            model, t, s, pieces, mode, frozenset(_still(model, t, s, pieces, mode, loose)), ahead
        )
        if not first:
            _note(model, track.events, t, mode, new, guard)
        mode, first = new, False
        s = _at_rest(model, t, s, pieces, mode)
        stop = next((b for b in breaks if b > t), end)
        leg = _Leg(model, t, s, stop, pieces, mode, settings, lam, end - float(times[0]))
        t, s, touched = leg.run(times, track)
    pieces = [signal.piece(t) for signal in signals]
    track.record(s, mode)
    return track


def _still(
    model: ClosedModel,
    t: float,
    s: Array,
    pieces: Sequence[Piece],
    mode: Mode,
    ports: frozenset[int],
) -> set[int]:
    """Those of the ports that are at rest, or close enough for it to be the event's own rounding."""
    if not ports:
        return set()
    now = model.at(t, s, pieces, tuple(sign or 1 for sign in mode))
    slips = np.abs(now.y[model.friction_readings])
    limits = 1e3 * scales(model, now).slip
    return {i for i in ports if slips[i] <= limits[i] or model.coupled_directly(i)}


def _at_rest(model: ClosedModel, t: float, s: Array, pieces: Sequence[Piece], mode: Mode) -> Array:
    """Remove what slip is left at sticking ports, along ``A^-1 F^T``: no energy but the slip's own."""
    if all(mode):
        return s
    held, now = model.hold(mode), model.at(t, s, pieces, mode)
    n = len(model.program.states)
    s = s.copy()
    s[:n] += held.take_away @ (held.slip_x @ now.x + held.slip_u @ now.u)
    return s


def _fastest(model: ClosedModel, t: float, s: Array, pieces: Sequence[Piece], mode: Mode) -> float:
    """The largest rate [1/s] of the mode's linearisation and of the inputs."""
    base = model.at(t, s, pieces, mode).rate
    jacobian = np.empty((len(s), len(s)))
    for j in range(len(s)):
        step = 1e-6 * max(1.0, abs(s[j]))
        moved = s.copy()
        moved[j] += step
        jacobian[:, j] = (model.at(t, moved, pieces, mode).rate - base) / step
    if not np.isfinite(jacobian).all():
        raise SimulationError(f"at t = {t:g} the rates are not finite; state {s.tolist()}")
    inner = float(np.abs(np.linalg.eigvals(jacobian)).max(initial=0.0))
    return max(inner, *(piece.fastest for piece in pieces), 0.0)


def _note(
    model: ClosedModel, events: list[Event], t: float, old: Mode, new: Mode, guard: "_Guard"
) -> None:
    for port, before, after in zip(model.program.friction, old, new, strict=True):
        if before != after:
            kind = "stick" if after == 0 else ("slip" if before == 0 else "cross")
            events.append(Event(t, port.name, kind))
            guard.count(events)


class _Guard:
    """Stops a run whose events pile up at one instant."""

    def __init__(self, span: float) -> None:
        self.window = 1e-9 * span

    def count(self, events: list[Event]) -> None:
        """Refuse to go on when too many of the latest events fall together."""
        if len(events) >= STALLED and events[-1].time - events[-STALLED].time < self.window:
            latest = ", ".join(f"{e.kind} {e.port!r} at {e.time:.12g}" for e in events[-4:])
            raise SimulationError(
                f"{STALLED} events within {self.window:.3g} s: the run makes no progress ({latest})"
            )


class _Leg:
    """One smooth stretch in one mode, up to a breakpoint or the first event."""

    def __init__(
        self,
        model: ClosedModel,
        t: float,
        s: Array,
        stop: float,
        pieces: Sequence[Piece],
        mode: Mode,
        settings: Settings,
        fastest: float,
        span: float,
    ) -> None:
        self.model, self.t, self.s, self.stop = model, t, s, stop
        self.pieces, self.mode, self.settings = pieces, mode, settings
        name = settings.method
        if name == "auto":
            name = "Radau" if fastest * span > STIFF else "DOP853"
        bound = span / SMALLEST_SPAN
        if name == "DOP853" and fastest > 0:
            bound = min(bound, STEP_BOUND / fastest)
        self.method, self.bound = METHODS[name], bound
        self.watched = range(len(mode))
        now = self._snapshot(t, s)
        self.size: Scales = scales(model, now) if mode else Scales(*(np.zeros(0),) * 3)
        self.armed = [False] * len(mode)

    def run(self, times: Array, track: Track) -> tuple[float, Array, frozenset[int]]:
        """Integrate; returns where the leg ended, and the ports whose event ended it."""
        if self.stop - self.t <= 8 * np.spacing(max(abs(self.t), abs(self.stop))):
            return self.stop, self.s, frozenset()
        solver = self.method(
            self._rate, self.t, self.s, self.stop, rtol=self.settings.rtol,
            atol=self.settings.atol, max_step=self.bound,
        )  # fmt: skip
        before = self._triggers(self.t, self.s)
        while solver.status == "running":
            message = solver.step()
            if solver.status == "failed":
                raise SimulationError(f"at t = {solver.t:.9g} the integrator failed: {message}")
            dense = solver.dense_output()
            found, before = self._first_event(solver.t_old, solver.t, dense, before)
            until = solver.t if found is None else found[0]
            self._sample(times, track, until, dense)
            if found is not None:
                return until, dense(until), found[1]
        return self.stop, solver.y, frozenset()

    def _sample(
        self, times: Array, track: Track, until: float, dense: Callable[[float], Array]
    ) -> None:
        """Record the samples before ``until``: at it, the next leg shows the instant after."""
        while track.recorded < len(times) and times[track.recorded] < until:
            track.record(dense(times[track.recorded]), self.mode)

    def _rate(self, t: float, s: Array) -> Array:
        rate = self._snapshot(t, s).rate
        if not np.isfinite(rate).all():
            raise SimulationError(f"at t = {t:.9g} the rates are not finite; state {s.tolist()}")
        return rate

    def _snapshot(self, t: float, s: Array) -> Snapshot:
        return self.model.at(t, s, self.pieces, self.mode)

    def _triggers(self, t: float, s: Array) -> Array:
        """For each port what falls through zero at its event: its slip's magnitude, or its margin."""
        now = self._snapshot(t, s)
        efforts, slips = now.u[self.model.friction_inputs], now.y[self.model.friction_readings]
        return np.array([
            sign * slips[i] if sign else now.caps[i] - abs(efforts[i])
            for i, sign in enumerate(self.mode)
        ])  # fmt: skip

    def _limit(self, i: int) -> float:
        """The value that counts as zero for a trigger."""
        return float(self.size.slip[i] if self.mode[i] else self.size.effort[i])

    def _first_event(
        self, t_old: float, t_new: float, dense: Callable[[float], Array], before: Array
    ) -> tuple[tuple[float, frozenset[int]] | None, Array]:
        """The first time in a step at which a trigger falls through zero, and the ports it falls at."""
        if not self.mode:
            return None, before
        grid = np.linspace(t_old, t_new, CHECKS + 2)
        values = [before] + [self._triggers(t, dense(t)) for t in grid[1:]]
        for k in range(len(grid) - 1):
            roots: dict[int, float] = {}
            for i in self.watched:
                root = self._root(i, grid[k], grid[k + 1], values[k][i], values[k + 1][i], dense)
                if root is None and k > 0 and self.armed[i]:
                    root = self._dip(
                        i, grid[k - 1 : k + 2], [v[i] for v in values[k - 1 : k + 2]], dense
                    )
                if root is not None:
                    roots[i] = root
            if roots:
                time = min(roots.values())
                near = 1e-12 * max(abs(time), t_new - t_old)
                return (
                    time,
                    frozenset(i for i, root in roots.items() if root <= time + near),
                ), values[-1]
        return None, values[-1]

    def _root(
        self, i: int, t_a: float, t_b: float, a: float, b: float, dense: Callable[[float], Array]
    ) -> float | None:
        """Where trigger i falls through zero between two points, if it does.

        A trigger that starts at zero is armed once it has risen; until then it must fall well below.
        """
        limit = self._limit(i)
        if not self.armed[i]:
            if a > limit:
                self.armed[i] = True
            elif b > limit:
                self.armed[i] = True
                return None
            elif b >= -2 * limit:
                return None
            elif a <= -2 * limit:
                return t_a
            else:
                return self._crossing(i, t_a, t_b, -2 * limit, dense)
        return self._crossing(i, t_a, t_b, 0.0, dense) if b <= 0 else None

    def _crossing(
        self, i: int, t_a: float, t_b: float, level: float, dense: Callable[[float], Array]
    ) -> float:
        def above(t: float) -> float:
            return float(self._triggers(t, dense(t))[i] - level)

        if above(t_b) >= 0:
            return t_b
        if above(t_a) <= 0:
            return t_a
        root: Any = brentq(above, t_a, t_b, xtol=1e-15, rtol=4 * np.finfo(float).eps)
        return float(root)

    def _dip(
        self, i: int, grid: Array, values: Sequence[float], dense: Callable[[float], Array]
    ) -> float | None:
        """The first of two roots between samples, where a trigger dips below zero and comes back."""
        a, b, c = values
        if not (b < a and b < c) or min(values) <= 0:
            return None
        curve, slope = a - 2 * b + c, (c - a) / 2
        if b - slope**2 / (2 * curve) > 0.5 * b:
            return None
        lowest = minimize_scalar(
            lambda t: float(self._triggers(t, dense(t))[i]),
            bounds=(grid[0], grid[2]), method="bounded", options={"xatol": 1e-9 * (grid[2] - grid[0])},
        )  # fmt: skip
        if lowest.fun > 0:
            return None
        return self._crossing(i, float(grid[0]), float(lowest.x), 0.0, dense)
