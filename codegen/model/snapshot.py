"""Everything about a closed model at one instant."""

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from codegen.standalone.arrays import Array
from codegen.standalone.arrays import Mode as Mode
from codegen.standalone.instant import Instant
from codegen.standalone.matrices import Numbers
from codegen.standalone.striking import Strike


class Run(Protocol):
    """What a model need know of a run that it is in."""

    #: The magnitudes that the integrated vector's components have reached.
    largest: Array


class Snapshot(NamedTuple):
    """Everything at one instant: states x and z, inputs, their rates, readings, the rate of s.

    ``caps``: the breakaway effort of each friction port. ``external``: the external inputs.
    ``numbers``: the matrices, as they are at this instant.
    """

    x: Array
    z: Array
    u: Array
    du: Array
    y: Array
    rate: Array
    caps: Array
    external: Array
    numbers: Numbers

    def instant(self, t: float) -> Instant:
        """The same for formulas, external inputs at rest."""
        parts = (self.x, self.z, self.u, self.du, self.y, self.external)
        return Instant(t, *parts, np.zeros(len(self.external)), self.caps, self.numbers)


@dataclass(frozen=True)
class Impact:
    """An instant at which states jump: the integrated vector after it, and the impulses.

    ``taken`` [J]: the energy that the ports take. ``thrown``: the stops that threw back what met them.
    """

    s: Array
    strike: Strike
    taken: float
    thrown: tuple[int, ...] = ()
