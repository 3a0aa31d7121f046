"""Runs phase by phase: matrix exponentials from one instant at which a system changes to the next."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm
from scipy.optimize import brentq

Array = NDArray[np.floating[Any]]
Phase = tuple[list[list[float]], list[tuple[list[float], str]]]
"""The matrix of x' = M x, and rows that lead to another phase where they fall below zero."""


def follow(
    phases: Mapping[str, Phase],
    name: str,
    x: Array,
    times: Array,
    forced: Mapping[float, Mapping[str, str]],
) -> tuple[Array, list[tuple[float, str]]]:
    """States at the times and when which phase began; ``forced``: times that change phases."""
    t, end, rows, began = float(times[0]), float(times[-1]), [], list[tuple[float, str]]()
    while True:
        M, exits = np.array(phases[name][0]), phases[name][1]
        stop = min([at for at in forced if at > t + 1e-12] + [end])
        first, after = stop, forced.get(stop, {}).get(name, name)
        for row, following in exits:
            left = _fall(np.array(row), M, x, stop - t)
            if left is not None and t + left < first:
                first, after = t + left, following
        inside = times[(times >= t) & ((times < first) | (first >= end))]
        rows += [expm(M * (s - t)) @ x for s in inside]
        if first >= end:
            return np.array(rows), began
        x, t = expm(M * (first - t)) @ x, first
        if after != name:
            began.append((t, after))
        name = after


def _fall(row: Array, M: Array, x: Array, length: float) -> float | None:
    """When row @ x falls below zero, not at once."""
    step, forward = length / 200, expm(M * length / 200)
    y = x
    for k in range(200):
        later = forward @ y
        if row @ later < 0 and (k > 0 or row @ x > 1e-12):
            return float(
                k * step + brentq(lambda s, y=y: row @ expm(M * s) @ y, 0, step, xtol=1e-16)
            )
        y = later
    return None
