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


def staircase() -> Kind:
    """Held by a quarter for each quarter of speed: v' = 1.1 - k/4 - v from k/4 on, for k = 0, 1, 2."""
    F, h = 1.1, 0.25
    nodes = [bg.Se("push", "F"), bg.One("n"), bg.I("m", "m", flow="v"),
             bg.R("stairs", law="b*v + h*floor(v/h)")]  # fmt: skip
    first = np.log(F / (F - h))
    second = first + np.log((F - 2 * h) / (F - 3 * h))

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        steps = [(at, lambda s, k=k: F - k * h - (F - 2 * k * h) * np.exp(-s))
                 for k, at in enumerate([0.0, first, second])]  # fmt: skip
        return {"v": stepwise(t, *steps)}

    return Kind("steps of a speed: a law of floor", bond_graph(nodes, "push>n>m n>stairs"),
                {"m": 1.0, "b": 1.0, "h": h}, {"F": f"{F}"}, known, 2.0, at=0.5,
                rest={"inputs": {"F": 0.6}, "initial": {"v": 0.3}})  # fmt: skip


def per_turn() -> Kind:
    """A push that grows over each turn of a shaft and then begins anew: v = int mod(w t, 1) dt."""
    nodes = [bg.Sf("turn", "w"), bg.One("a"), bg.Df("angle", integrate="theta"),
             bg.Se("cam", "F*mod(theta, one)"), bg.One("n"), bg.I("m", "m", flow="v")]  # fmt: skip

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        turns = np.floor(3 * t)
        return {"v": (turns + (3 * t - turns) ** 2) / 6}

    return Kind("a push per turn: a law of mod", bond_graph(nodes, "turn>a>angle cam>n>m"),
                {"m": 2.0, "F": 2.0, "one": 1.0}, {"w": "3"}, known, 1.2, at=0.5,
                rest={"inputs": {"w": 0.0}})  # fmt: skip


CORNERED = (one_way_damper, staircase, per_turn)
