"""A model in fixed steps: rates, outputs, and one classical Runge-Kutta step in a bounded
time."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike as Values

from codegen.standalone.arrays import Array, Mode
from codegen.standalone.evaluation import Contact, Form, Point, evaluated, vector
from codegen.standalone.fastest import Fastest
from codegen.standalone.instant import Instant
from codegen.tuning import TUNING

CHECK_STEP = True
"""Whether each step is checked for stability, at two evaluations more."""

Chosen = Mode | None

Signal = Callable[[float], float]
"""An external input over the time."""

Given = tuple[Array, Array]
"""The external inputs and their rates at one time."""


@dataclass(frozen=True)
class Names:
    """Of states and external inputs; ``shown``: what a run shows beside them; the switches."""

    states: Sequence[str]
    external: Sequence[str]
    shown: Sequence[str]
    switches: Sequence[str] = ()


class FixedSteps:
    """A model in fixed steps without friction; x in the order of states, u in that of inputs."""

    implicit = False
    """Whether steps are linearly implicit."""

    def __init__(self, form: Form, names: Names, contact: Contact | None = None) -> None:
        self.form, self.names, self.contact, self.fastest = form, names, contact, Fastest()
        self.seen = np.zeros(form.states + len(form.law_rates))
        #: Whether it is asked how redundant ports share a load, which moves no state.
        self.sharing = True
        self._latest: tuple[tuple[object, ...], Instant] | None = None

    def rhs(
        self, t: float, x: Values, u: Values = (), du: Values | None = None, mode: Chosen = None
    ) -> Array:
        """The rates of the states; ``du``: rates of the inputs; ``mode``: decided if left out."""
        now = self.instant(t, x, u, du, mode)
        rate = now.rate.copy()
        if not self.form.varying:
            rate[: len(now.x)] += now.numbers.R @ now.du  # x' = xi' + A^-1 E u'
        return rate

    def outputs(
        self, t: float, x: Values, u: Values = (), du: Values | None = None, mode: Chosen = None
    ) -> dict[str, float]:
        """Every reading and every input of the equations by name, what laws give included."""
        return self.named(self.instant(t, x, u, du, mode))

    def named(self, now: Instant) -> dict[str, float]:
        """Readings and inputs of an instant by name."""
        names = (*self.form.readings, *self.form.inputs)
        return dict(zip(names, (*now.y.tolist(), *now.u.tolist()), strict=True))

    def instant(self, t: float, x: Values, u: Values, du: Values | None, mode: Chosen) -> Instant:
        """Every variable at given states and inputs."""
        w = np.array(u, dtype=float)
        dw = np.zeros(len(w)) if du is None else np.array(du, dtype=float)
        at = Point(t, vector(self.form, t, np.array(x, dtype=float), w, dw), w, dw)
        return self.at(at, self.decided(at, None, TUNING.still) if mode is None else tuple(mode))

    def at(self, at: Point, mode: Mode) -> Instant:
        """Every variable at one time: laws in turn, then friction as the mode says.

        The latest is kept: what decides a mode is a step's start as well, and what a run shows.
        """
        values = (one.tobytes() for one in (at.s, at.w, at.dw, self.seen))
        what = (at.t, mode, self.sharing, *values)
        if self._latest is None or self._latest[0] != what:
            with np.errstate(all="ignore"):
                now = evaluated(self.form, self.contact, at._replace(seen=self.seen), mode)
            self._latest = what, now
        return self._latest[1]

    @property
    def wanted(self) -> Sequence[str]:
        """The external inputs that a run is given: all of them."""
        return self.names.external

    def recalling(self, signals: list[Signal]) -> list[Signal]:
        """A function of time for each external input, of those for the wanted ones."""
        return signals

    def begin(self, at: Point, on: Collection[str], named: Collection[str]) -> Array:
        """The vector s with which a run begins; no port is a switch, or could be ``on``."""
        return at.s

    def until(self, t: float, end: float) -> float:
        """Where steps from t end at the latest, the end: there are no instants before."""
        return end

    def shown(self, mode: Mode) -> list[float]:
        """For each switch 1 while it is on, 0 while it is off: there are none."""
        return []

    def decided(self, at: Point, previous: Chosen, dead_band: float, h: float = 0.0) -> Mode:
        """The friction mode at the start of a step of h: no port can stick."""
        return ()

    def settled(
        self, at: Point, previous: Chosen, dead_band: float, h: float
    ) -> tuple[Mode, Array]:
        """The mode of a step of h, and s without the slips of the ports that stick."""
        return self.decided(at, previous, dead_band, h), at.s

    def advance(
        self, t: float, h: float, s: Array, given: Sequence[Given], mode: Mode
    ) -> tuple[Mode, Array]:
        """A step in one mode, and the mode at its end, where no port changes."""
        return mode, self.step(t, h, s, given, mode)

    def noted(self, now: Instant, part: float) -> None:
        """What ports give at an instant of a step: there are none."""

    def turned(self, now: Instant, mode: Mode) -> bool:
        """Whether a port slips against its mode, in the moment of a change."""
        return False

    def step(self, t: float, h: float, s: Array, given: Sequence[Given], mode: Mode) -> Array:
        """One classical Runge-Kutta step in one mode; ``given``: inputs at start, middle, end.

        Raises `UnstableStep` where h is beyond the method's stability.
        """
        if not 0 < h < np.inf:
            raise ValueError(f"a step must be a positive finite number of seconds, not {h}")
        start, middle, end = given
        now = self.at(Point(t, s, *start), mode)
        checked, k_1 = CHECK_STEP and len(s) > 0 and np.isfinite(now.rate).all(), now.rate
        if checked:

            def rates(beside: Array) -> Array:
                return self.at(Point(t, beside, *start), mode).rate

            self.fastest.check(self.form, now, h, s, rates, self.turned(now, mode))
        self.noted(now, 1 / 6)
        k_2 = self.stage(t + h / 2, s + h / 2 * k_1, middle, mode, 1 / 3)
        k_3 = self.stage(t + h / 2, s + h / 2 * k_2, middle, mode, 1 / 3)
        k_4 = self.stage(t + h, s + h * k_3, end, mode, 1 / 6)
        if checked:
            self.fastest.note(k_1, k_2, k_3)
        return s + h / 6 * (k_1 + 2 * k_2 + 2 * k_3 + k_4)

    def stage(self, t: float, s: Array, given: Given, mode: Mode, part: float) -> Array:
        """The rates at a stage of a step; ``part``: its weight in the mean of what ports give."""
        now = self.at(Point(t, s, *given), mode)
        self.noted(now, part)
        return now.rate
