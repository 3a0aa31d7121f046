"""What a unit of what each port gives over a time does to states, to readings, and so to slips."""

from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np

from codegen.standalone.arrays import Array, Places
from codegen.standalone.evaluation import Laws
from codegen.standalone.instant import Instant
from codegen.tuning import TUNING

Flags = np.ndarray[tuple[Any, ...], np.dtype[np.bool_]]
"""For each port whether something is so."""


@dataclass(frozen=True)
class Response:
    """By columns, of each port: what states gain over a time [s], what readings show at once."""

    time: float
    gains: Array
    readings: Array

    def yields(self, now: Instant, slips: Places, rubs: Flags) -> tuple[Array, Flags, bool]:
        """How much slips yield to what ports give, the ports that push theirs on, whether none.

        Ports that hold a slip together share it; what nothing moves none can hold.
        """
        found = -(self.readings[slips] + now.numbers.F[slips] @ self.gains)
        own = np.diag(found)
        largest = float(np.abs(own).max(initial=0.0))
        active = own < -TUNING.shared * largest
        pushing = rubs & active
        least = np.where(own > TUNING.shared * largest, own, largest if largest > 0 else 1.0)
        shared = np.diag(np.where(pushing, 0.0, TUNING.shared * least))
        return np.asarray(found + shared), pushing, not active.any()

    def pushed(self, given: Array, s: Array, law_rates: Places) -> Array:
        """The vector s after what ports give over the time."""
        n, after = len(self.gains), s.copy()
        after[:n] += self.gains @ given
        after[n : n + len(law_rates)] += self.time * (self.readings[law_rates] @ given)
        return after


def respond(
    now: Instant, efforts: Places, coupled: Laws | None, time: float, lag: float
) -> Response:
    """The response at an instant; laws that friction moves, ``coupled``, answer by their slopes.

    The rates of storages and resistances follow after a ``lag``: after the whole time as in a step
    of Euler's implicit method, and what is passive yields so over any; straight on without any.
    """
    numbers = now.numbers
    gains, readings = numbers.Q[:, efforts], numbers.D[:, efforts]
    if coupled is not None and len(coupled.inputs):
        given = _answers(now, efforts, coupled)
        gains = gains + numbers.Q[:, coupled.inputs] @ given
        readings = readings + numbers.D[:, coupled.inputs] @ given
    gains = time * gains
    system = np.eye(len(gains)) - lag * numbers.P
    if lag > 0 and np.isfinite(system).all():
        with suppress(np.linalg.LinAlgError):
            gains = np.asarray(np.linalg.solve(system, gains), dtype=float)
    return Response(time, gains, readings)


def _answers(now: Instant, efforts: Places, coupled: Laws) -> Array:
    """What coupled laws give per unit of what each port gives; zero without a common answer."""
    before = coupled.formula(now)
    step = TUNING.loop_difference * (float(np.abs(now.u).max(initial=0.0)) + TUNING.loop_floor)

    def slopes(column: int) -> Array:
        u, y = now.u, now.y
        now.u = np.where(np.arange(len(u)) == column, u + step, u)
        now.y = y + step * now.numbers.D[:, column]
        after = coupled.formula(now)
        now.u, now.y = u, y
        return np.asarray((after - before) / step)

    own = np.eye(len(coupled.inputs)) - np.column_stack([slopes(at) for at in coupled.inputs])
    along = np.column_stack([slopes(at) for at in efforts])
    none = np.zeros_like(along)
    if not np.isfinite(own).all() or not np.isfinite(along).all():
        return none
    try:
        found = np.asarray(np.linalg.solve(own, along), dtype=float)
    except np.linalg.LinAlgError:
        return none
    return found if np.isfinite(found).all() else none
