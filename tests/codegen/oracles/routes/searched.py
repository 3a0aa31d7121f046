"""Models whose laws are turned round by a search; each beside what scipy finds."""

from collections.abc import Mapping

import numpy as np
from references.build import bond_graph
from scipy.integrate import solve_ivp
from scipy.interpolate import Akima1DInterpolator, PchipInterpolator
from scipy.optimize import brentq

import bondgraph as bg
from oracles.routes.kind import Array, Kind


def unlike_springs() -> Kind:
    """Two springs that harden, each in its own way, side by side: what one holds the other does not."""
    k, c, m = 1.0, 2.0, 0.5
    nodes = [bg.Sf("pump", "Q"), bg.Zero("n"), bg.C("a", law="k*q_a + c*q_a**3", effort="p"),
             bg.C("b", law="m*q_b + exp(q_b) - 1", effort="p_b")]  # fmt: skip

    def held(p: float) -> float:
        return sum(
            brentq(lambda q, law=law: law(q) - p, 0, 10, xtol=1e-14)
            for law in (lambda q: k * q + c * q**3, lambda q: m * q + np.exp(q) - 1)
        )

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"p": np.array([brentq(lambda p, now=now: held(p) - now, 0, 20) for now in 1.5 * t])}

    return Kind("two storages whose laws no algebra turns round", bond_graph(nodes, "pump>n>a n>b"),
                {"k": k, "c": c, "m": m}, {"Q": "1.5"}, known, 1.0, at=0.3,
                rest={"inputs": {"Q": 0.0}})  # fmt: skip


def hardening_inertia() -> Kind:
    """A law in derivative causality behind a gear: J_1 w + p_2/i = T t, with w/i = p_2/J_2 + c p_2^3."""
    J1, J2, c, i, T = 1.0, 2.0, 0.3, 0.5, -4.0
    second = bg.I("J_2", law="p_J_2/J_2 + c*p_J_2**3", flow="w_2", priority=-1)
    nodes = [bg.Se("T", "T"), bg.One("a"), bg.I("J_1", "J_1", flow="w"), bg.TF("g", "1/i"), bg.One("b"),
             second]  # fmt: skip

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        roots = (np.roots([c, 0.0, 1 / J2, -w2]) for w2 in run["w_2"])
        p2 = np.array([next(one.real for one in found if abs(one.imag) < 1e-9) for found in roots])
        return {"w_2": (T * t - p2 / i) / J1 / i}

    return Kind("law in derivative causality, turned round by a search",
                bond_graph(nodes, "T>a>J_1 a>g>b>J_2"), {"J_1": J1, "J_2": J2, "c": c, "i": i},
                {"T": f"{T}"}, known, 1.0, at=0.5, rest={"inputs": {"T": 0.0}})  # fmt: skip


def cells() -> Kind:
    """Two cells side by side, one by points, one by a law: what is charged is the sum of what they hold."""
    held, rests = [0.0, 1.0, 3.0, 6.0], [1.0, 2.0, 2.5, 5.0]
    graph = bond_graph([bg.Sf("charger", "i"), bg.Zero("n"), bg.C("a", law="rest(q_a)", effort="u"),
                        bg.C("b", law="k*q_b + c*q_b**3")], "charger>n>a n>b")  # fmt: skip
    graph.graph["tables"] = [bg.LookupTable("rest", held, rests, outside="extend")]
    k, c, u0 = 0.5, 0.2, 1.4

    def both(u: float) -> float:
        return np.interp(u, rests, held) + brentq(lambda q: k * q + c * q**3 - u, 0, 10, xtol=1e-14)

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        left = both(u0) + 3.0 * t
        return {"u": np.array([brentq(lambda u, q=q: both(u) - q, 1, 5, xtol=1e-14) for q in left])}

    return Kind("two cells, one by a table", graph, {"k": k, "c": c}, {"i": "3"}, known, 1.0, {"u": u0},
                at=0.4, rest={"inputs": {"i": 0.0}, "initial": {"u": u0}})  # fmt: skip


def curved_cells() -> Kind:
    """The same of two curves by points, of which one falls: what is charged is the sum of what they hold."""
    held, rests = [0.0, 1.0, 3.0, 6.0], [1.0, 2.0, 2.5, 5.0]
    left, levels = [-7.0, -4.0, -1.5, 0.0], [6.0, 3.5, 1.5, 0.5]
    graph = bond_graph([bg.Sf("charger", "i"), bg.Zero("n"), bg.C("a", law="rest(q_a)", effort="u"),
                        bg.C("b", law="k*level(-q_b)")], "charger>n>a n>b")  # fmt: skip
    graph.graph["tables"] = [
        bg.LookupTable("rest", held, rests, method="pchip"),
        bg.LookupTable("level", left, levels, method="akima", outside="extend"),
    ]
    k, u0 = 0.8, 1.2
    curves = (PchipInterpolator(held, rests), lambda q: k * Akima1DInterpolator(left, levels)(-q))

    def both(u: float) -> float:
        return sum(
            brentq(lambda q, law=law: law(q) - u, 0, end, xtol=1e-14)
            for law, end in zip(curves, (6.0, 7.0), strict=True)
        )

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        filled = both(u0) + 5.0 * t
        return {
            "u": np.array([brentq(lambda u, q=q: both(u) - q, 1, 4.8, xtol=1e-14) for q in filled])
        }

    return Kind("two cells by curves through points", graph, {"k": k}, {"i": "5"}, known, 1.0, {"u": u0},
                at=0.4, rest={"inputs": {"i": 0.0}, "initial": {"u": u0}})  # fmt: skip


def gapped_springs() -> Kind:
    """A spring stiffer beyond a gap on either side, a drag beside it: u sweeps over both corners and zero."""
    k, c, g, m, u0 = 1.5, 2.0, 0.4, 0.8, -2.0
    nodes = [bg.Sf("pump", "Q"), bg.Zero("n"),
             bg.C("a", law="k*q_a + c*Max(q_a - g, 0) + c*Min(q_a + g, 0)", effort="u"),
             bg.C("b", law="q_b*abs(q_b) + m*q_b")]  # fmt: skip

    def both(u: float) -> float:
        beyond = max(abs(u) - k * g, 0.0)
        first = min(abs(u), k * g) / k + beyond / (k + c)
        second = (np.sqrt(m**2 + 4 * abs(u)) - m) / 2
        return np.sign(u) * (first + second)

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        filled = both(u0) + 5.0 * t
        return {
            "u": np.array([brentq(lambda u, q=q: both(u) - q, -9, 9, xtol=1e-14) for q in filled])
        }

    return Kind("two storages whose laws have corners", bond_graph(nodes, "pump>n>a n>b"),
                {"k": k, "c": c, "g": g, "m": m}, {"Q": "5"}, known, 0.8, {"u": u0}, at=0.5,
                rest={"inputs": {"Q": 0.0}})  # fmt: skip


def orifice() -> Kind:
    """A tank that empties through a pipe and a check plate: u' = (Q - f)/C, f where the pressure is u."""
    C, b, d, r, f0, u0 = 0.5, 0.6, 1.1, 2.0, 0.3, 2.0
    law = "b*f_pipe + d*f_pipe*abs(f_pipe) + Piecewise((r*(f_pipe - f_0), f_pipe > f_0), (0, True))"
    nodes = [bg.Sf("pump", "Q"), bg.Zero("n"), bg.C("tank", "C", effort="u"),
             bg.R("pipe", law=law, flow="f_pipe")]  # fmt: skip

    def flow(u: float) -> float:
        def law(f: float) -> float:
            return b * f + d * f * abs(f) + (r * (f - f0) if f > f0 else 0.0) - u

        return brentq(law, -20, 20, xtol=1e-15)

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        crossings = [lambda _, u: u[0] - b * f0 - d * f0**2, lambda _, u: u[0]]
        done = solve_ivp(lambda t, u: [(-2.0 - flow(u[0])) / C], (0, t[-1]), [u0], "DOP853", rtol=1e-12,
                         atol=1e-13, dense_output=True, events=crossings, max_step=0.01)  # fmt: skip
        return {"u": done.sol(t)[0]}

    return Kind("resistance with corners, turned round", bond_graph(nodes, "pump>n>tank n>pipe"),
                {"C": C, "b": b, "d": d, "r": r, "f_0": f0}, {"Q": "-2"}, known, 0.8, {"u": u0}, at=0.3,
                rest={"inputs": {"Q": -2.0}})  # fmt: skip


def rubbing_nonlinear() -> Kind:
    """Friction of 3 on a mass whose law bends: p' = 3 t - 3 from 1, at rest from 1 - 1/sqrt(3) to 1."""
    m, c, p0 = 0.5, 0.4, 1.0
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", law="p_m/m + c*p_m**3", flow="v"),
             bg.R("rub", effort="f", flow="slip_v", law=bg.DryFriction("N"))]  # fmt: skip

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        slowing = np.where(t < 1 - 3**-0.5, p0 - 3 * t + 1.5 * t**2, 0.0)
        p = np.where(t > 1, 1.5 * (t - 1) ** 2, slowing)
        return {"v": p / m + c * p**3}

    return Kind("dry friction on a nonlinear inertia", bond_graph(nodes, "push>n>m n>rub"),
                {"m": m, "c": c, "N": 3.0}, {"P": "ramp(0, 3)"}, known, 1.6, {"v": p0 / m + c * p0**3},
                at=0.8, mode={"rub": "stick"}, rest={"inputs": {"P": 2.0}})  # fmt: skip


SEARCHED = (
    unlike_springs, hardening_inertia, cells, curved_cells, gapped_springs, orifice, rubbing_nonlinear,
)  # fmt: skip
