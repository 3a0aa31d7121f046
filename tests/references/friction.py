"""Masses, springs, dampers and Coulomb friction between shafts of which some are turned by sources.

    M v' = p - D_v^T c (D_v v + D_w w) - S_v^T k d - W^T f,    d' = S_v v + S_w w,    s = W v + Z w

v: speeds of the masses, d: deflections, w: imposed speeds, s: slips, f: what friction gives, within its
level L, and L sign(s) where it slips. Nothing of a bond graph is here: matrices in, motion out.

Assumed: breakaway at the level; w, p and L are `Wave`s; masses are positive. Then the acceleration at
an instant is unique: it makes ``|v' - v'_free|^2 / 2 + sum L |s'|`` over the ports at rest least, in
the norm of M (Gauss; Moreau 1988). What one instant leaves open is decided a moment later.

A set of ports may stick only where its slips can stay zero: combinations N with ``N^T W = 0`` are ruled by
sources alone, and need ``N^T Z w = 0`` and ``N^T Z w' = 0``. Between events every mode is linear with
linear and sinusoidal inputs: ``z' = A z``, stepped by matrix exponentials.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm, null_space
from scipy.optimize import brentq, linprog

Array = NDArray[np.float64]
Mode = tuple[int, ...]
Happening = tuple[float, int, str]
SMALL, MOMENT = 1e-11, 1e-8


@dataclass(frozen=True)
class Wave:
    """From each of ``begins`` on a line (value there, slope); and a sine that never ends."""

    begins: tuple[float, ...] = (0.0,)
    values: tuple[float, ...] = (0.0,)
    slopes: tuple[float, ...] = (0.0,)
    amplitude: float = 0.0
    omega: float = 0.0
    phase: float = 0.0

    def at(self, t: float) -> int:
        """The line that holds from t on."""
        return max(int(np.searchsorted(self.begins, t, side="right")) - 1, 0)

    def __call__(self, t: float) -> float:
        k = self.at(t)
        line = self.values[k] + self.slopes[k] * (t - self.begins[k])
        return line + self.amplitude * float(np.sin(self.omega * t + self.phase))


@dataclass(frozen=True)
class Driveline:
    """The matrices of the module's equations; ``start``: v and d at time zero."""

    M: Array
    D_v: Array
    D_w: Array
    c: Array
    S_v: Array
    S_w: Array
    k: Array
    W: Array
    Z: Array
    levels: tuple[Wave, ...]
    forces: tuple[Wave, ...]
    speeds: tuple[Wave, ...]
    start: Array


@dataclass
class Course:
    """What a run found: v and d at the times, efforts just after them, and the ports' events."""

    states: list[Array] = field(default_factory=list)
    modes: list[Mode] = field(default_factory=list)
    events: list[Happening] = field(default_factory=list)


class Machine:
    """The motion of one driveline."""

    def __init__(self, line: Driveline) -> None:
        self._line = line
        self._n, self._d = len(line.M), len(line.k)
        self._waves = (*line.levels, *line.forces, *line.speeds)
        self._modes: dict[Mode, _Mode | None] = {}
        self._step = 0.02 / max(self._fastest, 1e-9)

    @cached_property
    def _fastest(self) -> float:
        free = self._free()[:, : self._n + self._d]
        omegas = [wave.omega for wave in self._waves]
        return float(max(np.abs(np.linalg.eigvals(free)).max(initial=0.0), *omegas, 1.0))

    def run(self, times: Array) -> Course:
        """Follow the motion from the first of the times to the last."""
        course, t, x = Course(), float(times[0]), self._line.start.copy()
        breaks = sorted({b for wave in self._waves for b in wave.begins if b > t})
        mode: Mode = tuple(1 for _ in self._line.levels)
        first = True
        while True:
            mode, x = self._decide(t, x, mode, course, first)
            first = False
            stop = min([b for b in breaks if b > t] + [float(times[-1])])
            t_new, z = self._advance(t, x, mode, stop, times, course)
            if t_new >= times[-1]:
                course.states.append(z[: self._n + self._d])
                course.modes.append(mode)
                return course
            t, x = t_new, z[: self._n + self._d]
            if len(course.events) > 4000:
                raise RuntimeError("the machine makes no progress")

    def efforts(self, t: float, x: Array, mode: Mode) -> Array:
        """What friction gives in a mode; nan where several ports share what holds."""
        made = self._made(mode)
        assert made is not None
        f = made.efforts @ self._z(t, x)
        f[made.shared] = np.nan
        return f

    def slips(self, t: float, x: Array) -> Array:
        """The slips at one time."""
        w = np.array([wave(t) for wave in self._line.speeds])
        return self._line.W @ x[: self._n] + self._line.Z @ w

    def _decide(
        self, t: float, x: Array, old: Mode, course: Course, first: bool
    ) -> tuple[Mode, Array]:
        """The mode just after t, and the state with what is stuck at rest to the last digit."""
        slips = self.slips(t, x)
        size = 1e-8 * (1 + np.abs(x[: self._n]).max(initial=0.0) + self._largest_speed(t))
        rest = [i for i, s in enumerate(slips) if abs(s) <= size]
        for mode in self._candidates(slips, rest):
            if self._holds(t, x, mode, rest):
                break
        else:
            raise RuntimeError(f"no mode is consistent at t = {t}: slips {slips}")
        if not first:
            for i, (a, b) in enumerate(zip(old, mode, strict=True)):
                if a != b:
                    kind = "stick" if b == 0 else "slip" if a == 0 else "cross"
                    course.events.append((t, i, kind))
        return mode, self._at_rest(t, x, mode)

    def _candidates(self, slips: Array, rest: list[int]) -> Iterator[Mode]:
        choices = sorted(product((0, 1, -1), repeat=len(rest)), key=lambda c: -c.count(0))
        for choice in choices:
            mode = [1 if s > 0 else -1 for s in slips]
            for i, sign in zip(rest, choice, strict=True):
                mode[i] = sign
            yield tuple(mode)

    def _holds(self, t: float, x: Array, mode: Mode, rest: list[int]) -> bool:
        """Whether a mode is consistent at t and a moment later."""
        made = self._made(mode)
        if made is None:
            return False
        x = self._at_rest(t, x, mode)
        now = self._z(t, x)
        A = self._system(made)
        for z, later in ((now, False), (expm(A * MOMENT) @ now, True)):
            if np.abs(made.ruled @ z).max(initial=0.0) > 1e-9 * (1 + np.abs(z).max()):
                return False
            size = SMALL * (1 + np.abs(self._forces(z)).max(initial=0.0))
            if 0 in mode and made.margin(z, self._levels(z)) < -size:
                return False
            if later and not all(self._moves(made, A, z, i, mode[i]) for i in rest if mode[i]):
                return False
        return True

    def _moves(self, made: _Mode, A: Array, z: Array, i: int, sign: int) -> bool:
        slip = made.slips[i] @ z
        if abs(slip) > 1e-13 * (1 + np.abs(z).max()):
            return bool(sign * slip > 0)
        return bool(sign * (made.slips[i] @ A @ z) > 0)

    def _at_rest(self, t: float, x: Array, mode: Mode) -> Array:
        stuck = [i for i, sign in enumerate(mode) if sign == 0]
        x = x.copy()
        if stuck and self._n:
            W = self._line.W[stuck]
            inner = np.linalg.pinv((W / self._line.M) @ W.T)
            x[: self._n] -= (W.T @ (inner @ self.slips(t, x)[stuck])) / self._line.M
        return x

    def _advance(
        self, t: float, x: Array, mode: Mode, stop: float, times: Array, course: Course
    ) -> tuple[float, Array]:
        """Step to ``stop`` or the first event; the samples before it are recorded."""
        made = self._made(mode)
        assert made is not None
        A = self._system(made)
        count = max(1, int(np.ceil((stop - t) / self._step)))
        h = (stop - t) / count
        leap, z = expm(A * h), self._z(t, x)
        before = self._triggers(made, mode, z)
        armed = before > 1e-10
        for k in range(count):
            z_next = leap @ z
            after = self._triggers(made, mode, z_next)
            fallen = np.flatnonzero(np.where(armed, after <= 0, after < -1e-9))
            left = h
            if len(fallen):
                left = min(self._root(made, mode, A, z, h, int(i), armed[int(i)]) for i in fallen)
            at = t + k * h
            # Where the next step begins, to the last digit: a sample there is the next step's alone.
            end = at + left if len(fallen) else min(t + (k + 1) * h, stop)
            inside = times[(times >= at) & (times < end)]
            course.states += [(expm(A * (s - at)) @ z)[: self._n + self._d] for s in inside]
            course.modes += [mode] * len(inside)
            if len(fallen):
                return end, expm(A * left) @ z
            z, armed = z_next, armed | (after > 1e-10)
        return stop, z

    def _root(
        self, made: _Mode, mode: Mode, A: Array, z: Array, h: float, i: int, armed: bool
    ) -> float:
        level = 0.0 if armed else -1e-9

        def value(s: float) -> float:
            return float(self._triggers(made, mode, expm(A * s) @ z)[i] - level)

        return 0.0 if value(0.0) <= 0 else float(brentq(value, 0.0, h, xtol=1e-15))

    def _triggers(self, made: _Mode, mode: Mode, z: Array) -> Array:
        """Positive while the mode lasts: the slips of ports that slip, and the margin of those that hold."""
        slips = made.slips @ z
        moving = [sign * slips[i] if sign else 1.0 for i, sign in enumerate(mode)]
        held = made.margin(z, self._levels(z)) if 0 in mode else 1.0
        return np.array([*moving, held])

    # z = [v, d, 1, then value and slope of the line and sine and cosine of each wave]

    def _z(self, t: float, x: Array) -> Array:
        more = [1.0]
        for wave in self._waves:
            k, angle = wave.at(t), wave.omega * t + wave.phase
            more += [wave.values[k] + wave.slopes[k] * (t - wave.begins[k]), wave.slopes[k]]
            more += [wave.amplitude * np.sin(angle), wave.amplitude * np.cos(angle)]
        return np.concatenate([x, more])

    def _rows(self, waves: range, rate: bool = False) -> Array:
        """Values, or rates, of some waves as rows over z."""
        begin = self._n + self._d + 1
        rows = np.zeros((len(waves), begin + 4 * len(self._waves)))
        for row, k in zip(rows, waves, strict=True):
            at = begin + 4 * k
            if rate:
                row[at + 1], row[at + 3] = 1.0, self._waves[k].omega
            else:
                row[at], row[at + 2] = 1.0, 1.0
        return rows

    @cached_property
    def _ranges(self) -> tuple[range, range, range]:
        a, b = len(self._line.levels), len(self._line.forces)
        return range(a), range(a, a + b), range(a + b, len(self._waves))

    def _levels(self, z: Array) -> Array:
        return self._rows(self._ranges[0]) @ z

    def _forces(self, z: Array) -> Array:
        """What scales efforts: levels, outer forces, springs."""
        springs = self._line.k * z[self._n : self._n + self._d]
        return np.concatenate([self._levels(z), self._rows(self._ranges[1]) @ z, springs])

    def _largest_speed(self, t: float) -> float:
        return max((abs(wave(t)) for wave in self._line.speeds), default=0.0)

    def _free(self) -> Array:
        """v' without friction, and d', as rows over z."""
        line, n, d = self._line, self._n, self._d
        force, speed = self._rows(self._ranges[1]), self._rows(self._ranges[2])
        state = np.eye(n + d, force.shape[1])
        v, deflection = state[:n], state[n:]
        damping = line.D_v.T @ (line.c[:, None] * (line.D_v @ v + line.D_w @ speed))
        springs = line.S_v.T @ (line.k[:, None] * deflection)
        rate = (force - damping - springs) / line.M[:, None]
        return np.vstack([rate, line.S_v @ v + line.S_w @ speed])

    def _made(self, mode: Mode) -> _Mode | None:
        if mode not in self._modes:
            self._modes[mode] = self._make(mode)
        return self._modes[mode]

    def _make(self, mode: Mode) -> _Mode:
        line, n = self._line, self._n
        level = self._rows(self._ranges[0])
        speed, rate = self._rows(self._ranges[2]), self._rows(self._ranges[2], rate=True)
        free = self._free()
        slips = line.W @ np.eye(n, level.shape[1]) + line.Z @ speed
        efforts = np.array(mode, dtype=float)[:, None] * level
        stuck = [i for i, sign in enumerate(mode) if sign == 0]
        W, Z = line.W[stuck], line.Z[stuck]
        pushed = free[:n] - (line.W.T @ efforts) / line.M[:, None]
        inner = (W / line.M) @ W.T
        share = null_space(inner, rcond=1e-10) if stuck else np.zeros((0, 0))
        efforts[stuck] = np.linalg.pinv(inner, rcond=1e-10) @ (W @ pushed + Z @ rate)
        pushed = free[:n] - (line.W.T @ efforts) / line.M[:, None]
        ruled = np.vstack([share.T @ (Z @ speed), share.T @ (Z @ rate)])
        shared = [i for at, i in enumerate(stuck) if np.abs(share[at]).max(initial=0.0) > 1e-9]
        return _Mode(tuple(stuck), pushed, free[n:], efforts, slips, share, ruled, shared)

    def _system(self, made: _Mode) -> Array:
        begin = self._n + self._d + 1
        A = np.zeros((begin + 4 * len(self._waves), begin + 4 * len(self._waves)))
        A[: self._n], A[self._n : begin - 1] = made.pushed, made.rates
        for k, wave in enumerate(self._waves):
            at = begin + 4 * k
            A[at, at + 1], A[at + 2, at + 3], A[at + 3, at + 2] = 1.0, wave.omega, -wave.omega
        return A


@dataclass(frozen=True)
class _Mode:
    """A mode as rows over z. ``share``: how efforts of stuck ports may change and move nothing."""

    stuck: tuple[int, ...]
    pushed: Array
    rates: Array
    efforts: Array
    slips: Array
    share: Array
    ruled: Array
    shared: Sequence[int]

    def margin(self, z: Array, levels: Array) -> float:
        """How far what holds stays below the levels, shared as well as it can be."""
        held, most = self.efforts[list(self.stuck)] @ z, levels[list(self.stuck)]
        if not self.share.size:
            return float((most - np.abs(held)).min())
        rows = np.vstack([self.share, -self.share])
        ends = np.concatenate([most - held, most + held])
        return -_least_excess(rows, ends)


def _least_excess(rows: Array, ends: Array) -> float:
    """The least e with ``rows a <= ends + e`` for some a."""
    if rows.shape[1] > 1:
        cost = np.append(np.zeros(rows.shape[1]), 1.0)
        wide = np.hstack([rows, -np.ones((len(rows), 1))])
        return float(linprog(cost, wide, ends, bounds=(None, None)).fun)
    # The highest of a few lines over one a is lowest where two of them cross.
    slopes = rows[:, 0]
    rise = slopes[:, None] - slopes
    crossings = (ends[:, None] - ends)[rise > 0] / rise[rise > 0]
    highest = (np.outer(crossings, slopes) - ends).max(axis=1)
    return float(highest.min())
