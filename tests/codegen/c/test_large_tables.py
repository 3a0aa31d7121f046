"""Products of large tables in C: by lists of what is not zero, or whole where most of it is not."""

from pathlib import Path

import numpy as np
import pytest
from oracles.c_model import Pair
from oracles.many import chain
from references.build import bond_graph

import bondgraph as bg


def _star(count: int) -> bg.StateEquations:
    """Inertances side by side behind one resistance, with friction on the first: every one moves all."""
    rubbing = bg.DryFriction("1 + P/4")
    nodes = [
        bg.Sf("source", "P"),
        bg.Zero("node"),
        bg.R("r", 2.0),
        bg.One("v0"),
        bg.R("b", law=rubbing),
    ]
    bonds = ["source>node>r", "node>v0>m0", "v0>b"]
    nodes += [bg.I(f"m{k}", 1 + 0.1 * k, flow=f"w{k}") for k in range(count)]
    bonds += [f"node>m{k}" for k in range(1, count)]
    return bg.derive(bond_graph(nodes, " ".join(bonds)))


@pytest.mark.parametrize("kind", ["few", "most"])
def test_an_instant_is_that_of_numpy(kind: str, tmp_path: Path) -> None:
    """Of a chain few entries are not zero, of a star most; in modes that hold and that slip."""
    equations = bg.derive(chain(70).graph) if kind == "few" else _star(70)
    pair, rng = Pair(tmp_path, equations, {}), np.random.default_rng(7)
    size, ports = pair.c.size, len(pair.program.friction)
    assert size >= 70
    for _ in range(4):
        s, w, dw = rng.normal(size=size), rng.normal(size=1), rng.normal(size=1)
        mode = tuple(rng.integers(-1, 2, size=ports).tolist())
        expected = pair.closed.evaluate(0.0, s, w, dw, mode)
        status, (x, _, u, du, y, rate, caps, _) = pair.c.evaluate(0.0, s, w, dw, mode)
        assert status == 0
        for found, wanted in (
            (x, expected.x), (u, expected.u), (du, expected.du), (y, expected.y),
            (rate, expected.rate), (caps, expected.caps),
        ):  # fmt: skip
            assert np.abs(found - wanted).max() <= 1e-12 * np.abs(wanted).max() + 1e-15
