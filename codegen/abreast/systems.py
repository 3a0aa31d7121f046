"""A mode of many runs with its inputs' generator as linear systems, stepped over arrays.

Stacks are multiplied matrix by matrix, so that what one run comes to does not rest on the others.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from codegen.abreast.modes import ModeMap
from codegen.inputs.generators import Generator
from codegen.inputs.polynomials import to_bernstein
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array, Flags, dot
from codegen.program.affine import balanced_norm
from codegen.program.layout import CAPS, INPUTS, RATE, READINGS
from codegen.runs.watched import exponential, over_z, series
from codegen.standalone.arrays import Places
from codegen.tuning import TUNING


@dataclass(frozen=True)
class Systems:
    """``z' = M z`` of each run, with rows over z of its triggers; ``ports``: whose each is, in all runs."""

    M: Array
    triggers: Array
    #: Of the levels of friction; of no rows where there are none.
    caps: Array
    ports: tuple[int, ...]
    #: Bounds on |M| of each run.
    norms: Array

    def part(self, of: Flags) -> "Systems":
        """Those of some of the runs."""
        rows = (self.M[of], self.triggers[of], self.caps[of])
        return Systems(*rows, self.ports, self.norms[of])


def systems(model: ClosedModel, found: ModeMap, at: Places, made: Generator, mode: Mode) -> Systems:
    """Those of the runs at these places; ``made``: what gives the external inputs that they share.

    The triggers are those of `runs.watched`: slips, and what is left of breakaway efforts both ways.
    """
    n, G = model.size, made.G
    rows, part = over_z(found.maps.matrix[at], made, n), found.maps.parts
    M = np.zeros((len(at), n + len(G), n + len(G)))
    M[:, :n], M[:, n:, n:] = rows[:, part[RATE]], G
    caps = rows[:, part[CAPS]]
    efforts = rows[:, part[INPUTS]][:, model.friction_inputs]
    slips = rows[:, part[READINGS]][:, model.friction_readings]
    triggers, ports = list[Array](), list[int]()
    for i, sign in enumerate(mode):
        own = [sign * slips[:, i]]
        if not sign:
            own = [caps[:, i] - efforts[:, i], caps[:, i] + efforts[:, i]]
        triggers += own
        ports += [i] * len(own)
    watched = np.stack(triggers, axis=1) if triggers else np.zeros((len(at), 0, M.shape[1]))
    # Inputs drive states and not the other way: scaled far enough, that counts for nothing.
    norms = np.maximum(found.norms[at], balanced_norm(G))
    return Systems(M, watched, caps, tuple(ports), norms)


class Strides:
    """Steps of the runs at these places of a group; ``steps`` [s]: of each so long, ``|M| step <= 1``."""

    def __init__(self, system: Systems, steps: Array, places: Places) -> None:
        self.steps = steps
        self._M, self._rows = system.M[places], system.triggers[places]
        leap, self._gather = exponential(self._M, steps[:, None, None])
        self._powers = [np.ascontiguousarray(leap.transpose(0, 2, 1))]

    @cached_property
    def powers(self) -> Array:
        """Rows over the states of the triggers' series: powers, runs, triggers, components."""
        return series(self._M, self._rows, self.steps[:, None, None])

    @cached_property
    def _shapes(self) -> Array:
        """What takes states to the Bernstein coefficients of their triggers over a step."""
        count, runs, rows, size = self.powers.shape
        by_run = self.powers.transpose(1, 0, 2, 3).reshape(runs, count, -1)
        found = (to_bernstein(TUNING.degree) @ by_run).reshape(runs, count, rows, size)
        # Runs, components, triggers by coefficients.
        return np.ascontiguousarray(found.transpose(0, 3, 2, 1)).reshape(runs, size, -1)

    def shapes(self, states: Array) -> Array:
        """Bernstein coefficients of the triggers over a step from each state: runs, steps, those."""
        return np.asarray(states @ self._shapes)

    def noise(self, states: Array) -> Array:
        """Below these triggers may be rounding after a first step: of their terms, or of their rows."""
        sizes = np.abs(states[:, 1])
        terms, least = dot(np.abs(self._rows), sizes), sizes.max(axis=1, keepdims=True)
        return np.asarray(np.maximum(TUNING.rounding * terms, np.finfo(float).eps * least))

    def change(self, z: Array) -> Array:
        """What a first step changes."""
        return dot(self._gather, dot(self._M, z))

    def keep(self, left: Flags) -> None:
        """Go on with some of the runs."""
        self._M, self.steps, self._rows = self._M[left], self.steps[left], self._rows[left]
        self._powers = [power[left] for power in self._powers]
        if "powers" in self.__dict__:
            self.__dict__["powers"] = self.powers[:, left]
            self.__dict__["_shapes"] = self._shapes[left]

    def take(self, change: Array, count: int) -> tuple[Array, Array]:
        """What 0, 1, .. ``count`` steps add up to, of which the first makes a change, and that of the next.

        As `runs.watched.Steps`: told from one state, so that nothing large is rounded in every step. Of sums
        ``S_k`` of the first changes is ``S_(m + k) = S_m + P^m S_k``.
        """
        rows = np.empty((len(change), count + 1, change.shape[1]))
        rows[:, 0], rows[:, 1] = 0.0, change
        done, level = 1, 0
        while done < count:
            more, power = min(done, count - done), self._power(level)
            np.matmul(rows[:, 1 : 1 + more], power, out=rows[:, 1 + done : 1 + done + more])
            rows[:, 1 + done : 1 + done + more] += rows[:, done, None]
            done, level = done + more, level + 1
        after, level = change[:, None], 0
        while count >> level:
            after = after @ self._power(level) if count >> level & 1 else after
            level += 1
        return rows, after[:, 0]

    def _power(self, level: int) -> Array:
        """What takes states, by rows, ``2^level`` steps farther."""
        while level >= len(self._powers):
            self._powers.append(self._powers[-1] @ self._powers[-1])
        return self._powers[level]


def parts_of_steps(M: Array, states: Array, parts: Array) -> Array:
    """Each run's state after a part of a step [s], by its Taylor series."""
    terms = [states]
    for k in range(1, TUNING.degree + 1):
        terms.append(dot(M, terms[-1]) * (parts[:, None] / k))
    total = terms[-1]
    for term in terms[-2::-1]:
        total = total + term
    return total
