"""Functions of laws without a branch: as exact as told, and their polynomials worked out anew."""

import re
from collections.abc import Callable
from typing import Any

import mpmath as mp
import numpy as np
import pytest

from codegen.c.runtime import runtime_file
from codegen.engine.build import compiled, loaded

NAMES = ("atan", "sin", "cos", "exp", "log", "tanh")
HEADER = "lanes_functions.h"
CALLING = f'#include "{HEADER}"\n' + "".join(
    f"void each_{name}(const double *x, double *y, int count)\n"
    f"{{ for (int i = 0; i < count; i++) y[i] = bg_lane_{name}(x[i]); }}\n"
    for name in NAMES
)
DECLARED = "".join(f"void each_{name}(const double *x, double *y, int count);\n" for name in NAMES)


@pytest.fixture(scope="module")
def called() -> Callable[[str, Any], Any]:
    library = compiled({HEADER: runtime_file(HEADER), "calling.c": CALLING})
    ffi, opened = loaded(library, DECLARED)

    def call(name: str, values: Any) -> Any:
        x = np.ascontiguousarray(values, dtype=float)
        y = np.empty_like(x)
        at = [ffi.cast("double *", one.ctypes.data) for one in (x, y)]
        getattr(opened, f"each_{name}")(*at, len(x))
        return y

    return call


def _places(name: str) -> Any:
    """Numbers of every size that a function has values for."""
    rng = np.random.default_rng(7)
    wide = np.concatenate(
        [rng.uniform(-3, 3, 400), rng.standard_normal(400) * 10.0 ** rng.uniform(-20, 4.5, 400)]
    )
    return {
        "atan": np.concatenate([wide, 10.0 ** rng.uniform(4, 300, 100)]),
        "exp": np.concatenate([rng.uniform(-707, 708, 400), wide[abs(wide) < 700]]),
        "log": np.concatenate([abs(wide), 10.0 ** rng.uniform(-300, 300, 400)]),
    }.get(name, wide[abs(wide) < 1e5])


@pytest.mark.parametrize("name", NAMES)
def test_each_is_within_two_units_in_the_last_place(name: str, called: Any) -> None:
    x = _places(name)
    with mp.workprec(150):
        for at, found in zip(x, called(name, x), strict=True):
            exact = getattr(mp, name)(mp.mpf(float(at)))
            unit = np.spacing(abs(float(exact)))
            assert abs(mp.mpf(float(found)) - exact) < 2 * unit, at


def test_what_is_beyond_is_no_number_or_a_limit(called: Any) -> None:
    inf, nan = np.inf, np.nan
    assert np.isnan(called("sin", [2e5, inf, nan])).all()
    assert np.isnan(called("cos", [-2e5, -inf, nan])).all()
    assert np.isnan(called("log", [0.0, -1.0, inf, nan])).all()
    assert called("exp", [0.0, -800.0, -inf, 800.0, inf]).tolist() == [1.0, 0.0, 0.0, inf, inf]
    assert called("tanh", [0.0, 50.0, -inf]).tolist() == [0.0, 1.0, -1.0]
    assert called("atan", [0.0, inf, -inf]) == pytest.approx([0.0, np.pi / 2, -np.pi / 2])
    assert np.isnan([*called("exp", [nan]), *called("tanh", [nan]), *called("atan", [nan])]).all()


def _interpolant(function: Callable[[Any], Any], low: Any, high: Any, count: int) -> list[float]:
    """The coefficients, lowest first, of the polynomial through so many of Chebyshev's points."""
    angles = [mp.pi * (2 * k + 1) / (2 * count) for k in range(count)]
    points = [(low + high) / 2 + (high - low) / 2 * mp.cos(angle) for angle in angles]
    rows = mp.matrix([[point**power for power in range(count)] for point in points])
    values = mp.matrix([function(point) for point in points])
    return [float(one) for one in mp.lu_solve(rows, values)]


def _over(function: Callable[[Any], Any], first: Any, limit: Any) -> Callable[[Any], Any]:
    """``(f(s)/s - first)/z`` with ``z = s^2``, which is what is left of an odd function; its limit at 0."""
    return lambda z: limit if abs(z) < 1e-25 else (function(mp.sqrt(z)) / mp.sqrt(z) - first) / z


def test_polynomials_are_interpolants_at_chebyshevs_points() -> None:
    text = runtime_file(HEADER)
    known = {abs(float(one)) for one in re.findall(r"\d\.\d+(?:e-?\d+)?", text)}
    with mp.workdps(60):
        eighth, quarter = mp.tan(mp.pi / 8) ** 2, (mp.pi / 4) ** 2
        root = ((mp.sqrt(2) - 1) / (mp.sqrt(2) + 1)) ** 2
        half = mp.log(2) / 2
        polynomials = [
            _interpolant(_over(mp.atan, 1, -mp.mpf(1) / 3), mp.mpf(0), eighth, 12),
            _interpolant(_over(mp.sin, 1, -mp.mpf(1) / 6), mp.mpf(0), quarter, 7),
            _interpolant(_over(mp.tanh, 1, -mp.mpf(1) / 3), mp.mpf(0), mp.mpf(1) / 4, 10),
            _interpolant(_over(lambda s: 2 * mp.atanh(s), 2, mp.mpf(2) / 3), mp.mpf(0), root, 8),
            _interpolant(
                lambda z: (mp.cos(mp.sqrt(z)) - 1 + z / 2) / z**2, mp.mpf(0), quarter, 6
            ),
            _interpolant(
                lambda x: mp.mpf(1) / 2 if abs(x) < 1e-25 else (mp.exp(x) - 1 - x) / x**2,
                -half, half, 11,
            ),
        ]  # fmt: skip
    for polynomial in polynomials:
        for one in polynomial:
            assert any(abs(one) == pytest.approx(each, rel=1e-12) for each in known), one
