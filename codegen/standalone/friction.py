"""Friction ports in numbers: against the slip, or whatever holds."""

from collections.abc import Callable, Hashable, Iterator, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from codegen.standalone.arrays import Array, EvaluationError, HoldError, Mode, Places
from codegen.standalone.evaluation import Correction, Form, Laws
from codegen.standalone.holding import HeldSet, Hold, hold
from codegen.standalone.instant import Formula, Instant
from codegen.standalone.levels import level_terms, without_rounding
from codegen.standalone.matrices import Numbers
from codegen.tuning import TUNING


@dataclass(frozen=True)
class Ports:
    """Friction ports: names, inputs they give, slips they receive, and what holds sets of them.

    ``received``: the slips as the graph has them, where ``readings`` are along tangents of laws.
    ``moving``: for each port the reading that tells how fast the slip changes by its factors, or -1
    where these are constant. ``beside``: whether a slip depends at once on friction, or on laws
    that friction moves. ``held``: from a set of sticking ports to its ranks. ``values``: level,
    breakaway effort, curve, and curve at rest of each. ``exact``: whether the ranks were decided
    for the numbers used.
    """

    names: Sequence[Hashable]
    inputs: Places
    readings: Places
    received: Places
    moving: Places
    beside: Sequence[bool]
    held: Callable[[tuple[int, ...]], HeldSet]
    values: Formula
    exact: bool


MOST_KEPT = 64
"""Sets of sticking ports whose holding equations are kept."""

MOST_SLIPPING = 10
"""Up to so many ports all ways of slipping are tried where laws have no solution one way."""


class Friction:
    """What friction ports give in a mode: ``level * curve(|slip|) * sign(slip)``, or what holds.

    ``coupled``: laws that depend on what they give.
    """

    def __init__(self, ports: Ports, form: Form, *coupled: Laws) -> None:
        self.ports, self.form = ports, form
        #: Whether it is asked how redundant ports share a load, which moves no state.
        self.sharing = True
        self._holds: dict[tuple[int, ...], Hold] = {}
        self._ranks: dict[tuple[int, ...], HeldSet] = {}
        self._laws = (form.known, *form.laws, *coupled)
        self._rated = {*form.given, *form.known.inputs, *ports.inputs, *form.beyond}

    @property
    def judge(self) -> "Friction":
        """By whose laws levels are checked."""
        return self

    def __call__(self, now: Instant, mode: Mode, checked: bool) -> Correction:
        """Complete an instant as the mode says; what rounding must be added to the rates of x."""
        held = self.hold(mode, now.numbers) if 0 in mode else None
        self.rub(now, mode, held, checked)
        if held is None:
            return None
        # By their factors slips move on, which what holds them makes up for.
        on = held.mix @ moved_on(now, self.ports.moving[held.ports])
        return lambda rate, du: held.correction(rate, du) + held.take_away @ on

    def hold(self, mode: Mode, numbers: Numbers) -> Hold:
        """The holding equations of a mode's sticking ports, with the matrices of an instant."""
        stuck = tuple(i for i, sign in enumerate(mode) if sign == 0)
        if stuck in self._holds and not self.form.varying:
            return self._holds[stuck]
        found = self._hold(list(stuck), numbers)
        if len(self._holds) >= MOST_KEPT:
            del self._holds[next(iter(self._holds))]
        self._holds[stuck] = found
        return found

    def _hold(self, stuck: list[int], numbers: Numbers) -> Hold:
        ports, names = self.ports, ", ".join(repr(self.ports.names[i]) for i in stuck)
        places = (ports.inputs, ports.readings, ports.received, ports.moving)
        if (chosen := tuple(stuck)) not in self._ranks:
            if len(self._ranks) >= MOST_KEPT:
                del self._ranks[next(iter(self._ranks))]
            self._ranks[chosen] = ports.held(chosen)
        try:
            found = hold(
                self._ranks[chosen], stuck, *places, numbers, self.form.varying, ports.exact
            )
        except HoldError:
            raise HoldError(
                f"with these parameters other ports of {names} are redundant than with those for "
                "which this was written; write it with these"
            ) from None
        for j in np.flatnonzero(
            np.abs(found.V).max(axis=0, initial=0.0) > TUNING.nothing_held
        ).tolist():
            if j not in self._rated:
                raise HoldError(
                    f"holding {names} would need the slope in time of {self.form.inputs[j]}, which "
                    "a law gives of more than states and inputs; put a storage between"
                )
        return found

    def rub(self, now: Instant, mode: Mode, held: Hold | None, checked: bool) -> None:
        """Complete an instant by the friction efforts of a mode; ``checked``: levels, for sign."""
        inputs = self.ports.inputs
        now.u[inputs] = self.against(now, mode, checked)
        if held is not None:
            now.u[held.inputs] = held.efforts(now, self.sharing)
        now.y += now.numbers.D[:, inputs] @ now.u[inputs]

    def against(self, now: Instant, mode: Mode, checked: bool) -> Array:
        """Slipping ports' efforts, zero at sticking ones; notes every port's breakaway effort."""
        values = self.ports.values(now)
        # Of few numbers plain ones are quicker.
        if checked and any(value < 0 for value in values.tolist()):
            values = without_rounding(values, level_terms(now, self._laws, self.ports.values))
        table = values.reshape(-1, 4)
        if checked:
            self._check(now.t, table.tolist())
        levels, now.caps, curves, _ = table.T
        efforts: Array = levels * curves * np.array(mode, dtype=float)
        return efforts

    def _check(self, t: float, table: Sequence[Sequence[float]]) -> None:
        """Refuse what no friction has; a row of the table for each port."""
        for name, (level, cap, curve, at_rest) in zip(self.ports.names, table, strict=True):
            if level < 0 or curve < 0 or cap < level * at_rest * (1 - TUNING.breakaway):
                way_out = (
                    "; bound what gives the level, by max(0, ...) or as a State by low=0"
                    if min(level, cap) < 0
                    else ""
                )
                raise EvaluationError(
                    f"at t = {t:g} the friction at {name!r} has level {level:g}, curve {curve:g} "
                    f"and breakaway effort {cap:g}: level and curve must not be negative, the "
                    f"breakaway not below the friction at standstill{way_out}"
                )


def slip_rates(now: Instant, rows: Places, moving: Places) -> Array:
    """How fast slips change: ``F x' + D u' + F' x + D' u``; inputs that have no rate are held."""
    m = now.numbers
    rates = m.F[rows] @ (m.P @ now.x + m.Q @ now.u + m.R @ now.du) + m.D[rows] @ now.du
    return np.asarray(rates + moved_on(now, moving), dtype=float)


def moved_on(now: Instant, moving: Places) -> Array:
    """How fast slips change by their factors alone."""
    return np.where(moving >= 0, now.y[moving], 0.0) if len(moving) else np.zeros(0)


def ways(mode: Mode) -> Iterator[Mode]:
    """Slipping as a mode says, backwards where it is silent, the mode, any slipping, all stuck."""
    yield tuple(sign or 1 for sign in mode)
    yield tuple(sign or -1 for sign in mode)
    yield mode
    if len(mode) <= MOST_SLIPPING:
        yield from product((1, -1), repeat=len(mode))
    yield (0,) * len(mode)
