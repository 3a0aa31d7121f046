"""Friction modes on trial: a mode in which the laws have no solution is none, and another is looked at."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from itertools import chain

import numpy as np
from scipy.integrate import quad

from bondgraph.errors import SimulationError
from codegen.inputs.pieces import Piece
from codegen.model.snapshot import Mode, Snapshot
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.ports.refusals import SlopeNeededError
from codegen.program.affine import ONE
from codegen.standalone.friction import ways
from codegen.standalone.striking import Strike
from codegen.tuning import TUNING


class Sight:
    """A model at one time with one integrated vector, which must not change; modes are looked at once."""

    def __init__(self, model: ClosedModel, t: float, s: Array, pieces: Sequence[Piece]) -> None:
        self.model, self.t, self.s, self.pieces = model, t, s, pieces
        self._shots: dict[Mode, Snapshot] = {}
        self._vector: Array | None = None

    @property
    def vector(self) -> Array:
        """What affine modes are maps of: the integrated vector, inputs, their rates, and 1."""
        if self._vector is None:
            given = self.model.given(self.t, self.pieces)
            self._vector = np.concatenate((self.s, *given, ONE))
        return self._vector

    def at(self, mode: Mode) -> Snapshot:
        """Everything in a mode; raises `SimulationError` where there are no values."""
        if mode not in self._shots:
            self._shots[mode] = self.model.at(self.t, self.s, self.pieces, mode)
        return self._shots[mode]

    def evaluated(self, mode: Mode, slipping: bool = True) -> tuple[Mode, Snapshot]:
        """The model with friction slipping as in ``mode``, ports that stick forwards; if need be, otherwise.

        ``slipping``: unless it is set, the mode itself comes first.
        A level that grows with what the port gives (a self-locking gear) may have no solution one way.
        Raises the `SimulationError` of the first try if no mode can be evaluated.
        """
        refused: SimulationError | None = None
        for tried in ways(mode) if slipping else chain((mode,), ways(mode)):
            try:
                return tried, self.at(tried)
            except SlopeNeededError:
                raise
            except SimulationError as error:
                refused = refused or error
        raise refused or SimulationError("there is no mode")


def taken(here: Sight, before: Snapshot, after: Snapshot, strike: Strike) -> float:
    """What ports take of energy as they give these impulses [J]: what storages then hold less.

    An impulse works on the mean of what its port receives before and after, where momenta are linear;
    else what a chord leaves out of their integral is beside that.
    """
    model = here.model
    mean = 0.5 * (before.y + after.y)[model.friction_readings]
    work = float(strike.given[model.friction_inputs] @ mean)
    now, way = before.instant(here.t), after.x - before.x

    def along(part: float) -> float:
        held = model.momenta(replace(now, x=before.x + part * way))
        return 0.0 if held is None else float(way @ held)

    if model.momenta(now) is None:
        return work
    whole, _ = quad(along, 0.0, 1.0, epsabs=0.0, epsrel=TUNING.bent)
    return work + float(whole) - 0.5 * (along(0.0) + along(1.0))


def hung_rounding(here: Sight, now: Snapshot) -> Mapping[int, float]:
    """Below these what jumps of second order hang on counts as zero: of what it has been, and of the time."""
    model = here.model
    if not model.hung:
        return {}
    sizes = np.append(model.largest(here.s), 1.0)
    terms, late = np.abs(model.hung_rows(now)) @ sizes, TUNING.late * np.spacing(abs(here.t))
    rates = np.abs(now.y[[model.friction_readings[i] for i in model.hung]])
    near = TUNING.together * terms + late * rates + np.finfo(float).tiny
    return dict(zip(model.hung, near.tolist(), strict=True))


def sides(here: Sight, mode: Mode, loose: Collection[int] = ()) -> Mapping[int, int]:
    """On which sides jumps of second order are, but for those at their jump; ``loose``: about there."""
    model, found = here.model, dict[int, int]()
    if not model.hung:
        return found
    now = here.at(mode)
    gaps = model.guards(here.t, now)
    for i, near in hung_rounding(here, now).items():
        gap = float(gaps[model.hung[i]])
        if abs(gap) > (TUNING.wide if i in loose else 1.0) * near:
            found[i] = 1 if gap > 0 else -1
    return found
