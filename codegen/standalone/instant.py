"""One instant under evaluation, and what a formula is."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from codegen.standalone.arrays import Array, Places
from codegen.standalone.matrices import Numbers, times

NO_NUMBERS = Numbers(*[np.zeros((0, 0))] * 8)
"""The matrices of an instant of which they are not known yet."""


@dataclass
class Instant:
    """Every variable at one time; inputs ``u`` and readings ``y`` are completed law by law.

    ``x``, ``z``: states, and states that laws own. ``u``: all inputs, what laws give included;
    ``du``: rates of those inputs that have one. ``y``: what ports receive, and the outputs. ``w``,
    ``dw``: external inputs and their rates. ``caps``: breakaway efforts of the friction ports.
    ``numbers``: the matrices, as they are at this instant. ``rate``: that of the integrated vector.
    """

    t: float
    x: Array
    z: Array
    u: Array
    du: Array
    y: Array
    w: Array
    dw: Array
    caps: Array
    numbers: Numbers = NO_NUMBERS
    rate: Array = field(init=False, repr=False)
    #: The largest magnitudes that x and z have had, where a run is known: what they round by.
    seen: Array | None = None

    def give(self, inputs: Places, amounts: Array) -> None:
        """Add to inputs, and to the readings that show them at once."""
        self.u[inputs] += amounts
        self.y += times(self.numbers.D[:, inputs], amounts)


class Formula(ABC):
    """What laws give at an instant, or of a pool, all that is read in one array.

    ``constants``: the numbers of the parameters, the end of a pool.
    """

    def __init__(self, constants: Array) -> None:
        self.constants = constants

    def __call__(self, now: Instant) -> Array:
        """What the laws give at an instant."""
        return self.of_pool(self.pool(now), now)

    def pool(self, now: Instant) -> Array:
        """The pool of an instant: t, x, z, y, u, w, w' and the parameters."""
        return np.concatenate(((now.t,), now.x, now.z, now.y, now.u, now.w, now.dw, self.constants))

    @abstractmethod
    def of_pool(self, pool: Array, like: Instant) -> Array:
        """What the laws give, of a pool laid out like that of an instant."""

    def read(self, pool: Array) -> Sequence[int]:
        """The places in a pool that may be read."""
        return range(len(pool))
