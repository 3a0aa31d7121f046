"""How far answers of tools are from exact ones, and what is said of them."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

Array = NDArray[np.float64]

ALIKE = 1e-6
"""Of the largest: eigenvalues nearer than this are the same; and, in seconds, events at the right time."""

AT_ONCE = 1e-9
"""Events nearer in time [s] than this are one change of mode."""

Event = tuple[float, str]


def spectrum(found: Sequence[Sequence[float]], exact: NDArray[np.complex128]) -> str:
    """Whether eigenvalues, given as real and imaginary parts, are the exact ones.

    Others that are zero, as of angles that no torque depends on, are told but not wrong.

    >>> exact = np.array([-1 + 2j, -1 - 2j])
    >>> spectrum([[-1, 2], [-1, -2], [0, 0]], exact)
    'right, and 1 at zero'
    >>> spectrum([[-1, 2], [-1, -3]], exact), spectrum([[-1, 2]], exact)
    ('other eigenvalues', '1 state, not 2')
    """
    values, largest = np.array([complex(*pair) for pair in found]), float(np.abs(exact).max())
    more = len(values) - len(exact)
    if more < 0:
        return f"{len(values)} state{'s' * (len(values) != 1)}, not {len(exact)}"
    rows, columns = linear_sum_assignment(np.abs(exact[:, None] - values))
    left = np.delete(values, columns)
    if np.abs(exact[rows] - values[columns]).max() > ALIKE * largest:
        return "other eigenvalues"
    if more and np.abs(left).max() > ALIKE * largest:
        return f"{more} eigenvalues too many"
    return f"right, and {more} at zero" if more else "right"


def apart(found: Any, exact: Array) -> float:
    """The largest difference of two tables over the largest range of a column; infinite if not a number.

    >>> apart([[0.0, 1.0], [2.0, 1.5]], np.array([[0.0, 1.0], [2.0, 1.0]]))
    0.25
    """
    table = np.array(found, dtype=np.float64)
    if table.shape != exact.shape or not np.isfinite(table).all():
        return np.inf
    return float(np.abs(table - exact).max() / np.ptp(exact, axis=0).max())


def beyond(found: Any, exact: Array) -> float:
    """The largest relative difference of numbers.

    >>> beyond([1.0, 2.5], np.array([1.0, 2.0]))
    0.25
    """
    return float(np.max(np.abs(np.array(found) - exact) / np.abs(exact)))


def merged(events: Sequence[Sequence[Any]]) -> list[Event]:
    """Events without crossings that belong to the change of mode just before.

    >>> merged([[0.5, "stick"], [0.6, "slip"], [0.6 + 1e-13, "cross"]])
    [(0.5, 'stick'), (0.6, 'slip')]
    """
    kept: list[Event] = []
    for time, kind in events:
        if not (kept and kind == "cross" and time - kept[-1][0] < AT_ONCE):
            kept.append((float(time), str(kind)))
    return kept


def locked(events: Sequence[Sequence[Any]], exact: Sequence[Event]) -> str:
    """Whether lock and unlock are at the right times, and how far off each is.

    >>> locked([[0.5, "stick"], [0.6, "slip"]], [(0.5, "stick"), (0.6, "slip")])
    'right: +0.0e+00, +0.0e+00 s'
    >>> locked([], [(0.5, "stick")])
    'wrong: no event, not stick'
    """
    found = merged(events)
    if [kind for _, kind in found] != [kind for _, kind in exact]:
        kinds = (", ".join(kind for _, kind in some) or "no event" for some in (found[:4], exact))
        return "wrong: {}, not {}".format(*kinds)
    off = [time - right for (time, _), (right, _) in zip(found, exact, strict=True)]
    word = "right" if max(map(abs, off)) <= ALIKE else "late"
    return f"{word}: {', '.join(f'{one:+.1e}' for one in off)} s"
