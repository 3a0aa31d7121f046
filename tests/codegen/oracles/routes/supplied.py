"""Models whose values read an input: valves, storages that are filled, ratios that are moved."""

from collections.abc import Mapping

import numpy as np
from references.build import bond_graph

import bondgraph as bg
from oracles.routes.kind import Array, Kind, relaxed, stepwise

EDGE = 0.503
"""[s], at which inputs step; no sample and no fixed step is there."""

STEP = f"step({EDGE}, 1)"


def valve() -> Kind:
    """A tank at a constant flow over a valve that is half closed: its pressure goes from 2 R to 4 R."""
    nodes = [bg.Sf("pump", "Q"), bg.Zero("tank"), bg.C("c", "c", effort="p"),
             bg.R("out", "r*(1 + closed)")]  # fmt: skip

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        half = relaxed(t - EDGE, float(2 * -np.expm1(-EDGE / 0.2)), 0.4, [(0.0, 4.0)])
        return {"p": np.where(t < EDGE, -2 * np.expm1(-t / 0.2), half)}

    return Kind(
        "valve that an input opens", bond_graph(nodes, "pump>tank>c tank>out"), {"c": 0.2, "r": 1.0},
        {"Q": "2", "closed": STEP}, known, 1.0, at=0.3, read=("closed",),
        rest={"inputs": {"Q": 2.0, "closed": 0.5}},
    )  # fmt: skip


def filled() -> Kind:
    """A cart whose mass an input doubles: it halves its speed, and its drag takes twice as long."""
    nodes = [
        bg.Se("push", "P"),
        bg.One("cart"),
        bg.I("m", "m*(1 + load)", flow="v"),
        bg.R("b", "b"),
    ]
    tau, level = 0.5, 3.0

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        met = level * -np.expm1(-EDGE / tau)
        late = level + (met / 2 - level) * np.exp(-(t - EDGE) / (2 * tau))
        v = np.where(t < EDGE, -level * np.expm1(-t / tau), late)
        return {"p_m": v * np.where(t < EDGE, 1.0, 2.0)}

    return Kind(
        "mass that an input fills", bond_graph(nodes, "push>cart>m cart>b"), {"m": 1.0, "b": 2.0},
        {"P": "6", "load": STEP}, known, 1.0, at=0.3, read=("load",),
        rest={"inputs": {"P": 1.0, "load": 0.0}},
    )  # fmt: skip


def filled_behind() -> Kind:
    """The mass behind a gear is filled: J w + n m (1 + load) n w = T t, whatever the load does."""
    nodes = [bg.Se("drive", "T"), bg.One("shaft"), bg.I("J", "J", flow="w", priority=1), bg.TF("gear", "n"),
             bg.One("out"), bg.I("m", "m*(1 + load)", flow="v")]  # fmt: skip

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"p_J": 3.0 * t}

    return Kind(
        "mass behind a gear that an input fills", bond_graph(nodes, "drive>shaft>J shaft>gear>out>m"),
        {"J": 1.0, "n": 0.5, "m": 4.0}, {"T": "3", "load": STEP}, known, 1.0, at=0.3, read=("load",),
        rest={"inputs": {"T": 0.0, "load": 0.0}},
    )  # fmt: skip


def braked_while_filled() -> Kind:
    """A cart that is filled and braked: its momentum falls by the brake's force until it rests."""
    nodes = [bg.Se("push", "P"), bg.One("cart"), bg.I("m", "m*(1 + load)", flow="v"),
             bg.R("rub", law=bg.DryFriction("N"))]  # fmt: skip

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"p_m": np.maximum(2.0 - 2.5 * t, 0)}

    return Kind(
        "mass that is filled and braked", bond_graph(nodes, "push>cart>m cart>rub"), {"m": 2.0, "N": 3.0},
        {"P": "0.5", "load": STEP}, known, 1.0, {"p_m": 2.0}, at=0.3, mode={"rub": "slip"},
        read=("load",), rest={"inputs": {"P": 0.0, "load": 0.0}},
    )  # fmt: skip


def shifted() -> Kind:
    """A ratio that an input moves turns a flywheel's energy over to a mass: (J + m n^2) w^2 stays."""
    nodes = [bg.One("shaft"), bg.I("J", "J", flow="w", priority=1), bg.TF("gear", "n*(1 + shift)"),
             bg.One("out"), bg.I("m", "m", flow="v"), bg.Se("drive", "T")]  # fmt: skip

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"w": 2 * np.sqrt((1 + 2 * 0.25) / (1 + 2 * (0.5 * (1 + t)) ** 2))}

    return Kind(
        "ratio that an input moves", bond_graph(nodes, "drive>shaft>J shaft>gear>out>m"),
        {"J": 1.0, "n": 0.5, "m": 2.0}, {"T": "0", "shift": "ramp(0, 1)"}, known, 1.0, {"w": 2.0}, at=0.3,
        read=("shift",), rest={"inputs": {"T": 0.0, "shift": 0.0}},
    )  # fmt: skip


def gyrated() -> Kind:
    """A gyrator whose ratio steps turns two like flywheels' speeds round, faster from there on."""
    nodes = [bg.One("a"), bg.I("J_1", "J", flow="w_1"), bg.GY("gyrator", "g*(1 + more)"), bg.One("b"),
             bg.I("J_2", "J", flow="w_2")]  # fmt: skip

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        angle = stepwise(t, (0.0, lambda s: 2 * s), (EDGE, lambda s: 2 * EDGE + 4 * s))
        return {"w_1": np.cos(angle), "w_2": np.sin(angle)}

    return Kind(
        "gyrator that an input rules", bond_graph(nodes, "a>J_1 a>gyrator>b>J_2"), {"J": 1.0, "g": 2.0},
        {"more": STEP}, known, 1.0, {"w_1": 1.0}, at=0.3, read=("more",), rest={"inputs": {"more": 0.0}},
    )  # fmt: skip


SUPPLIED = (valve, filled, filled_behind, braked_while_filled, shifted, gyrated)
