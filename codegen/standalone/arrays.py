"""What models in numbers are made of, and what is raised where they have no values."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
"""Double precision, any shape; docstrings tell which."""

Places = NDArray[np.intp]
"""Positions in an array."""

Mode = tuple[int, ...]
"""For each friction port: 0 sticking, +1 or -1 the sign of its slip."""


class EvaluationError(ArithmeticError):
    """A model has no values at an instant; the message gives the time and the numbers."""


class HoldError(ArithmeticError):
    """Ports could hold, but what holds them cannot be told; that is no reason for another mode."""
