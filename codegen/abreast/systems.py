"""A mode of many runs with its inputs' generator as linear systems, stepped over arrays."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy

from codegen.inputs.generators import Generator
from codegen.inputs.polynomials import to_bernstein
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array, dot
from codegen.program.affine import AffineMap
from codegen.program.layout import CAPS, INPUTS, RATE, READINGS
from codegen.runs.watched import exponential, over_z, series
from codegen.tuning import TUNING


@dataclass(frozen=True)
class Systems:
    """``z' = M z`` of each run, with rows over z of its triggers; ``ports``: whose each is, in all runs."""

    M: Array
    triggers: Array
    #: Of the levels of friction; of no rows where there are none.
    caps: Array
    ports: tuple[int, ...]
    #: Bounds on |M| in a norm in which that of the first run is balanced.
    norms: Array


def systems(
    model: ClosedModel, maps: AffineMap, at: Array, made: Generator, mode: Mode
) -> Systems:
    """Those of the runs at these places; ``made``: what gives the external inputs that they share.

    The triggers are those of `runs.watched`: slips, and what is left of breakaway efforts both ways.
    """
    n, G = model.size, made.G
    rows = over_z(maps.matrix[at], made, n)
    part = maps.parts
    M = np.zeros((len(at), n + len(G), n + len(G)))
    M[:, :n], M[:, n:, n:] = rows[:, part[RATE]], G
    caps = rows[:, part[CAPS]]
    efforts = rows[:, part[INPUTS]][:, model.friction_inputs]
    slips = rows[:, part[READINGS]][:, model.friction_readings]
    triggers, ports = list[Array](), list[int]()
    for i, sign in enumerate(mode):
        own = [sign * slips[:, i]] if sign else [caps[:, i] - efforts[:, i], caps[:, i] + efforts[:, i]]
        triggers += own
        ports += [i] * len(own)
    watched = np.stack(triggers, axis=1) if triggers else np.zeros((len(at), 0, M.shape[1]))
    return Systems(M, watched, caps if caps.any() else caps[:, :0], tuple(ports), _norms(M))


def _norms(M: Array) -> Array:
    _, (scale, _) = scipy.linalg.matrix_balance(M[0], permute=False, separate=True)
    sizes = np.abs(M) * scale / scale[:, None]
    return np.minimum(sizes.sum(axis=1).max(axis=1), sizes.sum(axis=2).max(axis=1))


class Strides:
    """Steps of the runs of a group; ``steps`` [s]: of each so long, ``|M| step <= 1``."""

    def __init__(self, system: Systems, steps: Array, places: Array) -> None:
        M = system.M[places]
        self._M, self._steps = M, steps[:, None, None]
        self._leap, self._gather = exponential(M, self._steps)
        self._squares = [np.ascontiguousarray(self._leap.transpose(0, 2, 1))]
        self._rows = system.triggers[places]

    @cached_property
    def _shapes(self) -> Array:
        """What takes states to the Bernstein coefficients of their triggers over a step."""
        found = np.tensordot(to_bernstein(TUNING.degree), self.powers, 1)
        # Runs, components, triggers by coefficients.
        found = found.transpose(1, 3, 2, 0)
        return np.ascontiguousarray(found).reshape(*found.shape[:2], -1)

    @cached_property
    def powers(self) -> Array:
        """Rows over the states of the triggers' series: powers, runs, triggers, components."""
        return series(self._M, self._rows, self._steps)

    def shapes(self, states: Array) -> Array:
        """Bernstein coefficients of the triggers over a step from each state: runs, steps, those."""
        found: Array = states @ self._shapes
        return found

    def begun(self, z: Array) -> tuple[Array, Array]:
        """Nothing beyond z, and the change of a first step."""
        return np.zeros_like(z), dot(self._gather, dot(self._M, z))

    def keep(self, left: Array) -> None:
        """Go on with some of the runs."""
        self._M, self._steps, self._rows = self._M[left], self._steps[left], self._rows[left]
        self._squares = [square[left] for square in self._squares]
        for name, axis in (("_shapes", 0), ("powers", 1)):
            if name in self.__dict__:
                self.__dict__[name] = np.compress(left, self.__dict__[name], axis)

    def take(self, change: Array, count: int) -> tuple[Array, Array]:
        """What 0, 1, .. ``count`` steps add up to, of which the first makes a change, and that of the next.

        As `runs.watched.Steps`: told from one state, so that nothing large is rounded in every step. Of sums
        ``S_k`` of the first changes is ``S_(m + k) = S_m + P^m S_k``.
        """
        rows = np.empty((len(change), count + 1, change.shape[1]))
        rows[:, 0], rows[:, 1] = 0.0, change
        done, level = 1, 0
        while done < count:
            more = min(done, count - done)
            power = self._power(level)
            np.matmul(rows[:, 1 : 1 + more], power, out=rows[:, 1 + done : 1 + done + more])
            rows[:, 1 + done : 1 + done + more] += rows[:, done, None]
            done, level = done + more, level + 1
        after, level = change[:, None], 0
        while count >> level:
            if count >> level & 1:
                after = after @ self._power(level)
            level += 1
        return rows, after[:, 0]

    def _power(self, level: int) -> Array:
        """What takes states, by rows, so many times two steps farther."""
        while level >= len(self._squares):
            self._squares.append(self._squares[-1] @ self._squares[-1])
        return self._squares[level]


def parts_of_steps(M: Array, states: Array, steps: Array) -> Array:
    """Each run's state after a part of a step, by its Taylor series."""
    total = term = states
    terms = [term]
    for k in range(1, TUNING.degree + 1):
        term = dot(M, term) * (steps[:, None] / k)
        terms.append(term)
    total = terms[-1]
    for term in terms[-2::-1]:
        total = total + term
    return total
