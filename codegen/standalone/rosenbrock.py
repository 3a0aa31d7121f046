"""Linearly implicit fixed steps, for stiff laws."""

import warnings
from collections.abc import Sequence

import numpy as np

from codegen.standalone.arrays import Array, EvaluationError, Mode
from codegen.standalone.evaluation import Point
from codegen.standalone.stepping import FixedSteps, Given
from codegen.tuning import TUNING

GAMMA = 0.25

WEIGHTS = (
    (),
    (3.0,),
    (1.831036793486759, 0.4955183967433795),
    (2.304376582692669, -0.05249275245743001, -1.176798761832782),
    (-7.170454962423024, -4.741636671481785, -16.31002631330971, -1.062004044111401),
    (-7.170454962423024, -4.741636671481785, -16.31002631330971, -1.062004044111401, 1.0),
)

COUPLES = (
    (),
    (-12.0,),
    (-8.791795173947035, -2.207865586973518),
    (10.81793056857153, 6.780270611428266, 19.53485944642410),
    (34.19095006749676, 15.49671153725963, 54.74760875964130, 14.16005392148534),
    (
        34.62605830930532,
        15.30084976114473,
        56.99955578662667,
        18.40807009793095,
        -5.714285714285717,
    ),
)

ALONG = (0.0, 0.75, 0.21, 0.63, 1.0, 1.0)

IN_TIME = (0.25, -0.5, -0.023504, -0.0362, 0.0, 0.0)


class Rosenbrock(FixedSteps):
    """Steps of RODASP: order 4, L-stable, stiffly accurate, with an embedded method of order 3.

    G. Steinebach, Order-reduction of ROW-methods for DAEs and method of lines applications,
    Preprint 1741, TH Darmstadt 1995. Each solves six linear systems with one matrix, whose slopes
    are differences: as many evaluations as there are states, one for the slope in time, and six.
    """

    implicit = True

    def step(self, t: float, h: float, s: Array, given: Sequence[Given], mode: Mode) -> Array:
        """One step in one mode; ``given``: inputs at start, middle, end.

        Warns where its error is beyond 1 % of the range of a state.
        """
        if not 0 < h < np.inf:
            raise ValueError(f"a step must be a positive finite number of seconds, not {h}")
        self.seen = np.maximum(self.seen, np.abs(s))
        now = self.at(Point(t, s, *given[0]), mode)
        self.noted(now, 0.5)
        self.fastest.weigh(self.form, now, h, s)
        system, in_time = self.slopes(t, h, s, given, mode, now.rate)
        stages, argument = np.zeros((len(ALONG), len(s))), s
        for k, (weights, couples) in enumerate(zip(WEIGHTS, COUPLES, strict=True)):
            argument = s + np.array(weights) @ stages[:k]
            rate = self.rate_along(t, h, argument, given, mode, ALONG[k])
            right = rate + np.array(couples) / h @ stages[:k] + IN_TIME[k] * h * in_time
            stages[k] = np.linalg.solve(system, right) if len(s) else right
        found: Array = argument + stages[-1]
        if not np.isfinite(found).all():
            raise EvaluationError(f"at t = {t:g} a step has no finite values")
        if self.is_inaccurate(found, stages[-1]):
            warnings.warn(
                f"at t = {t:g} the error of a step of {h:g} s is beyond 1 % of a state's range; "
                "give a shorter one",
                stacklevel=4,
            )
        return found

    def rate_along(
        self, t: float, h: float, s: Array, given: Sequence[Given], mode: Mode, part: float
    ) -> Array:
        """The rates a part of a step on, inputs by the parabola through their three values."""
        (first, rates), (middle, _), (last, ends) = given
        w = (1 - part) * (1 - 2 * part) * first + 4 * part * (1 - part) * middle
        w = w + part * (2 * part - 1) * last
        return self.at(Point(t + part * h, s, w, rates + part * (ends - rates)), mode).rate

    def slopes(
        self, t: float, h: float, s: Array, given: Sequence[Given], mode: Mode, rate: Array
    ) -> tuple[Array, Array]:
        """``1/(gamma h) - J``, and how rates change in time."""
        system = np.eye(len(s)) / (GAMMA * h)
        for j, step in enumerate(TUNING.difference * self.fastest.near):
            system[:, j] -= self.column(t, h, s, given, mode, rate, j, float(step))
        if not np.isfinite(system).all():
            raise EvaluationError(f"at t = {t:g} slopes of rates are not finite")
        later = t + TUNING.part_in_time * h
        beside = self.rate_along(t, h, s, given, mode, (later - t) / h)
        return system, (beside - rate) / (later - t)

    def column(
        self,
        t: float,
        h: float,
        s: Array,
        given: Sequence[Given],
        mode: Mode,
        rate: Array,
        j: int,
        step: float,
    ) -> Array:
        """How rates change with one state, by a difference to whichever side they have values."""
        for amount in (step, -step):
            beside = s.copy()
            beside[j] += amount
            try:
                moved = self.rate_along(t, h, beside, given, mode, 0.0)
            except ArithmeticError:
                continue
            return np.asarray((moved - rate) / (beside[j] - s[j]))
        raise EvaluationError(f"at t = {t:g} rates have no values beside the states")

    def is_inaccurate(self, s: Array, error: Array) -> bool:
        """Whether the error of a step is beyond its part of the range of a state."""
        weight, range_ = self.fastest.weight, np.maximum(self.seen, np.abs(s))
        least = TUNING.reach_part * np.linalg.norm(range_ * weight) + TUNING.reach_floor
        return not (np.abs(error) <= TUNING.range_part * (range_ + least / weight)).all()
