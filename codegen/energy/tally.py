"""What is accumulated during a run: integrals of products of signals, and what jumps took."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import quad

from codegen.energy.quadrature import NODES, WEIGHTS, exact_integrals, gauss_sum, rows_over
from codegen.inputs.generators import generator
from codegen.inputs.pieces import Piece, constant_piece
from codegen.model.snapshot import Impact, Mode, Run, Snapshot
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.program.layout import RATE
from codegen.tuning import TUNING

Dense = Callable[[float | Array], Array]


@dataclass
class Tally:
    """Integrals of pairs of signals through one run of a model, by their places in a snapshot.

    ``other``: the second signal of each product, None for a product with nothing. ``stored``: which of
    the products are those of storages. ``held``: the energies
    of storages as a function of time and snapshot. ``total``: the integrals so far; ``taken``: what
    ports that came to rest and impacts took from the storages. ``bent``: of products of storages whose laws
    are turned round the place of what rules them, and what they hold by that. ``rows``: both at each sample,
    at a step or an event just after it. ``renewed``: what resets took from the storages.
    """

    model: ClosedModel
    one: Sequence[int]
    other: Sequence[int | None]
    stored: Array
    held: Callable[[float, Snapshot], float]
    times: Array
    bent: Mapping[int, tuple[int, Callable[[float], float]]] = field(default_factory=dict)
    total: Array = field(init=False)
    taken: float = 0.0
    renewed: float = 0.0
    rows: list[Array] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.total = np.zeros(len(self.one))

    def within(self, run: Run) -> None:
        """The run that it goes with."""
        self.model = self.model.within(run)

    def smooth(
        self, begin: float, end: float, dense: Dense, pieces: Sequence[Piece], mode: Mode
    ) -> None:
        """A step of an integrator, with its interpolant."""
        while self._next < end:
            cut = self._next
            self._gauss(begin, cut, dense, pieces, mode)
            self.record()
            begin = max(begin, cut)
        self._gauss(begin, end, dense, pieces, mode)

    def exact(self, pieces: Sequence[Piece], mode: Mode, points: Array, vectors: Array) -> None:
        """A stretch of an affine mode: from the first point by way of samples to the last, with s at each."""
        made = generator(pieces, float(points[0]))
        affine = self.model.affine_map(mode, len(pieces))
        assert affine is not None
        n, fed = vectors.shape[1], np.vstack([made.C, made.C @ made.G, np.eye(1, len(made.G))])

        def over_z(rows: Array) -> Array:
            return np.hstack([rows[:, :n], rows[:, n:] @ fed])

        ends = np.maximum.accumulate(points)
        M = np.vstack([
            over_z(affine.rows(RATE)), np.hstack([np.zeros((len(made.G), n)), made.G])
        ])  # fmt: skip
        shown = np.vstack([affine.matrix, np.eye(len(pieces), affine.matrix.shape[1], n)])
        nothing = np.eye(1, affine.matrix.shape[1], affine.matrix.shape[1] - 1)
        shown, last = np.vstack([shown, nothing]), len(affine.matrix)
        places = [p if p >= 0 else last - 1 - p for p in self.one]
        others = [-1 if p is None else p if p >= 0 else last - 1 - p for p in self.other]
        rows = rows_over(M, over_z(shown[places]), over_z(shown[others]))
        z = np.hstack([vectors, made.at(ends - points[0])])
        found = exact_integrals(rows, z[:-1], np.diff(ends))
        for k, part in enumerate(found):
            self.total = self.total + part
            if k < len(found) - 1:
                self.record()

    def step(
        self, t: float, before: Sequence[Piece], after: Sequence[Piece], s: Array, mode: Mode
    ) -> None:
        """Inputs that step at t: the impulses by which sources set dependent storages in motion.

        An impulse works as a short ramp would: where values stay, on the mean of before and after.
        """
        slipping = tuple(sign or 1 for sign in mode)
        a, b = (self.model.at(t, s, pieces, slipping) for pieces in (before, after))
        readings, moved = len(b.x) + len(b.z) + 2 * len(b.u), b.u - a.u
        ends = [(first(t), last(t)) for first, last in zip(before, after, strict=True)]
        varying = self.model.program.varying
        for node, weight in zip(NODES, WEIGHTS, strict=True) if varying else ((0.5, 1.0),):
            there = [constant_piece(t, first + node * (last - first)) for first, last in ends]
            c = self.model.at(t, s, there, slipping)
            impulses = np.zeros(_length(c))
            impulses[readings : readings + len(c.y)] = weight * (c.numbers.G @ moved)
            if not impulses.any():
                continue
            one, other = self._pair(vector_of(c))
            pushed, turned = self._pair(impulses)
            self.total = self.total + one * turned * self._double + pushed * other

    def impact(
        self, t: float, pieces: Sequence[Piece], mode: Mode, before: Array, struck: Impact
    ) -> None:
        """Switches that come to hold: impulses, and what the impact took.

        An impulse works on what there is after it; in storages on the mean of before and after. At ports that
        give it, it is all of what the impact took, also where they throw back. What a nonlinear storage takes
        is the integral over what it holds.
        """
        slipping = tuple(sign or 1 for sign in mode)
        a = self.model.at(t, before, pieces, slipping)
        b = self.model.at(t, struck.s, pieces, slipping)
        jump = np.zeros(_length(b))
        inputs = len(b.x) + len(b.z)
        readings = inputs + 2 * len(b.u)
        jump[inputs : inputs + len(b.u)] = struck.strike.given
        jump[readings : readings + len(b.y)] = struck.strike.received
        past, now = vector_of(a), vector_of(b).copy()
        hit = struck.strike.given[self.model.friction_inputs] != 0
        now[readings + np.asarray(self.model.friction_readings)[hit]] = 0.0
        one, other = (
            np.where(self.stored, (early + late) / 2, late)
            for early, late in zip(self._pair(past), self._pair(now), strict=True)
        )
        pushed, turned = self._pair(jump)
        worked = one * turned * self._double + pushed * other
        for k, (place, holds) in self.bent.items():
            worked[k] = _worked(holds, float(past[place]), float(now[place]))
        self.total = self.total + worked
        self.taken += struck.taken

    def rest(
        self, t: float, pieces: Sequence[Piece], mode: Mode, before: Array, after: Array
    ) -> None:
        """Ports that came to rest at t, which takes their slips' energy."""
        if before is after:
            return
        slipping = tuple(sign or 1 for sign in mode)
        a, b = (self.held(t, self.model.at(t, s, pieces, slipping)) for s in (before, after))
        self.taken += a - b

    def reset(
        self, t: float, pieces: Sequence[Piece], mode: Mode, before: Array, after: Array
    ) -> None:
        """States that were reset at t, which takes what storages hold less by that."""
        slipping = tuple(sign or 1 for sign in mode)
        a, b = (self.held(t, self.model.at(t, s, pieces, slipping)) for s in (before, after))
        self.renewed += a - b

    def record(self) -> None:
        """The next sample."""
        self.rows.append(np.append(self.total, (self.taken, self.renewed)))

    def unrecord(self, count: int) -> None:
        """Forget samples beyond so many."""
        del self.rows[count:]

    @property
    def _next(self) -> float:
        return float(self.times[len(self.rows)]) if len(self.rows) < len(self.times) else np.inf

    @property
    def _double(self) -> Array:
        return np.array([p is not None for p in self.other], dtype=float)

    def _gauss(
        self, begin: float, end: float, dense: Dense, pieces: Sequence[Piece], mode: Mode
    ) -> None:
        if end <= begin:
            return
        times = begin + (end - begin) * NODES
        states = dense(times)
        pairs = [
            self._pair(vector_of(self.model.at(t, s, pieces, mode)))
            for t, s in zip(times.tolist(), states.T, strict=True)
        ]
        values = np.array([one * other for one, other in pairs]).T
        self.total = self.total + gauss_sum(values, end - begin)

    def _pair(self, vector: Array) -> tuple[Array, Array]:
        """The factors of each product; external inputs stand last, from the end."""
        others = [1.0 if p is None else vector[p] for p in self.other]
        return vector[list(self.one)], np.array(others)


def _worked(holds: Callable[[float], float], before: float, after: float) -> float:
    """The integral of what rules a storage over what it holds by that, from one value to another."""
    if before == after:
        return 0.0
    under, _ = quad(holds, before, after, epsabs=0.0, epsrel=TUNING.bent)
    return after * holds(after) - before * holds(before) - float(under)


def vector_of(now: Snapshot) -> Array:
    """A snapshot in the order of `places`; the external inputs from the end backwards."""
    return np.concatenate((now.x, now.z, now.u, now.du, now.y, now.external[::-1]))


def _length(now: Snapshot) -> int:
    return sum(map(len, (now.x, now.z, now.u, now.du, now.y, now.external)))
