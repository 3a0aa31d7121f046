"""A search that needs scipy, for what Newton's iteration does not find."""

import numpy as np
import scipy

from codegen.standalone.arrays import Array
from codegen.standalone.loops import Residual
from codegen.tuning import TUNING


def hybrid(residual: Residual, start: Array) -> Array:
    """Powell's hybrid method, from a start to where a function may vanish."""
    return np.asarray(
        scipy.optimize.root(residual, start, method="hybr", tol=TUNING.searched).x, dtype=float
    )
