"""The one array type of the numeric side, and what counts as a number."""

import math
from collections.abc import Sequence
from numbers import Real
from typing import Any, TypeGuard

import numpy as np
from numpy.typing import ArrayLike, NDArray

from codegen.standalone.arrays import Array as Array

Flags = NDArray[np.bool_]
"""What is so and what is not, place by place."""

NUMBER = int | float | np.integer | np.floating
"""What is a number by itself; truth values are integers, too, and are refused with `is_number`."""


def is_number(value: object) -> TypeGuard[float]:
    """Whether something is one real number: no text, no truth value, nothing complex.

    >>> is_number(2), is_number(np.float32(2)), is_number(True), is_number(2 + 0j), is_number("2")
    (True, True, False, False, False)
    """
    return isinstance(value, NUMBER) and not isinstance(value, bool)


def is_finite(value: float) -> bool:
    """Whether a number is a finite double; an integer may be too large for one.

    >>> is_finite(2), is_finite(float("nan")), is_finite(10**400)
    (True, False, False)
    """
    try:
        return math.isfinite(value)
    except OverflowError:
        return False


def real_array(values: ArrayLike) -> Array:
    """A fresh array of floats; `TypeError` or `ValueError` for what does not hold real numbers alone.

    numpy by itself reads text as numbers, counts truth values, and drops imaginary parts.

    >>> real_array([1, 2.5]), real_array([])
    (array([1. , 2.5]), array([], dtype=float64))
    >>> real_array([1, 2j])
    Traceback (most recent call last):
    TypeError: these are complex128, not real numbers
    """
    found = np.asarray(values)
    if found.dtype.kind == "O":
        for value in found.ravel().tolist():
            if not isinstance(value, Real) or isinstance(value, bool):
                raise TypeError(f"{value!r} is not a real number")
    elif found.dtype.kind not in "iuf":
        raise TypeError(f"these are {found.dtype}, not real numbers")
    try:
        return np.array(found, dtype=np.float64)
    except OverflowError as error:
        raise ValueError(str(error)) from None


FEW = 64
"""So many flags are looked at one by one sooner than by a reduction."""


def all_of(flags: NDArray[np.bool_]) -> bool:
    """Whether all flags are set, told quickly of a few.

    >>> all_of(np.array([True, False])), all_of(np.array([], dtype=bool))
    (False, True)
    """
    return all(flags.ravel().tolist()) if flags.size <= FEW else bool(flags.all())


def dot(matrix: Array, vector: Array) -> Array:
    """A matrix times a vector; of stacks each times its own.

    >>> dot(np.eye(2)[None] * [[[2.0]], [[3.0]]], np.ones((2, 2))).tolist()
    [[2.0, 2.0], [3.0, 3.0]]
    """
    found: Array = matrix @ vector if vector.ndim == 1 else (matrix @ vector[..., None])[..., 0]
    return found


def read_only(array: NDArray[Any]) -> NDArray[Any]:
    """The array, which nobody can write to any more, nor to what it is a view of.

    >>> read_only(real_array([1, 2]))[0] = 3
    Traceback (most recent call last):
    ValueError: assignment destination is read-only
    """
    part: Any = array
    while isinstance(part, np.ndarray):
        part.setflags(write=False)
        part = part.base
    return array


def real_values(values: Sequence[Any]) -> Array:
    """The results of a function as an array; `TypeError` for a complex one."""
    for value in values:
        if isinstance(value, complex):
            raise TypeError(f"{value:.6g} is complex")
    return np.array([float(value) for value in values])
