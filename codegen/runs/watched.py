"""An affine mode with its inputs' generator as one linear system, and what is watched in it."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
import scipy

from codegen.inputs.generators import Generator
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.modes.keeping import GUARDS, is_kept, watched_by
from codegen.numbers.arrays import Array
from codegen.numbers.latest import Latest
from codegen.program.affine import AffineMap, balanced_norm
from codegen.program.layout import CAPS, INPUTS, RATE, READINGS
from codegen.tuning import TUNING

STRIDES = 16
"""Lengths of steps of one mode whose exponentials are kept."""


class Stride(NamedTuple):
    """A step of one length: its exponential, the integral of that, and the power series of triggers."""

    step: float
    leap: Array
    gather: Array
    series: Array


@dataclass(frozen=True)
class Watched:
    """``z' = M z`` with z = [s, g], and the rows over z of triggers; ``ports``: whose trigger each row is.

    A sticking port has two: the distances of its effort to both breakaway efforts, or of its slip to what
    is no longer zero, where only sources rule it: it gives nothing then. A switch has what keeps it.
    """

    M: Array
    triggers: Array
    caps: Array
    ports: tuple[int, ...]
    #: A bound on |M| in a norm in which M is balanced.
    norm: float
    #: Whether a port has a friction level.
    limited: bool
    _strides: Latest[str, Stride] = field(default_factory=lambda: Latest(STRIDES), repr=False)
    _met: Latest[str, bool] = field(default_factory=Latest, repr=False)

    def stride(self, step: float, late: float, few: bool) -> Stride | None:
        """A step [s] of this length, to ``late`` [s]; of one for ``few`` steps from the second on."""
        key = f"{step:.9e}"
        if few and key not in self._met:
            self._met.of(key, lambda: True)
            return None
        found = self._strides.of(key, lambda: stride(self.M, self.triggers, step))
        # Lengths that differ by no more than their ends are rounded are one.
        return found if abs(found.step - step) <= late else stride(self.M, self.triggers, step)


def inputs_of(model: ClosedModel, affine: AffineMap, mode: Mode, n: int) -> list[int]:
    """The external inputs that anything rests on in a mode, but for the conditions that time alone rules."""
    m = (affine.matrix.shape[1] - n - 1) // 2
    asked = [
        affine.rows(RATE), affine.rows(CAPS), affine.rows(INPUTS)[model.friction_inputs],
        affine.rows(READINGS)[model.friction_readings],
    ]  # fmt: skip
    guards = model.guard_rows(mode, m)
    for i in (i for i in range(len(mode)) if is_kept(model, mode, i)):
        part, at, _ = watched_by(model, mode, i)
        if guards is not None and part == GUARDS and i not in model.timed:
            asked.append(guards[[at]])
    used: Array = np.abs(np.vstack(asked)[:, n : n + 2 * m]).max(axis=0, initial=0.0)
    return np.flatnonzero(used[:m] + used[m:]).tolist()


def over_z(rows: Array, made: Generator, n: int) -> Array:
    """Rows over [s, w, dw, 1] as rows over [s, g]: the first component of g is 1."""
    m = len(made.C)
    fed = np.vstack([made.C, made.C @ made.G, np.eye(1, len(made.G))])
    return np.concatenate([rows[..., :n], rows[..., n : n + 2 * m + 1] @ fed], axis=-1)


def watched(
    model: ClosedModel, affine: AffineMap, made: Generator, mode: Mode, rest: Array | None,
    inputs: Sequence[int],
) -> Watched:  # fmt: skip
    """An affine mode over z, whose first components are s; ``made``: these external inputs.

    ``rest``: what a sticking port's slip must stay below where only sources rule it.
    """
    n, m, G = model.size, len(model.program.external), made.G
    columns = [*range(n), *(n + i for i in inputs), *(n + m + i for i in inputs), n + 2 * m]

    def told(rows: Array) -> Array:
        return over_z(rows[:, columns], made, n)

    M = np.vstack([told(affine.rows(RATE)), np.hstack([np.zeros((len(G), n)), G])])
    efforts = told(affine.rows(INPUTS)[model.friction_inputs])
    slips = told(affine.rows(READINGS)[model.friction_readings])
    caps, guards = told(affine.rows(CAPS)), model.guard_rows(mode, m)
    conditions = np.zeros((0, len(M))) if guards is None else told(guards)
    rest = np.full(len(mode), np.inf) if rest is None else rest
    triggers, ports = [np.zeros((0, len(M)))], []
    for i, sign in enumerate(mode):
        if i in model.timed:
            continue
        if is_kept(model, mode, i) and not np.isfinite(rest[i]):
            part, at, way = watched_by(model, mode, i)
            triggers.append(way * (slips, efforts, conditions)[part][[at]])
            ports.append(i)
            continue
        below, moved = caps[i], efforts[i]
        if np.isfinite(rest[i]):
            below, moved = rest[i] * np.eye(1, len(M), n)[0], slips[i]
        rows = [sign * slips[i]] if sign else [below - moved, below + moved]
        triggers.append(np.array(rows))
        ports += [i] * len(rows)
    norm = balanced_norm(M)
    return Watched(M, np.vstack(triggers), caps, tuple(ports), norm, affine.limited)


def lasting(M: Array, span: float) -> float:
    """How many radians or time constants of ``z' = M z`` have to be followed over a span [s].

    A motion that decays is over after some of its time constants, one that turns on goes on for ever.
    """
    rates = np.linalg.eigvals(scipy.linalg.matrix_balance(M, permute=False)[0])
    ends = np.minimum(span, TUNING.gone / np.maximum(-rates.real, TUNING.gone / span))
    return float((np.abs(rates) * ends).max(initial=0.0))


def series(M: Array, rows: Array, step: float | Array) -> Array:
    """``rows (M step)^k / k!`` for each k: the coefficients of their power series over a step."""
    found = [rows]
    for k in range(1, TUNING.degree + 1):
        rows = rows @ M * (step / k)
        found.append(rows)
    return np.array(found)


def exponential(M: Array, step: float | Array) -> tuple[Array, Array]:
    """``exp(M step)`` and its integral over the step, which has ``|M| step <= 1``; of stacks, too."""
    size = M.shape[-1]
    total = term = np.eye(size)
    for k in range(2, TUNING.degree + 2):
        term = M @ term * (step / k)
        total = total + term
    gather = total * step
    return np.eye(size) + M @ gather, gather


def stride(M: Array, rows: Array, step: float) -> Stride:
    """A step of so long [s], and the power series of these rows over it."""
    return Stride(step, *exponential(M, step), series(M, rows, step))


class Steps:
    """States at the ends of steps of one length, and the power series of rows over each step.

    They are told from the first, so that nothing large is rounded again in every step.
    """

    def __init__(self, M: Array, taken: Stride, z: Array) -> None:
        self._M, self._step, self._leap, self._series = M, taken.step, taken.leap, taken.series
        self._start, self._beyond = z, np.zeros(len(z))
        self._change = taken.gather.dot(M.dot(z))

    def take(self, count: int) -> Array:
        """The state that was come to, and those after 1, 2, .. ``count`` more steps."""
        if count == 1:
            states = np.empty((2, len(self._start)))
            states[0] = self._start + self._beyond
            self._beyond = self._beyond + self._change
            states[1] = self._start + self._beyond
            self._change, self._states = self._leap.dot(self._change), states
            return states
        changes = powers_of(self._leap, self._change, count)
        beyond = np.cumsum(np.vstack([self._beyond, changes[:-1]]), axis=0)
        self._beyond, self._change = beyond[-1], changes[-1]
        self._states = np.asarray(self._start + beyond, dtype=float)
        return self._states

    def powers(self, states: Array) -> Array:
        """Of the steps from these states, those latest taken, the series of each row."""
        found: Array = states.dot(self._series.reshape(-1, states.shape[1]).T)
        return found.reshape(len(states), *self._series.shape[:2]).transpose(0, 2, 1)

    def inside(self, at: int, part: float) -> Array:
        """The state a part of a step after the one at a place among those latest taken."""
        terms = taylor(self._M, self._states[at], part * self._step)
        return np.asarray(terms[::-1].sum(axis=0), dtype=float)


class FewSteps:
    """The same for few steps of a large system: by the Taylor series of each state, without a matrix."""

    def __init__(self, M: Array, step: float, z: Array, rows: Array) -> None:
        self._M, self._step, self._rows = M, step, rows
        self._start, self._beyond = z, np.zeros_like(z)
        self._terms: list[Array] = []

    def take(self, count: int) -> Array:
        """The state that was come to, and those after 1, 2, .. ``count`` more steps."""
        states, self._terms = [self._start + self._beyond], []
        for _ in range(count):
            terms = taylor(self._M, states[-1], self._step)
            self._terms.append(terms)
            self._beyond = self._beyond + terms[1:].sum(axis=0)
            states.append(self._start + self._beyond)
        return np.array(states)

    def powers(self, states: Array) -> Array:
        """Of the steps from these states, those latest taken, the series of each row."""
        found = [self._rows @ terms.T for terms in self._terms[: len(states)]]
        return np.array(found)

    def inside(self, at: int, part: float) -> Array:
        """The state a part of a step after the one at a place among those latest taken."""
        terms = self._terms[at] * part ** np.arange(len(self._terms[at]))[:, None]
        return np.asarray(terms[::-1].sum(axis=0), dtype=float)


def taylor(M: Array, z: Array, step: float) -> Array:
    """``(M step)^k z / k!`` for each k, by rows: the terms of the state after a step."""
    terms = np.empty((TUNING.degree + 1, len(z)))
    terms[0] = z
    for k in range(1, TUNING.degree + 1):
        terms[k] = M @ terms[k - 1] * (step / k)
    return terms


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
