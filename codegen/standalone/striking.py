"""Impulses as switches come to hold: what stops what they must not let through.

Held, the ports S have ``y_S = F x + D u = 0``. Of the combinations that no effort of theirs rules
at once the states jump by ``A^-1 B_S p``, where ``D_SS p = 0``. Friction takes no part: what it
gives is finite.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from codegen.standalone.arrays import Array, Places
from codegen.standalone.holding import Hold
from codegen.standalone.instant import Instant
from codegen.standalone.matrices import Numbers
from codegen.standalone.switchings import Switching
from codegen.tuning import TUNING

FAR = 2.0**40
"""An impulse is looked at as a value so much larger than all others."""


@dataclass(frozen=True)
class Strike:
    """What the inputs give and the readings receive of impulses, and what x gains."""

    given: Array
    received: Array
    jump: Array

    def gained(self, size: int, law_rates: Places) -> Array:
        """What the vector s of this size gains: its states, then those that laws own."""
        n, found = len(self.jump), np.zeros((size, *self.jump.shape[1:]))
        found[:n], found[n : n + len(law_rates)] = self.jump, self.received[law_rates]
        return found

    def followed(self, other: "Strike") -> "Strike":
        """This one and another just after it."""
        return Strike(
            self.given + other.given, self.received + other.received, self.jump + other.jump
        )


def struck(held: Hold, numbers: Numbers, slips: Array) -> Strike:
    """The least impulses of ports that stop these slips, or, by columns, each of several such."""
    moved = numbers.Q[:, held.inputs] @ held.free
    amounts = -np.linalg.lstsq(held.slip_x @ moved, slips, rcond=TUNING.nothing)[0]
    given = np.zeros((numbers.Q.shape[1], *slips.shape[1:]))
    given[held.inputs] = held.free @ amounts
    return Strike(given, numbers.D @ given, moved @ amounts)


def completing(held: Hold, now: Instant, free: Sequence[int]) -> Array:
    """What free states must gain to stop the slips; of them what is heavy by itself moves least."""
    rows = held.slip_x[:, free]
    way = rows.T / np.abs(np.diag(now.numbers.A))[free, None]
    slips = held.slips(now.x, now.u)
    return np.asarray(-way @ np.linalg.lstsq(rows @ way, slips, rcond=TUNING.nothing)[0], float)


def effort_terms(held: Hold, x: Array, u: Array, du: Array) -> Array:
    """For each holding effort the magnitudes of what it follows from; zero where laws share it."""
    if not held.inverse.size:
        return np.zeros(len(held.ports))
    X, U, V, inverse = held.magnitudes
    terms = X @ np.abs(x) + U @ np.abs(u) + V @ np.abs(du)
    return np.asarray(inverse @ terms, dtype=float)


def rounded_by(given: Array) -> Array:
    """What impulses round by, in columns as they are: the largest of those solved for together.

    One that is the rounding of none is so, too.
    """
    return np.asarray(np.where(given != 0, np.abs(given).max(axis=0, initial=0.0), 0.0))


def shocks(
    strike: Strike,
    now: Instant,
    mode: Sequence[int],
    switching: Sequence[Switching | None],
    places: tuple[Places, Places],
    guards: Callable[[Instant], Array],
) -> list[int]:
    """For each port 1 where its impulse goes with the mode, -1 where against it, 0 for none.

    ``places``: of what the ports give in u, of what they receive in y.
    """
    inputs, readings = places
    given, received = strike.given[inputs], strike.received[readings]
    largest = float(np.abs(given).max(initial=0.0))
    terms = np.abs(now.numbers.D[readings]) @ rounded_by(strike.given)
    size = max(largest, float(np.abs(strike.received).max(initial=0.0)))
    pushed = _pushed(strike, now, size, guards)
    found = [0] * len(mode)
    for i, one in enumerate(switching):
        if one is None:
            continue
        if not one.side:
            way, least = -pushed[one.condition(mode[i])], size
        elif mode[i]:
            way, least = one.side * received[i], terms[i]
        else:
            way, least = -one.side * given[i], largest
        if abs(way) > TUNING.rounding * least:
            found[i] = 1 if way > 0 else -1
    return found


def _pushed(strike: Strike, now: Instant, size: float, guards: Callable[[Instant], Array]) -> Array:
    """How conditions change with the impulses, which are so large."""
    before, u, y = guards(now), now.u, now.y
    if not len(before) or not size > 0:
        return np.zeros(len(before))
    most = FAR * (1 + float(np.abs(y).max(initial=0.0)))
    now.u, now.y = u + most / size * strike.given, y + most / size * strike.received
    after = guards(now)
    now.u, now.y = u, y
    return np.asarray((after - before) / most * size, dtype=float)
