"""Products of matrices most of whose entries are zero, as those of large networks are."""

from typing import Any

import numpy as np
import scipy

from codegen.numbers.arrays import Array
from codegen.tuning import TUNING


def thin(matrix: Array) -> Any:
    """The matrix as products with it are quickest; a stack of matrices as it is."""
    few = matrix.size / TUNING.few_entries
    stack = matrix.ndim > 2
    if stack or matrix.size < TUNING.large_table or few < np.count_nonzero(matrix):
        return matrix
    return scipy.sparse.csr_array(matrix)


def product(a: Array, b: Array) -> Array:
    """``a b``.

    >>> product(np.eye(100), np.arange(200.0).reshape(100, 2))[99].tolist()
    [198.0, 199.0]
    """
    return np.asarray(thin(a) @ b, dtype=float)
