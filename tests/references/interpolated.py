"""Tables by numpy's and scipy's interpolators themselves: values and first slopes, inside and outside."""

import numpy as np
from scipy.interpolate import (
    Akima1DInterpolator,
    BSpline,
    PchipInterpolator,
    RectBivariateSpline,
    RegularGridInterpolator,
)

import bondgraph as bg

Array = np.ndarray
METHODS = ("linear", "pchip", "akima", "bilinear", "bicubic")
POINTS = 100_000
Orders = tuple[int, ...]


def random_table(method: str, outside: str, seed: int = 0) -> tuple[bg.LookupTable, list[Array]]:
    """A table over uneven points, and its axes and values."""
    rng = np.random.default_rng(seed)
    over_two = method.startswith("bi")
    axes = [np.cumsum(rng.uniform(0.2, 1.0, count)) for count in (11, 8)[: 1 + over_two]]
    z = rng.normal(size=[len(axis) for axis in axes])
    return bg.LookupTable("map", *axes, z, method=method, outside=outside), [*axes, z]


def random_places(axes: list[Array], outside: bool, seed: int = 1) -> list[Array]:
    """Arguments inside a table, or on both sides of its ends, the points among them."""
    rng = np.random.default_rng(seed)
    found = []
    for axis in axes:
        wide = 0.3 * (axis[-1] - axis[0]) * outside
        places = rng.uniform(axis[0] - wide, axis[-1] + wide, POINTS)
        places[: len(axis)] = axis
        found.append(rng.permutation(places))
    return found


def interpolated(
    method: str, outside: str, parts: list[Array], places: list[Array], orders: Orders
) -> Array:
    """The reference: of linear tables slopes are differences of neighbours, of others scipy's."""
    *axes, z = parts
    beyond = [(p < axis[0]) | (p > axis[-1]) for p, axis in zip(places, axes, strict=True)]
    inside = [np.clip(p, axis[0], axis[-1]) for p, axis in zip(places, axes, strict=True)]
    if outside == "hold":
        found = _extended(method, axes, z, inside, orders)
        for one, order in zip(beyond, orders, strict=True):
            found[one & (order > 0)] = 0.0
        return found
    found = _extended(method, axes, z, places, orders)
    if outside == "refuse":
        found[np.any(beyond, axis=0)] = np.nan
    return found


def _extended(
    method: str, axes: list[Array], z: Array, places: list[Array], orders: Orders
) -> Array:
    if method == "linear":
        (x,), (p,) = axes, places
        slopes = np.append(np.diff(z) / np.diff(x), 0.0)
        slopes[-1] = slopes[-2]
        cell = np.clip(np.searchsorted(x, p, "right") - 1, 0, len(x) - 2)
        if orders[0]:
            return slopes[cell].copy()
        ends = z[cell] + slopes[cell] * (p - x[cell])
        return np.where((p < x[0]) | (p > x[-1]), ends, np.interp(p, x, z))
    if method == "pchip":
        return PchipInterpolator(axes[0], z)(places[0], orders[0], extrapolate=True)
    if method == "akima":
        return Akima1DInterpolator(axes[0], z)(places[0], orders[0], extrapolate=True)
    if method == "bilinear":
        return _bilinear(axes, z, places, orders)
    return _bicubic(axes, z, places, orders)


def _bilinear(axes: list[Array], z: Array, places: list[Array], orders: Orders) -> Array:
    """Along a line between points it is straight: its slope is a difference over one cell."""
    at = RegularGridInterpolator(tuple(axes), z, bounds_error=False, fill_value=None)
    ends = [[p, p] for p in places]
    width = np.ones_like(places[0])
    for axis, order in enumerate(orders):
        if order:
            x = axes[axis]
            cell = np.clip(np.searchsorted(x, places[axis], "right") - 1, 0, len(x) - 2)
            ends[axis] = [x[cell], x[cell + 1]]
            width = width * (x[cell + 1] - x[cell])
    if not any(orders):
        return at(tuple(places))
    signs = [(-1, 1) if order else (1,) for order in orders]
    total = np.zeros_like(places[0])
    for i, one in enumerate(signs[0]):
        for j, other in enumerate(signs[1]):
            total += one * other * at((ends[0][i], ends[1][j]))
    return total / width


def _bicubic(axes: list[Array], z: Array, places: list[Array], orders: Orders) -> Array:
    spline = RectBivariateSpline(*axes, z, kx=3, ky=3, s=0)
    inside = np.all([(p >= a[0]) & (p <= a[-1]) for p, a in zip(places, axes, strict=True)], axis=0)
    found = _as_tensor(spline, places, orders)
    found[inside] = spline.ev(places[0][inside], places[1][inside], *orders)
    return found


def _as_tensor(spline: RectBivariateSpline, places: list[Array], orders: Orders) -> Array:
    """Beyond the ends, where FITPACK stops: the products of B-splines, each of which goes on."""
    knots_x, knots_y, flat = spline.tck
    n, m = len(knots_x) - 4, len(knots_y) - 4
    along_x = BSpline(knots_x, np.eye(n), 3)(places[0], orders[0])
    along_y = BSpline(knots_y, np.eye(m), 3)(places[1], orders[1])
    return np.einsum("pi,ij,pj->p", along_x, flat.reshape(n, m), along_y, optimize=True)


def orders_of(method: str) -> list[Orders]:
    """Derivatives that are compared: of cubics higher ones, too."""
    if method == "linear":
        return [(0,), (1,)]
    over_two: list[Orders] = [(0, 0), (1, 0), (0, 1), (1, 1)]
    more: dict[str, list[Orders]] = {"bilinear": over_two, "bicubic": [*over_two, (2, 1)]}
    return more.get(method, [(0,), (1,), (2,), (3,)])


def off(found: Array, right: Array) -> float:
    """How far numbers are off, of the largest; infinite where they are not missing at the same places."""
    missing = np.isnan(right)
    if not np.array_equal(np.isnan(found), missing):
        return np.inf
    return float(np.abs(found - right)[~missing].max() / np.abs(right[~missing]).max())
