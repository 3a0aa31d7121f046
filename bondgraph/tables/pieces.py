"""The polynomials between a table's points, by scipy's interpolators."""

import math
from collections.abc import Hashable
from functools import lru_cache
from typing import Any, Protocol

from bondgraph.tables.looking import Patches


class Points(Hashable, Protocol):
    """What a table's polynomials come of."""

    @property
    def axes(self) -> tuple[tuple[float, ...], ...]:
        """The points along each axis."""

    @property
    def values(self) -> tuple[float, ...]:
        """Row by row."""

    @property
    def method(self) -> str:
        """By what name scipy's way is asked for."""

    @property
    def outside(self) -> str:
        """What is beyond the ends."""


@lru_cache(maxsize=64)
def pieces(table: Points) -> Patches:
    """Breaks, degree and coefficients as `looked_up` takes them; the last ones are kept.

    "linear" has numpy's slopes, "pchip" (Fritsch and Butland 1984) and "akima" (Akima 1970) scipy's cubics,
    "bicubic" the cubic spline without knots beside the ends that `RectBivariateSpline` finds with ``s=0``.
    """
    # numpy and scipy are loaded only when numbers are asked for.
    import numpy as np

    z = np.array(table.values).reshape([len(axis) for axis in table.axes])
    axes = [np.array(axis) for axis in table.axes]
    make = {"linear": _linear, "bilinear": _bilinear, "bicubic": _bicubic}.get(table.method, _cubic)
    breaks, factors = make(table.method, axes, z)
    told = tuple(tuple(one.tolist()) for one in breaks)
    degree = 1 if table.method in ("linear", "bilinear") else 3
    return told, degree, table.outside, tuple(factors.ravel().tolist())


def _linear(method: str, axes: list[Any], z: Any) -> tuple[list[Any], Any]:
    import numpy as np

    return axes, np.stack([np.diff(z) / np.diff(axes[0]), z[:-1]], axis=1)


def _cubic(method: str, axes: list[Any], z: Any) -> tuple[list[Any], Any]:
    from scipy.interpolate import Akima1DInterpolator, PchipInterpolator

    made = (PchipInterpolator if method == "pchip" else Akima1DInterpolator)(axes[0], z)
    return axes, made.c.T


def _bilinear(method: str, axes: list[Any], z: Any) -> tuple[list[Any], Any]:
    import numpy as np

    x, y = axes
    along_x = np.diff(z, axis=0) / np.diff(x)[:, None]
    along_y = np.diff(z, axis=1) / np.diff(y)[None, :]
    both = np.diff(along_x, axis=1) / np.diff(y)[None, :]
    above = np.stack([both, along_x[:, :-1]], axis=-1)
    below = np.stack([along_y[:-1], z[:-1, :-1]], axis=-1)
    return axes, np.stack([above, below], axis=-2)


def _bicubic(method: str, axes: list[Any], z: Any) -> tuple[list[Any], Any]:
    """The spline's B-splines as polynomials, along x and then along y."""
    import numpy as np
    from scipy.interpolate import RectBivariateSpline

    made: Any = RectBivariateSpline
    knots_x, knots_y, flat = made(*axes, z, kx=3, ky=3, s=0).tck
    rows = flat.reshape(len(knots_x) - 4, len(knots_y) - 4)
    breaks_x, along_x = _powers(knots_x, rows)
    breaks_y, both = _powers(knots_y, np.moveaxis(along_x, 2, 0))
    # Powers and cells of y, then those of x: cells first, then powers.
    return [breaks_x, breaks_y], np.transpose(both, (3, 1, 2, 0))


def _powers(knots: Any, rows: Any) -> tuple[Any, Any]:
    """Breaks, and powers by cells of splines whose factors are along the first axis, by Taylor."""
    import numpy as np
    from scipy.interpolate import BSpline

    spline, breaks = BSpline(knots, rows, 3), np.unique(knots)
    return breaks, np.stack([spline(breaks[:-1], p) / math.factorial(p) for p in (3, 2, 1, 0)])
