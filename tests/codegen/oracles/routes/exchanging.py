"""Impulses among storages whose laws bend: what these hold is kept, as scipy finds it."""

from collections.abc import Mapping

import numpy as np
from references.build import bond_graph
from scipy.optimize import brentq

import bondgraph as bg
from oracles.routes.kind import Array, Kind, stepwise
from oracles.routes.switches import GATE


def meshed_shafts() -> Kind:
    """Two shafts whose laws harden, one from 0.3 to 0.7 s: p_1 + p_2 stays as the dog closes; T turns one."""
    J, c, T = 2.0, 0.4, 4.0
    nodes = [bg.Se("T", "T"), bg.One("a"), bg.I("J_1", law="sinh(p_J_1)", flow="w_1"), bg.Zero("gap"),
             bg.Sw("dog", on="0.5 - gate"), bg.One("b"),
             bg.I("J_2", law="p_J_2/J + c*p_J_2**3", flow="w_2")]  # fmt: skip

    def second(w: float) -> float:
        return brentq(lambda p: p / J + c * p**3 - w, -9, 9, xtol=1e-14)

    def meets(p: float) -> float:
        return brentq(lambda w: np.arcsinh(w) + second(w) - p, -99, 99, xtol=1e-14)

    first = np.arcsinh(2.0)
    both = first + second(-1.0)

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        together = np.array([meets(both + T * one) for one in t])
        w = meets(both + T * 0.7)
        left = np.arcsinh(w)
        return {
            "w_1": np.where((t >= 0.3) & (t < 0.7), together,
                            stepwise(t, (0, lambda s: np.sinh(first + T * s)),
                                     (0.7, lambda s: np.sinh(left + T * s)))),
            "w_2": np.where(t < 0.3, -1.0, np.where(t < 0.7, together, w)),
        }  # fmt: skip

    return Kind(
        "dog between two nonlinear inertias", bond_graph(nodes, "T>a>J_1 a>gap>b>J_2 gap>dog"),
        {"J": J, "c": c}, {"T": f"{T}", "gate": GATE}, known, 0.99, {"w_1": 2.0, "w_2": -1.0},
        on=("dog",), at=0.4, mode={"dog": "off"}, rest={"inputs": {"T": 0.0, "gate": 1.0}},
    )  # fmt: skip


def joined_cells() -> Kind:
    """A cell by points that is charged, and from 0.4 s on another by a law: the charge of both stays."""
    held, rests, k, c, i = [0.0, 1.0, 3.0, 6.0], [1.0, 2.0, 2.5, 5.0], 0.5, 0.2, 3.0
    nodes = [
        bg.Sf("charger", "i"),
        bg.Zero("n"),
        bg.C("a", law="rest(q_a)", effort="u"),
        bg.One("wire"),
        bg.Sw("key", on="gate - 0.5"),
        bg.Zero("m"),
        bg.C("b", law="k*q_b + c*q_b**3", effort="v"),
    ]
    graph = bond_graph(nodes, "charger>n>a n>wire>key wire>m>b")  # fmt: skip
    graph.graph["tables"] = [bg.LookupTable("rest", held, rests, outside="extend")]

    def both(u: float) -> float:
        return np.interp(u, rests, held) + brentq(lambda q: k * q + c * q**3 - u, 0, 10, xtol=1e-14)

    u0, v0 = 1.4, 0.7
    begun = np.interp(u0, rests, held) + brentq(lambda q: k * q + c * q**3 - v0, 0, 10, xtol=1e-14)

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        shared = [brentq(lambda u, q=begun + i * s: both(u) - q, 0, 9, xtol=1e-14) for s in t]
        alone = np.interp(np.interp(u0, rests, held) + i * t, held, rests)
        return {"u": np.where(t < 0.4, alone, shared), "v": np.where(t < 0.4, v0, shared)}

    return Kind(
        "key between two nonlinear capacitors, one by a table", graph, {"k": k, "c": c},
        {"i": f"{i}", "gate": "step(0.4, 1, 0)"}, known, 0.99, {"u": u0, "v": v0}, at=0.3,
        mode={"key": "off"}, rest={"inputs": {"i": 0.0, "gate": 0.0}, "initial": {"u": u0, "v": v0}},
    )  # fmt: skip


def geared_behind() -> Kind:
    """A dog onto a shaft that drives an inertia by a gear, both nonlinear: p_1 + p_2/i + p_3 stays."""
    J, J3, c, i, T = 1.0, 2.0, 0.3, 0.5, 4.0
    nodes = [bg.Se("T", "T"), bg.One("a"), bg.I("J_1", law="sinh(p_J_1)", flow="w"), bg.TF("g", "1/i"),
             bg.One("b"), bg.I("J_2", law="p_J_2/J + c*p_J_2**3", flow="w_2", priority=-1), bg.Zero("gap"),
             bg.Sw("dog", on="0.5 - gate"), bg.One("c"), bg.I("J_3", "J_3", flow="w_3")]  # fmt: skip

    def own(w: float) -> float:
        return np.arcsinh(w) + brentq(lambda p: p / J + c * p**3 - w / i, -99, 99, xtol=1e-14) / i

    def moving(p: float, more: float = 0.0) -> float:
        return brentq(lambda w: own(w) + more * w - p, -99, 99, xtol=1e-14)

    begun, other = own(3.0), -2.0

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        alone = np.array([moving(begun + T * s) for s in t])
        joined = np.array([moving(begun + J3 * other + T * s, J3) for s in t])
        return {"w": np.where(t < 0.3, alone, joined), "w_3": np.where(t < 0.3, other, joined)}

    return Kind(
        "dog onto a shaft with a nonlinear inertia behind a gear",
        bond_graph(nodes, "T>a>J_1 a>g>b>J_2 a>gap>c>J_3 gap>dog"),
        {"J": J, "J_3": J3, "c": c, "i": i}, {"T": f"{T}", "gate": "step(0.3, 1, 0)"}, known, 0.99,
        {"w": 3.0, "w_3": other}, on=("dog",), at=0.4, mode={"dog": "off"},
        rest={"inputs": {"T": 0.0, "gate": 1.0}},
    )  # fmt: skip


def bouncing_nonlinear() -> Kind:
    """A mass whose law bends falls on a floor and leaves it at e of its speed: p' = -F between."""
    m, c, e, F, height = 0.5, 0.4, 0.6, 3.0, 2.0
    nodes = [bg.Se("F", "F"), bg.One("n"), bg.I("m", law="p_m/m + c*p_m**3", flow="v"),
             bg.Stop("floor", restitution="e", start="h")]  # fmt: skip

    def rise(p: Array, s: Array) -> Array:
        """How far it has come s after it had this momentum."""
        q = p - F * s
        return (p**2 - q**2) / (2 * m * F) + c * (p**4 - q**4) / (4 * F)

    falls = brentq(lambda s: height + rise(0.0, s), 0, 9, xtol=1e-14)
    leaps = [(falls, F * falls)]
    for _ in range(3):
        begin, p = leaps[-1]
        speed = e * (p / m + c * p**3)
        up = brentq(lambda q, v=speed: q / m + c * q**3 - v, 0, 9, xtol=1e-14)
        leaps.append((begin + (0 if len(leaps) == 1 else 2 * p / F), up))

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        parts = [(0.0, lambda s: height + rise(0.0, s))]
        parts += [(begin, lambda s, p=p: rise(p, s)) for begin, p in leaps[1:]]
        return {"q_floor": stepwise(t, *parts)}

    return Kind(
        "rigid stop that a nonlinear inertia meets", bond_graph(nodes, "F>n>m n>floor"),
        {"h": height, "m": m, "c": c, "e": e}, {"F": f"{-F}"}, known, 1.9, on=("floor",), at=0.5,
        mode={"floor": "apart"}, rest={"inputs": {"F": 0.0}, "initial": {"q_floor": 1.0}},
    )  # fmt: skip


EXCHANGING = (meshed_shafts, joined_cells, geared_behind, bouncing_nonlinear)
