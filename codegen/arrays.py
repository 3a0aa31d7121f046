"""The one array type of the numeric side."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
"""Double precision, any shape; docstrings tell which."""
