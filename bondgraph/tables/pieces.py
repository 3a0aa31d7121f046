"""The polynomials between a table's points, by scipy's interpolators."""

import math
from collections.abc import Hashable
from functools import lru_cache
from typing import Any, Protocol

from bondgraph.tables.looking import BACK, Patches

TURNED = -3
"""In place of a degree: the cubic of a cell is solved, `backward` tells how."""


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

    A method that ends with `BACK` is that of the table which this one is turned round of, as `looked_back`
    takes it. "linear" has numpy's slopes, "pchip" (Fritsch and Butland 1984) and "akima" (Akima 1970)
    scipy's cubics, "bicubic" the cubic spline without knots beside the ends that `RectBivariateSpline` finds
    with ``s=0``.
    """
    # numpy and scipy are loaded only when numbers are asked for.
    import numpy as np

    z = np.array(table.values).reshape([len(axis) for axis in table.axes])
    axes = [np.array(axis) for axis in table.axes]
    if table.method.endswith(BACK):
        found = _turned(table.method.removesuffix(BACK), axes[0], z)
        return table.axes, TURNED, table.outside, tuple(found.ravel().tolist())
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


def _turned(method: str, z: Any, x: Any) -> Any:
    """Of each cell of the table that has these values z at places x, from the lower value on."""
    import numpy as np

    falls = bool(x[0] > x[-1])
    way = -1 if falls else 1
    _, factors = _cubic(method, [x[::way]], z[::way])
    if falls:
        # Those about the other end of each cell.
        c3, c2, c1, _ = factors[::-1].T
        h = x[:-1] - x[1:]
        factors = np.stack([c3, c2 + 3 * c3 * h, c1 + (2 * c2 + 3 * c3 * h) * h, h], axis=1)
    return np.concatenate([factors[:, :3], x[:-1, None]], axis=1)


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
