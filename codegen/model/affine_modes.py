"""Affine maps of friction modes, from that of one mode: only what ports give differs, and what it moves."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from codegen.model.snapshot import Mode
from codegen.numbers.arrays import Array
from codegen.numbers.thin import product, thin
from codegen.program.affine import AffineMap
from codegen.program.layout import INPUTS, RATE, RATES_OF_INPUTS, READINGS, STATES
from codegen.standalone.arrays import Places
from codegen.standalone.holding import Hold
from codegen.standalone.matrices import Numbers


@dataclass(frozen=True)
class LetGo:
    """The map of a mode in which ports give nothing, and what they give slipping forwards.

    ``rub``: rows of that. ``shown``, ``pushed``: what readings and rates of states gain per unit of it.
    All may be stacks of those of many runs.
    """

    base: AffineMap
    ports: Sequence[int]
    rub: Array
    shown: Any
    pushed: Any

    def at(self, columns: Places) -> "LetGo":
        """Some columns of the same."""
        base = AffineMap(self.base.sizes, self.base.matrix[..., columns], RATE)
        return replace(self, base=base, rub=self.rub[..., columns])


def let_go(forwards: AffineMap, numbers: Numbers, ports: Sequence[int]) -> LetGo:
    """The same from the map in which all ports slip forwards."""
    base = AffineMap(forwards.sizes, forwards.matrix.copy(), RATE)
    u = base.rows(INPUTS)
    rub = u[..., ports, :].copy()
    u[..., ports, :] = 0.0
    _show(base, numbers)
    return LetGo(base, ports, rub, thin(numbers.D[..., ports]), thin(numbers.Q[..., ports]))


def in_mode(known: LetGo, mode: Mode, hold: Hold | None, law_rates: Sequence[int]) -> AffineMap:
    """The map of a mode; ``hold``: what holds its sticking ports; ``law_rates``: of states of laws, in y."""
    base, ports = known.base, known.ports
    parts = AffineMap(base.sizes, base.matrix.copy(), RATE)
    x, u, du = (parts.rows(part) for part in (STATES, INPUTS, RATES_OF_INPUTS))
    u[..., ports, :] = known.rub * np.array(mode, dtype=float)[:, None]
    if hold is not None:
        right = product(hold.X, x) + product(hold.U, u) + product(hold.V, du)
        u[..., hold.inputs, :] = -product(hold.inverse[..., : right.shape[-2]], right)
    readings, rates, n = parts.rows(READINGS), parts.rows(RATE), x.shape[-2]
    given, own = u[..., ports, :], rates[..., :n, :]
    readings += known.shown @ given
    own += known.pushed @ given
    _finish(parts, hold, law_rates)
    return parts


def told(
    probed: AffineMap, numbers: Numbers, hold: Hold | None, law_rates: Sequence[int]
) -> AffineMap:
    """The map of a mode from what a model gives there, where laws read what its ports give."""
    parts = AffineMap(probed.sizes, probed.matrix.copy(), RATE)
    _show(parts, numbers)
    _finish(parts, hold, law_rates)
    return parts


def _show(parts: AffineMap, numbers: Numbers) -> None:
    """Readings and rates from states and inputs."""
    x, u, du = (parts.rows(part) for part in (STATES, INPUTS, RATES_OF_INPUTS))
    parts.rows(READINGS)[:] = numbers.F @ x + numbers.D @ u + numbers.G @ du
    parts.rows(RATE)[..., : x.shape[-2], :] = numbers.P @ x + numbers.Q @ u


def _finish(parts: AffineMap, hold: Hold | None, law_rates: Sequence[int]) -> None:
    """The rates of states of laws; and no slip that rounding would make of what is held."""
    readings, rates, du = (parts.rows(part) for part in (READINGS, RATE, RATES_OF_INPUTS))
    n = parts.rows(STATES).shape[-2]
    own = rates[..., :n, :]
    rates[..., n : n + len(law_rates), :] = readings[..., list(law_rates), :]
    if hold is not None:
        left = product(hold.slip_x, own) + product(hold.fixed, du)
        own += product(hold.take_away, left)
