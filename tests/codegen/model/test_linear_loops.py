"""Two functions that determine one another, linear: every way of running solves them.

x' = u - x, y = c x + d u, u = k (ref - y): so (1 + k d) u = k (ref - c x), a lag with a gain.
"""

import numpy as np
import pytest

import bondgraph as bg
import codegen

TIMES = np.linspace(0.0, 2.0, 21)

GAINS = [(2.0, 0.5), (2.0, -0.3), (30.0, 0.5), (1.3, -3.0), (0.1, 1e4)]


def _equations() -> bg.StateEquations:
    nodes = [bg.State("x", "u - x"), bg.Function("y", "c*x + d*u"), bg.Function("u", "k*(ref - y)")]
    return bg.derive(bg.graph(nodes))


def _known(k: float, d: float, c: float, ref: float) -> np.ndarray:
    gain = k / (1 + k * d)
    rate = 1 + gain * c
    return gain * ref / rate * (1 - np.exp(-rate * TIMES))


@pytest.mark.parametrize(("k", "d"), GAINS)
@pytest.mark.parametrize(
    ("backend", "method"),
    [("numpy", "exact"), ("numpy", "DOP853"), ("c", "exact"), ("c", "DOP853")],
)
def test_runs(k: float, d: float, backend: str, method: str) -> None:
    ready = codegen.simulator(_equations(), {"k": k, "d": d, "c": 1.0}, backend=backend)
    run = ready.run(TIMES, inputs={"ref": 3.0}, method=method)
    right = _known(k, d, 1.0, 3.0)
    assert np.abs(run["x"] - right).max() <= 1e-7 * np.abs(right).max()


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_sweeps(backend: str) -> None:
    family = codegen.Family(_equations(), {"k": 2.0, "d": 0.5, "c": 1.0}, backend=backend)
    found = codegen.sweep(
        family, codegen.Table(k=[k for k, _ in GAINS], d=[d for _, d in GAINS]), TIMES,
        {"x": codegen.samples("x")}, inputs={"ref": 3.0}, workers=0, progress=False,
    )  # fmt: skip
    for row, (k, d) in zip(found["x"], GAINS, strict=True):
        right = _known(k, d, 1.0, 3.0)
        assert np.abs(row - right).max() <= 1e-7 * np.abs(right).max()
