"""A law with a corner, with a run that is known by hand: what is on either side, joined there."""

from collections.abc import Mapping

import numpy as np
from references.build import bond_graph

import bondgraph as bg
from oracles.routes.kind import Array, Kind, stepwise


def one_way_damper() -> Kind:
    """A mass pushed by 1 from -1, damped one way only: v = t - 1, then 1 - exp(1 - t)."""
    nodes = [
        bg.Se("push", "F"),
        bg.One("n"),
        bg.I("m", "m", flow="v"),
        bg.R("valve", law="b*Max(v, 0)"),
    ]

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"v": stepwise(t, (0.0, lambda s: s - 1), (1.0, lambda s: -np.expm1(-s)))}

    return Kind(
        "damped one way: a law with a corner", bond_graph(nodes, "push>n>m n>valve"),
        {"m": 1.0, "b": 1.0}, {"F": "1"}, known, 3.0, {"v": -1.0}, at=2.0,
        rest={"inputs": {"F": 1.0}, "initial": {"v": 0.5}},
    )  # fmt: skip


CORNERED = (one_way_damper,)
