"""Rigid stops: what falls on one bounces on, or stays there until it is pulled off."""

from collections.abc import Mapping

import numpy as np
from references.build import bond_graph

import bondgraph as bg
from oracles.routes.kind import Array, Kind, stepwise


def _falling(**told: object):
    """A mass under a force that falls on a floor."""
    nodes = [
        bg.Se("F", "F"), bg.One("n"), bg.I("m", "m", flow="v"),
        bg.Stop("floor", **told),
    ]  # fmt: skip
    return bond_graph(nodes, "F>n>m n>floor")


def rigid_stop() -> Kind:
    """From 5 m, as the stop tells, under 10 m/s^2: at the floor at 1 s with 10 m/s, and 2 e^k s later."""
    m, e, g, height = 2.0, 0.8, 10.0, 5.0

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        parts, begin = [(0.0, lambda s: height - g * s**2 / 2)], 1.0
        for k in range(1, 5):
            parts.append((begin, lambda s, v=10 * e**k: v * s - g * s**2 / 2))
            begin += 2 * e**k
        return {"q_floor": stepwise(t, *parts)}

    return Kind(
        "rigid stop", _falling(restitution="e", start="h"), {"h": height, "m": m, "e": e},
        {"F": f"{-m * g}"}, known, 4.9, on=("floor",), at=0.5, mode={"floor": "apart"},
        rest={"inputs": {"F": 0.0}, "initial": {"q_floor": 1.0}},
    )  # fmt: skip


def plastic_stop() -> Kind:
    """From 5 m under 10 m/s^2: at the floor at 1 s, where it stays until the force turns at 2.5 s."""
    m, g, height, turns = 2.0, 10.0, 5.0, 2.5

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {
            "q_floor": stepwise(t, (0, lambda s: height - g * s**2 / 2), (1.0, np.zeros_like),
                                (turns, lambda s: g / 2 * s**2 / 2)),
            "v": stepwise(t, (0, lambda s: -g * s), (1.0, np.zeros_like), (turns, lambda s: g / 2 * s)),
        }  # fmt: skip

    return Kind(
        "rigid stop, plastic", _falling(), {"m": m}, {"F": f"step({turns}, {m * g / 2}, {-m * g})"},
        known, 4.03, {"q_floor": height}, on=("floor",), at=1.7, mode={"floor": "touch"},
        rest={"inputs": {"F": -m * g}, "initial": {"q_floor": 0.0}},
    )  # fmt: skip


STOPS = (rigid_stop, plastic_stop)
