"""Lookup tables in laws, values, levels and sources, each with a run that is known by hand."""

from collections.abc import Mapping

import networkx as nx
import numpy as np
from references.build import bond_graph

import bondgraph as bg
from oracles.routes.kind import Array, Kind, stepwise


def _with(graph: nx.DiGraph, *tables: bg.LookupTable) -> nx.DiGraph:
    graph.graph["tables"] = list(tables)
    return graph


def tabled_resistance() -> Kind:
    """A mass from -1 on by a push of 4 over a table: 2 w below zero, w above, held from 3 on."""
    p, low = 4.0, 2.0
    goes = np.log1p(low / p) / low
    held = goes + np.log(p / (p - 3))
    drag = bg.LookupTable("drag", [-2, 0, 1, 3], [-4, 0, 1, 3])
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"),
             bg.R("b", flow="w", law="b*drag(w)")]  # fmt: skip

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"v": stepwise(t, (0, lambda s: p / low - (1 + p / low) * np.exp(-low * s)),
                              (goes, lambda s: -p * np.expm1(-s)),
                              (held, lambda s: 3 + (p - 3) * s))}  # fmt: skip

    return Kind("table in a resistance", _with(bond_graph(nodes, "push>n>m n>b"), drag),
                {"m": 1.0, "b": 1.0}, {"P": f"{p}"}, known, 2.5, {"v": -1.0}, at=0.6,
                rest={"inputs": {"P": 1.0}, "initial": {"v": 0.5}})  # fmt: skip


def tabled_storage() -> Kind:
    """A mass on a spring by a table, k on one side and 4 k on the other: half swings of two lengths."""
    k, v0 = 9.0, 0.5
    spring = bg.LookupTable("spring", [-1, 0, 2], [-4, 0, 2], outside="extend")
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"),
             bg.C("k", law="k*spring(q_k)")]  # fmt: skip
    soft, hard = np.sqrt(k), np.sqrt(4 * k)
    turns = np.pi / soft

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"v": stepwise(t, (0, lambda s: v0 * np.cos(soft * s)),
                              (turns, lambda s: -v0 * np.cos(hard * s)),
                              (turns + np.pi / hard, lambda s: v0 * np.cos(soft * s)))}  # fmt: skip

    return Kind("table in a storage", _with(bond_graph(nodes, "push>n>m n>k"), spring),
                {"m": 1.0, "k": k}, {"P": "0"}, known, 2.2, {"v": v0}, at=0.3,
                rest={"inputs": {"P": 1.0}, "initial": {"q_k": 0.1}})  # fmt: skip


def engine_map() -> Kind:
    """An engine's torque over speed and throttle: u (3 - w) up to a speed of 1, then u (4 - 2 w)."""
    u, J = 0.5, 0.25
    torque = bg.LookupTable("map", [0, 1, 2], [0, 1], [[0, 3], [0, 2], [0, 0]], method="bilinear")
    nodes = [bg.Se("engine", "map(w, u)"), bg.One("n"), bg.I("J", "J", flow="w")]
    rate = u / J
    bends = np.log(3 / 2) / rate

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"w": stepwise(t, (0, lambda s: -3 * np.expm1(-rate * s)),
                              (bends, lambda s: 2 - np.exp(-2 * rate * s)))}  # fmt: skip

    return Kind("map over two axes in a source", _with(bond_graph(nodes, "engine>n>J"), torque),
                {"J": J}, {"u": f"{u}"}, known, 1.0, at=0.1,
                rest={"inputs": {"u": u}, "initial": {"w": 1.8}})  # fmt: skip


def drive_cycle() -> Kind:
    """A push over time by a table of points: 0, from 1/2 on rising to 2, then 2, then back to 0 and held."""
    cycle = bg.LookupTable("cycle", [0.5, 1.5, 2.5, 3.5], [0, 2, 2, 0])
    nodes = [bg.Se("push", "cycle(t)"), bg.One("n"), bg.I("m", "m", flow="v"), bg.Se("load", "P")]

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"v": stepwise(t, (0, lambda s: 0 * s), (0.5, lambda s: s**2), (1.5, lambda s: 1 + 2 * s),
                              (2.5, lambda s: 3 + 2 * s - s**2), (3.5, lambda s: 4 + 0 * s))}  # fmt: skip

    return Kind("table over the time", _with(bond_graph(nodes, "push>n>m load>n"), cycle),
                {"m": 1.0}, {"P": "0"}, known, 4.0, at=1.75,
                rest={"inputs": {"P": 0.0}})  # fmt: skip


def tabled_ratio() -> Kind:
    """A mass behind a ratio that a spline of its place tells: energy stays, whatever the ratio."""
    J, m, w0 = 1.0, 2.0, 1.5
    q = np.linspace(-1, 3, 9)
    ratio = bg.LookupTable("ratio", q, 1 + 0.4 * np.sin(q), method="pchip", outside="extend")
    nodes = [bg.One("n"), bg.I("J", "J", flow="w"), bg.Df("angle", flow="w_seen", integrate="phi"),
             bg.TF("cam", "ratio(phi)"), bg.One("far"), bg.I("m", "m", priority=-1),
             bg.Se("T", "T")]  # fmt: skip

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        gain = _pchip(q, 1 + 0.4 * np.sin(q))(run["phi"])
        first = _pchip(q, 1 + 0.4 * np.sin(q))(0.0)
        return {"w": w0 * np.sqrt((J + m * first**2) / (J + m * gain**2))}

    return Kind("table in a ratio", _with(bond_graph(nodes, "T>n>J n>angle n>cam>far>m"), ratio),
                {"J": J, "m": m}, {"T": "0"}, known, 1.5, {"w": w0}, at=0.7,
                rest={"inputs": {"T": 0.0}, "initial": {"phi": 0.3}})  # fmt: skip


def _pchip(x: Array, z: Array) -> object:
    from scipy.interpolate import PchipInterpolator

    return PchipInterpolator(x, z)


def tabled_curve() -> Kind:
    """A block slides to rest on friction whose curve is a table: 2 - slip below 1, then 1."""
    m, v0 = 2.0, 3.0
    stribeck = bg.LookupTable("stribeck", [0, 1, 2], [2, 1, 1])
    friction = bg.DryFriction("F", "stribeck(slip)", tables=[stribeck])
    nodes = [
        bg.Se("push", "P"),
        bg.One("n"),
        bg.I("m", "m", flow="v"),
        bg.R("ground", law=friction),
    ]
    F = 1.0
    bends = m * (v0 - 1) / F
    # m v' = F (v - 2) from v = 1 on.
    rests = bends + m / F * np.log(2)

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"v": stepwise(t, (0, lambda s: v0 - F / m * s), (bends, lambda s: 2 - np.exp(F / m * s)),
                              (rests, lambda s: 0 * s))}  # fmt: skip

    return Kind("table as a friction curve", bond_graph(nodes, "push>n>m n>ground"),
                {"m": m, "F": F}, {"P": "0"}, known, 6.0, {"v": v0}, at=2.0,
                mode={"ground": "slip"}, rest={"inputs": {"P": 1.5}, "initial": {"v": 0.0}})  # fmt: skip


def tabled_level() -> Kind:
    """A brake whose level a table of the place tells: F (1 - x/4) to rest."""
    m, v0, F = 1.0, 0.5, 1.0
    grip = bg.LookupTable("grip", [0, 4], [1, 0], outside="refuse")
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"),
             bg.Df("place", flow="v_seen", integrate="x"),
             bg.R("brake", law=bg.DryFriction(grip("x")))]  # fmt: skip
    w = np.sqrt(F / 4 / m)

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        # x" = w^2 (x - 4), from 0 at v0.
        rests = np.arctanh(v0 / (4 * w)) / w
        return {"v": stepwise(t, (0, lambda s: v0 * np.cosh(w * s) - 4 * w * np.sinh(w * s)),
                              (rests, lambda s: 0 * s))}  # fmt: skip

    return Kind("table as a friction level", bond_graph(nodes, "push>n>m n>place n>brake"),
                {"m": m}, {"P": "0"}, known, 0.8, {"v": v0}, at=0.2,
                mode={"brake": "slip"}, rest={"inputs": {"P": 0.1}})  # fmt: skip


TABLED = (
    tabled_resistance, tabled_storage, engine_map, drive_cycle, tabled_ratio, tabled_curve, tabled_level,
)  # fmt: skip
