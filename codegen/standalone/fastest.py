"""The fastest rates of a model, followed from step to step, and steps that they make unstable.

A rate l is stable under a step h of Runge's and Kutta's classical method of fourth order while
``|R(h l)| <= 1``, ``R(z) = 1 + z + z^2/2 + z^3/6 + z^4/24``: up to ``h l = -2.7853`` on the real
axis and ``2.8284i`` on the imaginary one (Hairer and Wanner, Solving Ordinary Differential
Equations II, section IV.2).
"""

import cmath
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from codegen.standalone.arrays import Array
from codegen.standalone.evaluation import Form
from codegen.standalone.instant import Instant
from codegen.standalone.matrices import scales
from codegen.tuning import TUNING

REAL_LIMIT, IMAGINARY_LIMIT = 2.785293563405282, 2.0 * math.sqrt(2.0)
"""How far the stable part of the negative real axis and of the imaginary one reaches."""

NEAREST, FARTHEST = 2.6156, 2.9603
"""The least and the largest distance of the boundary in the left half plane."""

LINEAR_ROUNDS = 8
"""Rounds by storages and resistances alone before the first verdict, which ask for no rates."""

REFUSED_ROUNDS = 16
"""Rounds of two evaluations before a refusal."""

AVERAGED = 8
"""Rounds in the mean growth."""

Rates = Callable[[Array], Array]
"""The rates of the integrated vector at a vector; raises `ArithmeticError` where there are none."""


Look = Callable[[float], "Round | None"]


def stable_step(rate: complex) -> float:
    """The longest stable step [s] for one rate of the linearised model [1/s].

    What grows by itself, at a rate of positive real part, is no fault of the step; it must not turn
    too far.

    >>> round(stable_step(-10), 5), round(stable_step(10j), 5), stable_step(3)
    (0.27853, 0.28284, inf)
    """
    if rate.real >= 0:
        return IMAGINARY_LIMIT / abs(rate.imag) if rate.imag else math.inf
    ray = rate / abs(rate)
    low, high = NEAREST - TUNING.bracket, FARTHEST + TUNING.bracket
    for _ in range(50):
        middle = (low + high) / 2
        z = middle * ray
        if abs(1 + z * (1 + z / 2 * (1 + z / 3 * (1 + z / 4)))) > 1:
            high = middle
        else:
            low = middle
    return low / abs(rate)


class UnstableStep(ArithmeticError):
    """A step beyond the stability of its method."""


@dataclass
class Round:
    """Two products: ``r^2 = a r + b`` for the fastest rates r, what that leaves, and its doubt.

    ``twice``: the direction after both; ``growth``: what each stretches it by, in the mean.
    """

    twice: Array
    a: float = 0.0
    b: float = 0.0
    left: float = 0.0
    doubt: float = 0.0
    growth: float = 0.0


class Fastest:
    """The fastest rates of a model, followed by two products a step of their slopes J.

    A direction is kept from step to step; what J does to it twice is fitted by what J does once, so
    that pairs of complex rates are seen as well as real ones. ``weight``: by these states of any
    unit compare; a law's state is weighed by the most that energy can drive it, at the rate of the
    limit. ``metric``: the product in which a change's square is twice its energy, which what
    conserves energy does not stretch.
    """

    def __init__(self) -> None:
        self.direction = self.weight = self.near = np.zeros(0)
        self.metric = np.zeros((0, 0))
        self.growth, self.rounds, self.noise = 0.0, 0, 0

    def check(
        self, form: Form, now: Instant, h: float, s: Array, rates: Rates, turned: bool
    ) -> None:
        """Refuse a step of h from an instant that is beyond the method's stability.

        ``turned``: whether friction slips against its mode, in the moment of a change.
        """
        self.weigh(form, now, h, s)

        def look(amount: float) -> Round | None:
            return self.look(now, s, rates, amount)

        if not len(self.direction):
            self.keep(np.zeros(len(s)), 0.0)
            self.follow_storages(now.numbers.P)
            self.keep(self.direction, 0.0)
        found = look(TUNING.difference)
        if found is None:
            return
        longest = h if turned else self.longest(found, h)
        if longest < h:
            longest = self.confirmed(look, found, longest, h)
        else:
            self.keep(found.twice, found.growth)
        if longest < h:
            raise UnstableStep(
                f"at t = {now.t:g} a step of {h:g} s is beyond the stability of its method at the "
                f"model's fastest rates; the longest stable step is {longest:.4g} s there"
            )

    def follow_storages(self, P: Array) -> None:
        """Turn the kept direction as storages and resistances alone would."""
        n, weight = len(P), self.weight[: len(P)]
        for _ in range(LINEAR_ROUNDS):
            turned = self.direction.copy()
            turned[:n] = weight * (P @ (self.direction[:n] / weight))
            size = self.size(turned)
            if not size > 0:
                return
            self.direction = turned / size

    def go_on(self, look: Look, rounds: int) -> Round | None:
        """Rounds that give no verdict; what the last has found, None without values beside s."""
        found = None
        for _ in range(rounds):
            found = look(TUNING.difference)
            if found is None:
                return None
            self.keep(found.twice, found.growth)
        return found

    def confirmed(self, look: Look, found: Round, longest: float, h: float) -> float:
        """A second look, to the other side and farther: a jump has other slopes, and no limit."""
        again = look(-TUNING.farther * TUNING.difference)
        if again is None or again.growth < 0.5 * found.growth or not self.longest(again, h) < h:
            return h
        finer = self.go_on(look, REFUSED_ROUNDS)
        return longest if finer is None else min(longest, self.longest(finer, h))

    def weigh(self, form: Form, now: Instant, h: float, s: Array) -> None:
        """Weights of the states, and the magnitudes that differences are small against."""
        A, n = now.numbers.A, form.states
        scale, rows = scales(A), now.numbers.F[form.law_rates]
        driven: Array = np.sqrt(
            np.maximum(np.sum(rows * np.linalg.solve(A, rows.T).T, axis=1), 0.0)
        )
        own = REAL_LIMIT / (h * np.where(driven > 0, driven, REAL_LIMIT / h))
        self.weight = np.append(1 / scale, own)
        self.metric = np.eye(len(s))
        if (np.diag(A) > 0).all():
            self.metric[:n, :n] = A * np.outer(scale, scale)
        moved = np.abs(s) + h * np.abs(now.rate)
        self.near = (
            moved
            + (TUNING.reach_part * np.linalg.norm(moved * self.weight) + TUNING.reach_floor)
            / self.weight
        )

    def size(self, change: Array) -> float:
        """The square root of twice the energy of a change that is times the weights."""
        return math.sqrt(max(float(change @ self.metric @ change), 0.0))

    def slope(
        self, now: Instant, s: Array, rates: Rates, amount: float, direction: Array
    ) -> Array | None:
        """J times a direction, by a difference; None where the rates have no values beside s."""
        most = float(np.max(np.abs(direction) / (self.weight * self.near)))
        for d in (amount / most, -amount / most) if most > 0 else ():
            try:
                moved = rates(s + d * direction / self.weight)
            except ArithmeticError:
                continue
            image: Array = (moved - now.rate) / d * self.weight
            if np.isfinite(image).all():
                return image
        return None if most > 0 else np.zeros(len(s))

    def look(self, now: Instant, s: Array, rates: Rates, amount: float) -> Round | None:
        """Both products; None where the rates have no values beside s."""
        start = self.direction
        once = self.slope(now, s, rates, amount, start)
        if once is None or (first := self.size(once)) == 0:
            return None if once is None else Round(start)
        once = once / first
        twice = self.slope(now, s, rates, amount, once)
        if twice is None or (second := self.size(twice)) == 0:
            return None if twice is None else Round(twice)
        return self.fitted(start, once, twice / second, first, second)

    def fitted(self, start: Array, once: Array, twice: Array, first: float, second: float) -> Round:
        """What two products of these sizes tell of the rates; directions are of length 1."""
        c, along, back = (
            float(one @ self.metric @ other)
            for one, other in ((once, start), (twice, once), (twice, start))
        )
        a, b, sine = along, 0.0, 1 - c * c
        if sine > TUNING.sine**2:
            a, b = (along - c * back) / sine, (back - c * along) / sine
        left = self.size(twice - a * once - b * start)
        a, b = second * a, second * first * b
        # Roots move by the error over their distance; double ones by its square root.
        root, sizes = abs(a * a / 4 + b), a * a / 4 + abs(b)
        doubt = min(left * sizes / (2 * root) if root > 0 else 1.0, 2 * left**0.5)
        return Round(twice, a, b, left, doubt, float(np.sqrt(first * second)))

    def longest(self, found: Round, h: float) -> float:
        """The longest stable step by a fit, or by the mean growth; h if nothing is against it."""
        if found.left <= TUNING.unexplained:
            root = cmath.sqrt(found.a**2 / 4 + found.b)
            if h * (abs(found.a) / 2 + abs(root)) < NEAREST:
                return h  # no root is larger
            step = min(stable_step(found.a / 2 - root), stable_step(found.a / 2 + root))
            return step if h > step * (1 + found.doubt) else h
        grown = min(float(np.exp(self.growth)), found.growth)
        return NEAREST / grown if self.rounds >= AVERAGED and h * grown > 1.05 * FARTHEST else h

    def keep(self, direction: Array, growth: float) -> None:
        """Go on from a direction, and a little of every other, so that none is ever lost."""
        stir = np.empty(len(direction))
        for i in range(len(stir)):
            self.noise = (1664525 * self.noise + 1013904223) % 2**32
            stir[i] = self.noise / 2**31 - 1
        direction = direction + TUNING.stirred * stir / self.size(stir)
        self.direction = direction / self.size(direction)
        if growth > 0:
            self.rounds = min(self.rounds + 1, AVERAGED)
            self.growth += (float(np.log(growth)) - self.growth) / self.rounds

    def note(self, k_1: Array, k_2: Array, k_3: Array) -> None:
        """What stages at one instant tell for nothing: look next where they move fast."""
        with np.errstate(all="ignore"):
            before = self.size((k_2 - k_1) * self.weight)
            seed = (k_3 - k_2) * self.weight
            after = self.size(seed)
        if 0 < before < np.inf and 0 < after < np.inf:
            part = 0.0 if 2 * after > NEAREST * before else 1 / TUNING.seeded
            direction = part * self.direction + seed / after
            self.direction = direction / self.size(direction)
