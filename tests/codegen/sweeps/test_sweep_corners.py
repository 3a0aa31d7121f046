"""Sweeps of models whose laws have corners: in C as in numpy, and as closed forms say."""

import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph

import bondgraph as bg
import codegen
from codegen import Family, sweep

q = sp.Symbol("q_s")
STIFF = (1.0, 4.0, 9.0)


@pytest.mark.usefixtures("closely")
@pytest.mark.parametrize("backend", codegen.simulate.BACKENDS)
def test_corners_are_located_and_counted_in_every_run(backend: str) -> None:
    """Springs of 1 below zero and k above: half periods of pi and pi/sqrt(k), from v = 1."""
    spring = sp.Piecewise((sp.Symbol("k") * q, q > 0), (q, True))
    nodes = [bg.One("n"), bg.I("m", 1, flow="v"), bg.C("s", law=spring)]
    family = Family(bg.derive(bond_graph(nodes, "n>m n>s")), {"k": 1.0}, backend=backend)
    end = 2 * np.pi + 1.0
    found = sweep(
        family, {"k": STIFF}, [0.0, end],
        {
            "v": codegen.final("v"), "first": codegen.first_event("s", "corner"),
            "count": codegen.event_count("s", "corner"), "none": codegen.event_count("n", "corner"),
        },
        initial={"v": 1.0}, progress=False, workers=0,
    )  # fmt: skip
    for k, v, first, count, none in zip(
        STIFF, *(found[name] for name in ("v", "first", "count", "none")), strict=True
    ):
        up = np.pi / np.sqrt(k)
        period = up + np.pi
        left = end % period
        speed = np.cos(left * np.sqrt(k)) if left < up else -np.cos(left - up)
        assert v == pytest.approx(speed, abs=2e-9)
        assert first == pytest.approx(up, abs=1e-9)
        assert count == 2 * (end // period) + (left > up)
        assert none == 0
