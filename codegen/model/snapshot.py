"""Everything about a closed model at one instant."""

from dataclasses import dataclass
from typing import Protocol

from codegen.model.numbers import Numbers
from codegen.numbers.arrays import Array

Mode = tuple[int, ...]
"""For each friction port: 0 sticking, +1 or -1 the sign of its slip."""


class Run(Protocol):
    """What a model need know of a run that it is in."""

    #: The magnitudes that the integrated vector's components have reached.
    largest: Array


@dataclass(frozen=True)
class Snapshot:
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
