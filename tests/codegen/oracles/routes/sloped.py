"""Ports held where laws of states move with them, each with a run that is known by hand."""

from collections.abc import Mapping

import numpy as np
from references.build import bond_graph

import bondgraph as bg
from oracles.routes.kind import Array, Kind, stepwise

LEVEL, PULL = 0.8, 0.5


def bent_level() -> Kind:
    """A spring pulled at 1 on a slider of level 1 + p^2, p = 1 - t: F = 10 t until it is that."""
    nodes = [bg.Sf("pull", "v"), bg.One("j"), bg.Zero("z"), bg.C("spring", "1/k", effort="F"),
             bg.R("rub", flow="s", law=bg.DryFriction("1 + p**2")), bg.Zero("tank"),
             bg.C("volume", 1, effort="p"), bg.Sf("fill", "q")]  # fmt: skip

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"p": 1 - t, "F": np.where(6 - np.sqrt(34) > t, 10 * t, 1 + (1 - t) ** 2)}

    return Kind(
        "its level a nonlinear law of a state, on a spring",
        bond_graph(nodes, "pull>j j>z z>spring z>rub fill>tank>volume"), {"k": 10.0},
        {"v": "1", "q": "-1"}, known, 2.0, {"p": 1.0}, at=0.5, mode={"rub": "slip"},
        rest={"inputs": {"v": 0.0, "q": 0.0}},
    )  # fmt: skip


def ruled_flow() -> Kind:
    """A mass on a belt of speed v^2/4 + t/2: v = 2 - 2 sqrt(1 - t/2), until that takes all of L.

    Then v' = L; the belt runs away.
    """
    nodes = [bg.One("n"), bg.I("m", "m", flow="v"), bg.Se("push", "P"), bg.Zero("z"),
             bg.R("belt", gives="flow", flow="w", law="v**2/4 + q"),
             bg.R("rub", effort="f", law=bg.DryFriction("L"))]  # fmt: skip
    goes = (1 - (PULL / LEVEL) ** 2) / PULL

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        left = np.sqrt(np.maximum(1 - PULL * t, (PULL / LEVEL) ** 2))
        return {"v": 2 - 2 * left + stepwise(t, (goes, lambda s: LEVEL * s))}

    return Kind(
        "held against a flow that a law of states gives",
        bond_graph(nodes, "push>n>m n>z z>belt z>rub"), {"m": 1.0, "L": LEVEL},
        {"P": "0", "q": f"ramp(0, {PULL})"}, known, 1.8, at=0.6, mode={"rub": "stick"},
        rest={"inputs": {"P": 0.2, "q": 0.0}},
    )  # fmt: skip


SLOPED = (bent_level, ruled_flow)
