"""A model at any time, state and friction mode: every input, reading and rate.

The integrated vector is ``s = [xi, z]``: ``xi = x - A^-1 E u`` stays continuous when an input
that drives a dependent storage steps; z are the states that laws own. Where the matrices change
in time it holds x itself.
"""

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from codegen.standalone.arrays import Array, Mode, Places
from codegen.standalone.instant import Formula, Instant
from codegen.standalone.matrices import Numbers, times


class Point(NamedTuple):
    """A time, the integrated vector then, and the external inputs with their rates.

    ``seen``: the largest magnitudes that the vector has had, where a run is known.
    """

    t: float
    s: Array
    w: Array
    dw: Array
    seen: Array | None = None


@dataclass
class Laws:
    """Laws to evaluate: the inputs that they give, what their ports receive, and their names."""

    formula: Formula
    inputs: Places
    readings: Places
    names: Sequence[Hashable]

    def close(self, now: Instant) -> None:
        """Give what they give at an instant."""
        now.give(self.inputs, self.formula(now))


Correction = Callable[[Array, Array], Array] | None

Contact = Callable[[Instant, Mode, bool], Correction]
"""Completes an instant by friction as the mode says, levels checked or not.

Gives what rounding of what holds must be added to the rates of x, a function of these and u'.
"""


@dataclass(frozen=True)
class Form:
    """A model's formulas with numbers for their parameters, and where everything stands.

    ``states``: how many. ``inputs``, ``readings``: names. ``given``: the places in u of the
    external inputs. ``known``: laws of time and external inputs; ``known_rates``: how fast these
    change, None where nothing asks for it. ``beyond``: the places of what laws have beyond their
    tangents, whose rates are with what moves slips. ``laws``: the others, in an order in which each
    can be evaluated, the first ``early`` of them before friction. ``law_rates``: the places in y of
    the rates of laws' states. ``varying``: whether the matrices change. ``momenta``: what storages
    hold, of each state, then of the readings ``momenta_rows``; None where no impulse bends slopes.
    """

    states: int
    inputs: Sequence[str]
    readings: Sequence[str]
    given: Places
    known: Laws
    known_rates: Formula | None
    beyond: Places
    matrices: Callable[[Instant], Numbers]
    laws: Sequence[Laws]
    early: int
    law_rates: Places
    varying: bool
    momenta: Formula | None = None
    momenta_rows: Sequence[int] = ()


def begun(form: Form, at: Point) -> Instant:
    """An instant with what does not depend on states, and the matrices."""
    n, known, count = form.states, form.known.inputs, len(form.given)
    m, x, z = len(form.inputs), at.s[:n], at.s[n : n + len(form.law_rates)]
    u, du, y = (np.zeros_like(at.s, shape=size) for size in (m, m, len(form.readings)))
    now = Instant(at.t, x, z, u, du, y, at.w, at.dw, np.zeros(0))
    now.seen = at.seen
    u[form.given] = at.w[:count]
    if len(known):
        u[known] = form.known.formula(now)
    du[form.given] = at.dw[:count]
    if form.known_rates is not None:
        du[known] = form.known_rates(now)
    now.numbers = form.matrices(now)
    return now


def evaluated(
    form: Form, contact: Contact | None, at: Point, mode: Mode, checked: bool = True
) -> Instant:
    """Every variable in a mode; ``checked``: whether friction levels are, for sign.

    Raises `EvaluationError` where there are no values.
    """
    now = begun(form, at)
    numbers = now.numbers
    if not form.varying:
        now.x = now.x + numbers.R @ now.u  # x = xi + A^-1 E u
    now.y = numbers.F @ now.x + numbers.D @ now.u + numbers.G @ now.du
    for laws in form.laws[: form.early]:
        laws.close(now)
    correction = contact(now, mode, checked) if contact is not None else None
    for laws in form.laws[form.early :]:
        laws.close(now)
    rate = numbers.P @ now.x + times(numbers.Q, now.u)
    if form.varying:
        rate += numbers.R @ now.du
    if correction is not None:
        rate += correction(rate, now.du)
    now.rate = np.zeros_like(at.s)
    now.rate[: form.states] = rate
    now.rate[form.states : form.states + len(form.law_rates)] = now.y[form.law_rates]
    return now


def vector(form: Form, t: float, state: Array, w: Array, dw: Array) -> Array:
    """The integrated vector at a state: x less what inputs that drive dependent storages add."""
    s = state.copy()
    if not form.varying:
        now = begun(form, Point(t, state, w, dw))
        s[: form.states] -= now.numbers.R @ now.u
    return s
