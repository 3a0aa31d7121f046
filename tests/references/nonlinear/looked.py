"""Tables as numpy and scipy interpolate them, one place at a time, with slopes: functions of jets."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from scipy.interpolate import (
    Akima1DInterpolator,
    BSpline,
    PchipInterpolator,
    RectBivariateSpline,
)

from .jets import Jet, value

Array = np.ndarray


def looked_in(
    method: str, outside: str, axes: Sequence[Array], values: Array
) -> Callable[..., Jet | float]:
    """The function of a table; ``outside``: "hold" or "extend"."""
    if len(axes) == 2:
        return _over_two(method, outside, axes[0], axes[1], values)
    three = _over_one(method, outside, axes[0], values)
    return lambda x: x.through(*three(x.v)) if isinstance(x, Jet) else three(x)[0]


def _over_one(
    method: str, outside: str, x: Array, z: Array
) -> Callable[[float], tuple[float, float, float]]:
    def three(at: float) -> tuple[float, float, float]:
        if outside == "hold" and not x[0] <= at <= x[-1]:
            return float(z[0] if at < x[0] else z[-1]), 0.0, 0.0
        if method == "linear":
            cell = min(max(int(np.searchsorted(x, at, "right")) - 1, 0), len(x) - 2)
            slope = float((z[cell + 1] - z[cell]) / (x[cell + 1] - x[cell]))
            return float(z[cell]) + slope * (at - float(x[cell])), slope, 0.0
        return tuple(float(f(at, extrapolate=True)) for f in slopes)

    if method != "linear":
        smooth = {"pchip": PchipInterpolator, "akima": Akima1DInterpolator}[method](x, z)
        slopes = [smooth, smooth.derivative(), smooth.derivative(2)]
    return three


def _over_two(
    method: str, outside: str, x: Array, y: Array, z: Array
) -> Callable[[Jet | float, Jet | float], Jet | float]:
    if method == "bicubic":
        # As a product of splines it goes on beyond its ends, where FITPACK stops.
        knots_x, knots_y, flat = RectBivariateSpline(x, y, z, kx=3, ky=3, s=0).tck
        factors = np.asarray(flat).reshape(len(x), len(y))
        along, across = (
            BSpline(knots, np.eye(len(axis)), 3) for knots, axis in ((knots_x, x), (knots_y, y))
        )

    def partial(a: float, b: float, i: int, j: int) -> float:
        if method == "bicubic":
            return float(along(a, i) @ factors @ across(b, j))
        return _flat(x, y, z, a, b, i, j)

    def called(a: Jet | float, b: Jet | float) -> Jet | float:
        jets = [one for one in (a, b) if isinstance(one, Jet)]
        at = [value(a), value(b)]
        free = [True, True]
        if outside == "hold":
            inside = [float(np.clip(p, k[0], k[-1])) for p, k in zip(at, (x, y), strict=True)]
            free = [p == q for p, q in zip(at, inside, strict=True)]
            at = inside
        found = partial(*at, 0, 0)
        if not jets:
            return found
        size = len(jets[0].g)
        zero = Jet(0.0, np.zeros(size), np.zeros((size, size)))
        u, v = (
            one if isinstance(one, Jet) and go else zero
            for one, go in zip((a, b), free, strict=True)
        )
        p, q = partial(*at, 1, 0), partial(*at, 0, 1)
        cross = np.outer(u.g, v.g)
        H = p * u.H + q * v.H + partial(*at, 1, 1) * (cross + cross.T)
        H = H + partial(*at, 2, 0) * np.outer(u.g, u.g) + partial(*at, 0, 2) * np.outer(v.g, v.g)
        return Jet(found, p * u.g + q * v.g, H)

    return called


def _flat(x: Array, y: Array, z: Array, a: float, b: float, i: int, j: int) -> float:
    """The bilinear surface, or a slope of it."""
    k = min(max(int(np.searchsorted(x, a, "right")) - 1, 0), len(x) - 2)
    m = min(max(int(np.searchsorted(y, b, "right")) - 1, 0), len(y) - 2)
    if i > 1 or j > 1:
        return 0.0
    width, height = x[k + 1] - x[k], y[m + 1] - y[m]
    s, r = (a - x[k]) / width, (b - y[m]) / height
    along = [np.array([1 - s, s]), np.array([-1, 1]) / width][i]
    across = [np.array([1 - r, r]), np.array([-1, 1]) / height][j]
    return float(along @ z[k : k + 2, m : m + 2] @ across)
