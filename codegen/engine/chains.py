"""What the C engine's generators are made of: chains, and the rows of segments over them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codegen.numbers.arrays import Array

Chain = tuple[int, complex, int]
"""An input, a rate [1/s] and how many coefficients the polynomial at that rate has."""


def slots_of(chain: Chain) -> int:
    """How many slots of a generator a chain takes."""
    return chain[2] * (2 if chain[1].imag else 1)


@dataclass(frozen=True)
class Rows:
    """Segments from ``since`` to ``until`` [s], a row of each array for each; ``breaks`` are between them.

    ``constants``: what each input is but for its chains; ``starts``: those of the chains; ``polynomials``:
    their coefficients by slot; ``chains``: which structure; ``fastest`` [1/s]: the largest rate.
    """

    since: float
    until: float
    breaks: Array
    constants: Array
    starts: Array
    polynomials: Array
    chains: NDArray[np.intc]
    fastest: Array
