"""Exact legs: where a friction mode is affine and inputs have linear generators, ``z' = M z`` is stepped
by matrix exponentials, and its events are roots of power series that no step can hide."""

import math

import numpy as np

from bondgraph.errors import SimulationError
from codegen.model.snapshot import Mode
from codegen.modes.rounding import Peaks
from codegen.modes.trials import Sight
from codegen.modes.verdicts import Look, look_at
from codegen.numbers.arrays import Array
from codegen.program.affine import AffineMap
from codegen.runs.falls import falls
from codegen.runs.stretches import Stretches
from codegen.runs.track import Ended, Track
from codegen.runs.watched import FewSteps, Steps, lasting, series, stride
from codegen.standalone.levels import without_rounding
from codegen.tuning import TUNING

MOST_LENGTHS = 8
"""So many different steps between samples each get an exponential of their own."""

BLOCK = 256
"""So many steps are taken before events are looked for."""

WINDOW = 1 << 16
"""So many samples are looked at together."""

FEW, FEW_BLOCK = 0.5, 8
"""So many steps for each component are few: they are taken one by one, so many at once."""

NONE = frozenset[int]()


class ExactLeg:
    """A stretch in one affine mode, from t with the integrated vector s."""

    def __init__(
        self, here: Sight, mode: Mode, affine: AffineMap, stretches: Stretches, peaks: Peaks,
        clear: bool,
    ) -> None:  # fmt: skip
        """The stretch that begins ``here``; ``clear``: all that is watched begins far above zero."""
        self._here, self._peaks = here, peaks
        self._n, self._mode, self._t = len(here.s), mode, here.t
        self._model, self._pieces = here.model, here.pieces
        rest = None if clear else _rest(look_at(here, mode, peaks))
        self._system, inputs = stretches.system(affine, mode, here.pieces, here.t, rest)
        self._z = np.concatenate([here.s, inputs])
        self._falls = falls(here, mode, peaks, self._system, None if clear else self._z)

    def steps(self, stop: float) -> float:
        """How many steps the stretch takes, of ``|M| h <= 1`` each."""
        return self._system.norm * (stop - self._t)

    def quick(self, stop: float, exact: bool) -> bool:
        """Whether to take the steps: unless ``exact`` is asked for, what mostly has decayed is left out.

        Raises `SimulationError` where there would be no end, of steps or of what step control has to follow.
        """
        steps = work = self.steps(stop)
        if steps <= TUNING.many:
            return True
        if not exact:
            work = min(steps, lasting(self._system.M, stop - self._t) / TUNING.least_part)
        if work <= TUNING.most:
            return work == steps
        raise SimulationError(
            f"at t = {self._t:.9g} rates of the model or of its inputs reach "
            f"{self._system.norm:.3g} 1/s: to look for events until {stop:.9g} s takes {steps:.3g} "
            "steps; run it for a shorter time, or leave the fastest out of the model"
        )

    def run(self, stop: float, times: Array, track: Track) -> Ended:
        """Step to ``stop`` or the first event, recording the samples before it."""
        first = track.recorded
        last = first + int(times[first:].searchsorted(stop))
        if first == last:
            return self._run_alone(stop, track)
        for begin in range(first, last, WINDOW):
            end = min(begin + WINDOW, last)
            points = times[begin:end] if end < last else np.append(times[begin:last], stop)
            ended = self._run_to(points, end, track)
            if ended is not None:
                return ended
        return stop, self._z[: self._n], NONE

    def _run_to(self, points: Array, last: int, track: Track) -> Ended | None:
        """Step over these points, those before sample ``last`` samples; what ended them."""
        t, z, samples = self._t, self._z, last - track.recorded
        # An event may lie a rounding behind a sample that shows the instant after it.
        lengths = np.maximum(np.diff(points, prepend=t), 0.0)
        if _kinds(lengths) > MOST_LENGTHS:
            return self._run_ragged(float(points[-1]), np.maximum(points[:samples], t), track)
        at = 0
        while at < len(points):
            if lengths[at] <= 2 * math.ulp(points[at]):
                # No more than the rounding of time.
                if at < samples:
                    self._record(track, z[None], points[at : at + 1])
                at, t = at + 1, float(points[at])
                continue
            count = _alike(lengths, at)
            h = float(lengths[at]) if count == 1 else float(points[at + count - 1] - t) / count
            ended, z = self._steps(t, z, h, count, track, last)
            if ended is not None:
                return ended
            at, t = at + count, float(points[at + count - 1])
        self._t, self._z = t, z
        return None

    def _run_alone(self, stop: float, track: Track) -> Ended:
        """The same where there are no samples."""
        h = stop - self._t
        if h <= 2 * math.ulp(stop):
            return stop, self._z[: self._n], NONE
        ended, z = self._steps(self._t, self._z, h, 1, track, track.recorded)
        return ended or (stop, z[: self._n], NONE)

    def _run_ragged(self, stop: float, times: Array, track: Track) -> Ended | None:
        """The same where samples lie anywhere: steps of one length, and samples by the series inside them."""
        t, system = self._t, self._system
        count = max(1, int(np.ceil(system.norm * (stop - t))))
        step = (stop - t) / count
        inside = series(system.M, np.eye(len(self._z)), step)
        steps, done = Steps(system.M, stride(system.M, system.triggers, step), self._z), 0
        for begin in range(0, count, BLOCK):
            states = steps.take(min(BLOCK, count - begin))
            start = t + begin * step
            found = self._falls.first(steps.powers(states[:-1]), start, step)
            track.see(states[:, : self._n])
            until = start + step * (len(states) - 1 if found is None else found[0] + found[1])
            now = times[done : max(done, int(times.searchsorted(until)))]
            self._record(track, _between(states, inside, (now - start) / step), now)
            done += len(now)
            if found is not None:
                whole, tau, ports = found
                return until, steps.inside(whole, tau)[: self._n], ports
        self._record(track, states[-1:].repeat(len(times) - done, axis=0), np.zeros(0))
        self._t, self._z = stop, states[-1]
        return None

    def _check_levels(self, rows: Array, times: Array, track: Track) -> None:
        """Where a friction level is below zero, let the model refuse it with its time."""
        caps = rows @ self._system.caps.T
        if caps.min(initial=0.0) >= 0:
            return
        sizes = np.abs(rows)
        sizes[:, : self._n] = np.maximum(sizes[:, : self._n], track.largest)
        caps = without_rounding(caps, sizes @ np.abs(self._system.caps.T))
        for at in np.flatnonzero((caps < 0).any(axis=1)).tolist():
            if at < len(times):
                self._model.at(float(times[at]), rows[at, : self._n], self._pieces, self._mode)

    def _record(self, track: Track, rows: Array, times: Array) -> None:
        """Samples, with their times."""
        if not len(rows):
            return
        if self._system.limited:
            self._check_levels(rows, times, track)
        track.take(rows[:, : self._n], self._mode)

    def _steps(
        self, t: float, z: Array, h: float, count: int, track: Track, last: int
    ) -> tuple[Ended | None, Array]:
        """``count`` steps of h from t, at whose ends samples are up to ``last``: what ended them, and z."""
        system = self._system
        parts = max(1, math.ceil(system.norm * h))
        step, few = h / parts, count * parts < FEW * len(z)
        taken = system.stride(step, 2 * math.ulp(t + h * count), few)
        steps: Steps | FewSteps
        if taken is None:
            steps, block = FewSteps(system.M, step, z, system.triggers), FEW_BLOCK
        else:
            steps, block = Steps(system.M, taken, z), BLOCK
        for begin in range(0, count * parts, block):
            states = steps.take(min(block, count * parts - begin))
            found = None
            if h > 0 and len(system.ports):
                found = self._falls.first(steps.powers(states[:-1]), t + begin * step, step)
            done = len(states) - 1 if found is None else found[0]
            rows = states[parts - begin % parts : done + 1 : parts]
            track.see(rows[:, : self._n])
            if len(rows := rows[: last - track.recorded]):
                places = np.arange(begin // parts + 1.0, begin // parts + 1.0 + len(rows))
                self._record(track, rows, np.asarray(t + h * places, dtype=float))
            if found is not None:
                whole, tau, ports = found
                end = steps.inside(whole, tau)[: self._n]
                return (t + (begin + whole + tau) * step, end, ports), z
        return None, states[-1]


def _rest(look: Look) -> Array | None:
    """What sticking ports' slips must stay below where only sources rule them; None if there are none."""
    ruled = look.ruling.any(axis=0)
    return np.where(ruled, TUNING.left * look.size.slip, np.inf) if ruled.any() else None


def _between(states: Array, series: Array, places: Array) -> Array:
    """z inside steps that begin at ``states``: at 3.25 a quarter into the fourth."""
    whole = np.minimum(places.astype(int), len(states) - 2)
    tau, begins = (places - whole)[:, None], states[whole]
    rows = np.zeros_like(begins)
    for term in series[::-1]:
        rows = rows * tau + begins @ term.T
    return np.asarray(rows, dtype=float)


def _kinds(lengths: Array) -> int:
    """How many stretches of equal lengths there are."""
    if len(lengths) == 1:
        return 1
    changes = np.abs(lengths[1:] - lengths[:-1])
    return 1 + int(np.count_nonzero(changes > TUNING.alike * lengths[1:]))


def _alike(lengths: Array, at: int) -> int:
    """How many steps from here on have the same length, but for the rounding of their ends."""
    if at == len(lengths) - 1:
        return 1
    near = np.abs(lengths[at:] - lengths[at]) <= TUNING.alike * lengths[at]
    return int(np.argmin(near)) if not near.all() else len(near)
