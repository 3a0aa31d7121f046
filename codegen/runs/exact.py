"""Exact legs: where a friction mode is affine and inputs have linear generators, ``z' = M z`` is stepped
by matrix exponentials, and its events are roots of power series that no step can hide."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg

from codegen.arrays import Array
from codegen.inputs.generators import generator
from codegen.inputs.pieces import Piece
from codegen.inputs.polynomials import first_fall, to_bernstein, value
from codegen.model.affine import AffineMap
from codegen.model.closed import CAPS, INPUTS, RATE, READINGS, ClosedModel, Mode
from codegen.model.modes import LOOK_AHEAD, Peaks, scales
from codegen.runs.legs import Ended, Track

DEGREE = 18
"""Of the power series; over a step of ``|M| h <= 1`` what is left out is below rounding."""

MOST_STEPS = 300_000
"""Steps are so short that ``|M| h <= 1``; stretches that would need more of them are left to step control."""

MOST_LENGTHS = 8
"""So many different steps between samples each get an exponential of their own."""

BLOCK = 256
"""So many steps are taken before events are looked for."""


@dataclass(frozen=True)
class Affine:
    """``z' = M z`` with z = [s, g], and the rows over z of triggers; ``ports``: whose trigger each row is.

    A sticking port has two: the distances of its effort to both breakaway efforts.
    """

    M: Array
    triggers: Array
    caps: Array
    ports: tuple[int, ...]
    #: A bound on |M| in a norm in which M is balanced.
    norm: float


class ExactLeg:
    """A stretch in one affine mode, from t with the integrated vector s."""

    def __init__(
        self,
        model: ClosedModel,
        affine: AffineMap,
        pieces: Sequence[Piece],
        mode: Mode,
        t: float,
        s: Array,
        peaks: Peaks,
    ) -> None:
        made = generator(pieces, t)
        self._n, self._mode, self._t = len(s), mode, t
        self._model, self._pieces = model, pieces
        self._system = _system(model, affine, made.G, made.C, mode, len(s))
        self._z = np.concatenate([s, made.start])
        self._blind = LOOK_AHEAD * peaks.time
        now = model.at(t, s, pieces, mode)
        size = scales(model, now, t, peaks)
        limits = np.where(np.array(mode) == 0, size.effort, size.slip)
        self._limits = limits[list(self._system.ports)] if mode else np.zeros(0)
        self._armed = np.zeros(len(self._limits), dtype=bool)

    def steppable(self, stop: float) -> bool:
        """Whether the stretch takes a bearable number of steps."""
        return self._system.norm * (stop - self._t) <= MOST_STEPS

    def run(self, stop: float, times: Array, track: Track) -> Ended:
        """Step to ``stop`` or the first event, recording the samples before it."""
        first = track.recorded
        last = first + int(np.searchsorted(times[first:], stop, side="left"))
        points = np.concatenate([times[first:last], [stop]])
        t, z = self._t, self._z
        # An event may lie a rounding behind a sample that shows the instant after it.
        lengths = np.maximum(np.diff(np.concatenate([[t], points])), 0.0)
        if _kinds(lengths) > MOST_LENGTHS:
            return self._run_ragged(stop, np.maximum(points[:-1], t), track)
        at = 0
        while at < len(points):
            count = _alike(lengths, at)
            h = float(lengths[at]) if count == 1 else float(points[at + count - 1] - t) / count
            ended, rows = self._steps(t, z, h, count)
            track.see(rows[:, : self._n])
            recorded = min(len(rows), last - first - at)
            self._check_levels(rows, np.asarray(t + h * np.arange(1, len(rows) + 1), dtype=float))
            self._record(track, rows[:recorded])
            if ended is not None:
                return ended
            at, t, z = at + count, float(points[at + count - 1]), rows[-1]
        return stop, z[: self._n], frozenset()

    def _run_ragged(self, stop: float, times: Array, track: Track) -> Ended:
        """The same where samples lie anywhere: steps of one length, and samples by the series inside them."""
        t, z, system = self._t, self._z, self._system
        count = max(1, int(np.ceil(system.norm * (stop - t))))
        step = (stop - t) / count
        leap, series = scipy.linalg.expm(system.M * step), _series(system, step)
        inside = _series(replace(system, triggers=np.eye(len(z))), step)
        for begin in range(0, count, BLOCK):
            states = powers_of(leap, z, min(BLOCK, count - begin))
            start = t + begin * step
            found = self._first_event(states[:-1], series, start, step)
            track.see(states[:, : self._n])
            until = start + step * (len(states) - 1 if found is None else found[0] + found[1])
            now = times[(times >= start) & (times < until)]
            rows = _between(states, inside, (now - start) / step)
            self._check_levels(rows, now)
            self._record(track, rows)
            if found is not None:
                whole, tau, ports = found
                end = scipy.linalg.expm(system.M * (tau * step)) @ states[whole]
                return until, end[: self._n], ports
            z = states[-1]
        self._record(track, np.repeat(z[None], np.count_nonzero(times >= until), axis=0))
        return stop, z[: self._n], frozenset()

    def _record(self, track: Track, rows: Array) -> None:
        a, b = track.recorded, track.recorded + len(rows)
        track.vectors[a:b] = rows[:, : self._n]
        track.modes += [self._mode] * len(rows)
        track.recorded = b

    def _check_levels(self, rows: Array, times: Array) -> None:
        """Where a friction level is below zero, let the model refuse it with its time."""
        for at in np.flatnonzero((rows @ self._system.caps.T < 0).any(axis=1)).tolist():
            self._model.at(float(times[at]), rows[at, : self._n], self._pieces, self._mode)

    def _steps(self, t: float, z: Array, h: float, count: int) -> tuple[Ended | None, Array]:
        """``count`` steps of h from t: what ended them, and z at the end of each step that was whole."""
        if h <= 0:
            return None, np.repeat(z[None], count, axis=0)
        parts = max(1, int(np.ceil(self._system.norm * h)))
        step = h / parts
        leap = scipy.linalg.expm(_beyond(self._system.M, z, self._n) * step)
        moved = np.eye(1, len(z), self._n)[0]
        series = _series(self._system, step)
        rows = np.empty((0, len(z)))
        for begin in range(0, count * parts, BLOCK):
            further = powers_of(leap, moved, min(BLOCK, count * parts - begin))
            states, moved = z + further, further[-1]
            states[:, self._n] = z[self._n]
            found = self._first_event(states[:-1], series, t + begin * step, step)
            if found is not None:
                whole, tau, ports = found
                end = scipy.linalg.expm(self._system.M * (tau * step)) @ states[whole]
                rows = np.vstack([rows, states[1 : whole + 1]])[parts - 1 :: parts]
                time = t + (begin + whole + tau) * step
                return (time, end[: self._n], ports), rows
            rows = np.vstack([rows, states[1:]])
        return None, rows[parts - 1 :: parts]

    def _first_event(
        self, states: Array, series: Array, t: float, step: float
    ) -> tuple[int, float, frozenset[int]] | None:
        """Step, place in it and ports of the first event among steps that begin at ``states``."""
        if not len(self._limits):
            return None
        powers = np.einsum("krz,sz->srk", series, states)
        least = (powers @ to_bernstein(DEGREE).T).min(axis=2)
        suspects = (least <= 0) | ~self._armed
        at = 0
        while at < len(states):
            ahead = np.flatnonzero(suspects[at:].any(axis=1))
            if not len(ahead):
                return None
            at += int(ahead[0])
            roots: dict[int, float] = {}
            for row in np.flatnonzero(suspects[at]).tolist():
                root = self._root(row, powers[at, row], (t - self._t) + at * step, step)
                if root is not None:
                    port = self._system.ports[row]
                    roots[port] = min(root, roots.get(port, 2.0))
            if roots:
                tau = min(roots.values())
                near = tau + 1e-12 * max(1.0, (t + at * step) / step)
                return at, tau, frozenset(p for p, root in roots.items() if root <= near)
            at += 1
            suspects[at:] = (least[at:] <= 0) | ~self._armed
        return None

    def _root(self, row: int, powers: Array, elapsed: float, step: float) -> float | None:
        """Where one trigger falls in a step; one that began at zero is armed when it has risen."""
        begin = 0.0
        if not self._armed[row]:
            limit = self._limits[row]
            rise, fall = -powers, powers.copy()
            rise[0] += limit
            fall[0] += 2 * limit
            armed = 0.0 if rise[0] <= 0 else first_fall(rise)
            blind = min(max((self._blind - elapsed) / step, 0.0), 1.0)
            lost = blind if value(fall, blind) <= 0 else first_fall(fall, blind)
            if armed is None or (lost is not None and lost < armed):
                return lost if lost is not None and lost < 1.0 else None
            self._armed[row], begin = True, armed
        root = first_fall(powers, begin)
        if root is not None and powers.sum() > 0:
            # It comes back: a touch, unless it fell below zero by more than rounding.
            below = powers.copy()
            below[0] += self._limits[row]
            return root if first_fall(below, root) is not None else None
        return root


def _beyond(M: Array, z: Array, one: int) -> Array:
    """The same system told from z on, so that nothing large is rounded in every step.

    Component ``one``, which is 1 for ever, brings the rate that there is at z.
    """
    further = M.copy()
    further[:, one] = M @ z
    return further


def powers_of(leap: Array, z: Array, count: int) -> Array:
    """z, P z, P^2 z, ... up to P^count z, as rows; by doubling."""
    rows = np.empty((count + 1, len(z)))
    rows[0] = z
    done, power = 1, leap.T
    while done <= count:
        more = min(done, count + 1 - done)
        rows[done : done + more] = rows[:more] @ power
        done += more
        power = power @ power
    return rows


def _system(
    model: ClosedModel, affine: AffineMap, G: Array, C: Array, mode: Mode, n: int
) -> Affine:
    """An affine mode over z: inputs and their rates are rows over g, whose first component is 1."""
    m = len(C)
    fed = np.vstack([C, C @ G, np.eye(1, len(G))])

    def over_z(rows: Array) -> Array:
        return np.hstack([rows[:, :n], rows[:, n : n + 2 * m + 1] @ fed])

    rate = over_z(affine.rows(RATE))
    M = np.vstack([rate, np.hstack([np.zeros((len(G), n)), G])])
    efforts = over_z(affine.rows(INPUTS)[model.friction_inputs])
    slips = over_z(affine.rows(READINGS)[model.friction_readings])
    caps = over_z(affine.rows(CAPS))
    triggers, ports = [np.zeros((0, len(M)))], []
    for i, sign in enumerate(mode):
        rows = [sign * slips[i]] if sign else [caps[i] - efforts[i], caps[i] + efforts[i]]
        triggers.append(np.array(rows))
        ports += [i] * len(rows)
    balanced = scipy.linalg.matrix_balance(M, permute=False)[0]
    norm = float(min(np.linalg.norm(balanced, 1), np.linalg.norm(balanced, np.inf)))
    return Affine(M, np.vstack(triggers), caps, tuple(ports), norm)


def _series(system: Affine, step: float) -> Array:
    """``W (M step)^k / k!`` for each k: the coefficients of the triggers' power series over a step."""
    rows = system.triggers
    series = [rows]
    for k in range(1, DEGREE + 1):
        rows = rows @ system.M * (step / k)
        series.append(rows)
    return np.array(series)


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
    return 1 + int(np.count_nonzero(np.abs(np.diff(lengths)) > 1e-9 * lengths[1:]))


def _alike(lengths: Array, at: int) -> int:
    """How many steps from here on have the same length, but for the rounding of their ends."""
    near = np.abs(lengths[at:] - lengths[at]) <= 1e-9 * lengths[at]
    return int(np.argmin(near)) if not near.all() else len(near)
