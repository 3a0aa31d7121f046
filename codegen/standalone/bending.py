"""Impulses as storages take them: momenta are exchanged, whatever slopes their laws have.

Ports that come to hold jump the states by ``pi(x+) - pi(x-) = B_S p``, where A is the slope of the
momenta pi; slopes that stay make that one linear step. Where slopes move with what jumps it is
searched by Newton's steps, shorter ones where what is left would not shrink (the natural test of
Deuflhard, Newton Methods for Nonlinear Problems, section 3.1).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from codegen.standalone.arrays import Array, EvaluationError, Places
from codegen.standalone.evaluation import Form
from codegen.standalone.holding import Hold
from codegen.standalone.instant import Formula, Instant
from codegen.standalone.matrices import Numbers, scaled_solve
from codegen.standalone.striking import Strike, struck
from codegen.tuning import TUNING

Holding = Callable[[Numbers], Hold]
"""What holds the ports of a mode, with the matrices of an instant."""


def exchanged(form: Form, holding: Holding, now: Instant, aims: Array | None = None) -> Strike:
    """The least impulses that stop the slips of what holds, or bring them to the ports' ``aims``.

    ``now``: the instant before, all let go. Raises `EvaluationError` where none are found.
    """
    held = holding(now.numbers)
    if form.momenta is None:
        return struck(held, now.numbers, _slips(held, now, now.x, aims))
    first = form.momenta(now)
    search = _Search(form.momenta, now, first, aims)
    here = _Place(now.x, first, now.numbers, held)
    for _ in range(TUNING.bends):
        found = search.strike(here, here.x, here.pi)
        way = now.x + found.jump - here.x
        if here.length(way) <= TUNING.bent * search.size(here):
            return search.shown(here, found, np.array(form.momenta_rows, dtype=np.intp))
        x, pi = search.nearer(here, way)
        numbers = form.matrices(replace(now, x=x))
        here = _Place(x, pi, numbers, holding(numbers))
    raise search.refusal()


def _slips(held: Hold, now: Instant, x: Array, aims: Array | None) -> Array:
    """The slips at a state, less what they are to be."""
    slips = held.slips(x, now.u)
    return slips if aims is None else slips - held.mix @ aims[held.ports]


@dataclass(frozen=True)
class _Place:
    """A state that is tried: what storages hold there, and the slopes of that."""

    x: Array
    pi: Array
    numbers: Numbers
    held: Hold

    def length(self, way: Array) -> float:
        """The length of a change of states, each by what it weighs."""
        return float(np.linalg.norm(np.sqrt(np.abs(np.diag(self.numbers.A))) * way))


@dataclass(frozen=True)
class _Search:
    """From where impulses are searched for: what storages hold, and the ports' aims."""

    momenta: Formula
    now: Instant
    first: Array
    aims: Array | None

    def strike(self, here: _Place, x: Array, pi: Array) -> Strike:
        """All that is struck by the slopes of one place, if it is told at another."""
        gained = (pi - self.first)[: len(x), None]
        base = x - scaled_solve(here.numbers.A, gained)[:, 0]
        one = struck(here.held, here.numbers, _slips(here.held, self.now, base, self.aims))
        return Strike(one.given, one.received, base + one.jump - self.now.x)

    def size(self, here: _Place) -> float:
        """What rounding is a part of: states, and what they would be by all that storages hold."""
        n, weights = len(here.x), np.abs(np.diag(here.numbers.A))
        held = (np.abs(here.pi) + np.abs(self.first))[:n] / weights
        return here.length(np.abs(here.x) + np.abs(self.now.x) + held)

    def nearer(self, here: _Place, way: Array) -> tuple[Array, Array]:
        """So far along a way that what is left shrinks: the state, and what storages hold there."""
        part, before = 1.0, here.length(way)
        for _ in range(TUNING.bent_halves):
            x = here.x + part * way
            pi = self.held(x)
            if np.isfinite(pi).all():
                left = self.now.x + self.strike(here, x, pi).jump - x
                if here.length(left) <= (1 - part / 2) * before:
                    return x, pi
            part /= 2
        raise self.refusal()

    def held(self, x: Array) -> Array:
        """What storages hold at a state; no numbers where a law has no value."""
        try:
            with np.errstate(all="ignore"):
                return self.momenta(replace(self.now, x=x))
        except (ArithmeticError, ValueError):
            return np.full(len(self.first), np.nan)

    def shown(self, here: _Place, found: Strike, rows: Places) -> Strike:
        """The strike, with what readings that show rates receive: what is gained behind them."""
        n, received = len(here.x), found.received.copy()
        gained = self.held(self.now.x + found.jump) - self.first
        by_slopes = here.numbers.H[rows] @ here.numbers.Q @ found.given
        received[rows] += gained[n:] - by_slopes
        return Strike(found.given, received, found.jump)

    def refusal(self) -> EvaluationError:
        """What is raised where nothing is found."""
        return EvaluationError(
            f"at t = {self.now.t:g} no impulse is found that keeps what nonlinear storages hold: "
            "their laws may have no value in common"
        )
