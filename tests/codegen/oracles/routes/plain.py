"""Models without ports that switch, each with a run that is known by hand."""

from collections.abc import Mapping

import numpy as np
from references.build import bond_graph

import bondgraph as bg
from oracles.routes.kind import Array, Kind


def linear() -> Kind:
    """m v' + b v + k x = P, underdamped, from rest by a step."""
    m, k, b, p = 2.0, 50.0, 4.0, 5.0
    nodes = [
        bg.Se("push", "P"),
        bg.One("n"),
        bg.I("m", "m", flow="v"),
        bg.C("k", "1/k", effort="s"),
        bg.R("b", "b"),
    ]
    decay, w = b / (2 * m), np.sqrt(k / m - (b / (2 * m)) ** 2)

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"v": p / (m * w) * np.exp(-decay * t) * np.sin(w * t)}

    return Kind("linear", bond_graph(nodes, "push>n>m n>k n>b"), {"m": m, "k": k, "b": b}, {"P": f"{p}"},
                known, 1.0, at=0.5, rest={"inputs": {"P": p}})  # fmt: skip


def dependent_storage() -> Kind:
    """A second inertia behind a ratio: (J_1 + J_2/i^2) w' = T - d w/i^2."""
    J1, J2, i, d, T = 1.0, 2.0, 0.5, 0.75, 4.0
    nodes = [bg.Se("T", "T"), bg.One("a"), bg.I("J_1", "J_1", flow="w"), bg.TF("g", "1/i"), bg.One("b"),
             bg.I("J_2", "J_2", priority=-1), bg.R("d", "d")]  # fmt: skip
    J, D = J1 + J2 / i**2, d / i**2

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"w": T / D * (1 - np.exp(-D / J * t))}

    return Kind("storage in derivative causality", bond_graph(nodes, "T>a>J_1 a>g>b>J_2 b>d"),
                {"J_1": J1, "J_2": J2, "i": i, "d": d}, {"T": f"{T}"}, known, 1.0, at=0.5,
                rest={"inputs": {"T": T}})  # fmt: skip


def resistive_loop() -> Kind:
    """A ladder of three resistances onto C: Thevenin's voltage and resistance."""
    r1, r2, r3, c, u = 1.0, 2.0, 3.0, 0.1, 6.0
    nodes = [bg.Se("u", "u"), bg.One("a"), bg.R("r1", "r1"), bg.Zero("b"), bg.R("r2", "r2"), bg.One("c"),
             bg.R("r3", "r3"), bg.C("cap", "c", effort="v")]  # fmt: skip
    inner = r1 * r2 / (r1 + r2) + r3

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"v": u * r2 / (r1 + r2) * (1 - np.exp(-t / (inner * c)))}

    return Kind("resistive loop", bond_graph(nodes, "u>a>r1 a>b>r2 b>c>r3 c>cap"),
                {"r1": r1, "r2": r2, "r3": r3, "c": c}, {"u": f"{u}"}, known, 1.0, at=0.3,
                rest={"inputs": {"u": u}})  # fmt: skip


def nonlinear_resistance() -> Kind:
    """m v' = P - b v^2: v = sqrt(P/b) tanh(sqrt(P b) t/m)."""
    m, b, p = 2.0, 0.5, 8.0
    nodes = [
        bg.Se("push", "P"),
        bg.One("n"),
        bg.I("m", "m", flow="v"),
        bg.R("b", flow="w", law="b*w*abs(w)"),
    ]

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"v": np.sqrt(p / b) * np.tanh(np.sqrt(p * b) * t / m)}

    return Kind("resistance with a law", bond_graph(nodes, "push>n>m n>b"), {"m": m, "b": b}, {"P": f"{p}"},
                known, 1.0, at=0.5, rest={"inputs": {"P": p}, "initial": {"v": 3.0}})  # fmt: skip


def nonlinear_storage() -> Kind:
    """A hardening spring keeps m v^2/2 + k q^2/2 + k q^4/4."""
    m, k, v0 = 1.0, 4.0, 3.0
    nodes = [
        bg.Se("push", "P"),
        bg.One("n"),
        bg.I("m", "m", flow="v"),
        bg.C("k", law="k*q_k + k*q_k**3"),
    ]

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        q, v = run["q_k"], run["v"]
        energy = v**2 / 2 + k * q**2 / 2 + k * q**4 / 4
        # Scaled to the speed, so that it is compared as one.
        return {"v": v * np.sqrt(v0**2 / 2 / energy)}

    return Kind("storage with a law", bond_graph(nodes, "push>n>m n>k"), {"m": m, "k": k}, {"P": "0"},
                known, 1.0, {"v": v0}, at=0.3,
                rest={"inputs": {"P": 8.0}, "initial": {"q_k": 0.9}})  # fmt: skip


def crank() -> Kind:
    """A crank with a slider of mass m: (J + m r^2 sin^2 theta) w^2/2 = T theta + J w_0^2/2."""
    J, m, r, T, w0 = 0.1, 2.0, 0.3, 0.4, 2.0
    nodes = [bg.Se("drive", "T"), bg.One("shaft"), bg.I("J", "J", flow="w"),
             bg.Df("angle", integrate="theta"), bg.TF("yoke", "r*sin(theta)"), bg.One("slider"),
             bg.I("m", "m", priority=-1)]  # fmt: skip

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        theta = run["theta"]
        inertia = J + m * r**2 * np.sin(theta) ** 2
        return {"w": np.sqrt(2 * (T * theta + J * w0**2 / 2) / inertia)}

    return Kind("moving ratio", bond_graph(nodes, "drive>shaft>J shaft>angle shaft>yoke>slider>m"),
                {"J": J, "m": m, "r": r}, {"T": f"{T}"}, known, 1.0, {"w": w0, "theta": 0.0}, at=0.3,
                rest={"inputs": {"T": 0.0}})  # fmt: skip


PLAIN = (linear, dependent_storage, resistive_loop, nonlinear_resistance, nonlinear_storage, crank)
