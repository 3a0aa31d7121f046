"""Products of matrices most of whose entries are zero, as those of large networks are."""

from typing import Any

import numpy as np
import scipy

from codegen.numbers.arrays import Array

LARGE = 4096
"""Entries from which it pays to look at which are zero."""

PART = 0.1
"""The part of entries up to which those that are not zero are multiplied one by one."""


def thin(matrix: Array) -> Any:
    """The matrix as products with it are quickest."""
    if matrix.size < LARGE or np.count_nonzero(matrix) > PART * matrix.size:
        return matrix
    return scipy.sparse.csr_array(matrix)


def product(a: Array, b: Array) -> Array:
    """``a b``.

    >>> product(np.eye(100), np.arange(200.0).reshape(100, 2))[99].tolist()
    [198.0, 199.0]
    """
    return np.asarray(thin(a) @ b, dtype=float)
