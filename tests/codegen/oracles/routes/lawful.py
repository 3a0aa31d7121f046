"""Models without ports that switch whose laws have corners, fields or inverses, or that are large; each
with a run that is known by hand."""

from collections.abc import Mapping

import numpy as np
import sympy as sp
from references.build import bond_graph

import bondgraph as bg
from differentials.parts import assemble, compliant_shaft, engine, inertia, shaft
from oracles.routes.kind import Array, Kind, stepwise


def driven_dependent() -> Kind:
    """A speed w = sin 2t turns J over r, and a spring beside a damper: c s' = w - s/l."""
    c, d, w = 0.1, 3.0, 2.0
    tau = c * d
    nodes = [bg.Sf("turn", "w"), bg.One("j"), bg.I("J", "J"), bg.R("r", "r"), bg.Zero("z"),
             bg.C("c", "c", effort="s"), bg.R("leak", "d")]  # fmt: skip

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        late = np.sin(w * t) - w * tau * (np.cos(w * t) - np.exp(-t / tau))
        return {"s": d * late / (1 + (w * tau) ** 2)}

    return Kind("storage that a source rules", bond_graph(nodes, "turn>j>J j>r j>z>c z>leak"),
                {"J": 1.0, "r": 2.0, "c": c, "d": d}, {"w": f"sine(1, {w / (2 * np.pi)!r})"}, known, 1.0,
                at=0.3, rest={"inputs": {"w": 0.0}})  # fmt: skip


def loop_of_laws() -> Kind:
    """An inverting amplifier whose output is -a v_m, which it rules itself: v_m = v_f/(1 + a)."""
    a, R1, R2, C, u = 20.0, 1.0, 2.0, 0.4, 1.5
    nodes = [bg.Se("source", "u"), bg.One("in"), bg.R("R1", "R1"), bg.Zero("m", effort="v_m"),
             bg.One("back"), bg.Zero("pair"), bg.R("R2", "R2"), bg.C("C", "C", effort="v_f"),
             bg.Zero("o"), bg.Se("amp", "-a*v_m")]  # fmt: skip
    rate = (1 / ((1 + a) * R1) + 1 / R2) / C

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"v_f": u / (R1 * C * rate) * (1 - np.exp(-rate * t))}

    return Kind("law that determines itself at once",
                bond_graph(nodes, "source>in>R1 in>m>back>pair>R2 pair>C back>o amp>o"),
                {"a": a, "R1": R1, "R2": R2, "C": C}, {"u": f"{u}"}, known, 1.0, at=0.3,
                rest={"inputs": {"u": 0.0}})  # fmt: skip


def inverted_storage() -> Kind:
    """A law in derivative causality by its inverse: J w + asinh(J_2 w/i)/i = T t."""
    J1, J2, i, T = 1.0, 2.0, 0.5, 4.0
    second = bg.I("J_2", law="sinh(p_J_2)/J_2",
                  inverse="log(J_2*f_J_2 + sqrt((J_2*f_J_2)**2 + 1))", priority=-1)  # fmt: skip
    nodes = [bg.Se("T", "T"), bg.One("a"), bg.I("J_1", "J_1", flow="w"), bg.TF("g", "1/i"), bg.One("b"),
             second]  # fmt: skip

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"w": (T * t - np.arcsinh(J2 * run["w"] / i) / i) / J1}

    return Kind("law in derivative causality", bond_graph(nodes, "T>a>J_1 a>g>b>J_2"),
                {"J_1": J1, "J_2": J2, "i": i}, {"T": f"{T}"}, known, 1.0, at=0.5,
                rest={"inputs": {"T": 0.0}})  # fmt: skip


def energy_field() -> Kind:
    """A plate in a capacitor that a current charges: m x" + k x = -(q_0 + i t)^2/2."""
    k, m, q0, i = 5.0, 0.8, 1.0, 0.5
    w = np.sqrt(k / m)
    field = bg.C("mic", energy="q_mic_e**2*(d + q_mic_x)/2 + k*q_mic_x**2/2", ports=["e", "x"])
    nodes = [bg.Sf("charge", "i"), bg.Zero("el"), field, bg.One("mech"), bg.I("m", "m", flow="v")]
    graph = bond_graph(nodes, "charge>el mech>m")
    graph.add_edge("el", "mic", port="e")
    graph.add_edge("mech", "mic", port="x")

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        # x_p = -q^2/(2 k) + i^2 m/k^2, from x = 0 and v = 0 on.
        x0, v0 = q0**2 / (2 * k) - i**2 * m / k**2, q0 * i / k
        v = -(q0 + i * t) * i / k - x0 * w * np.sin(w * t) + v0 * np.cos(w * t)
        return {"v": v, "q_mic_e": q0 + i * t}

    return Kind("energy of a field", graph, {"k": k, "m": m, "d": 1.0}, {"i": f"{i}"}, known, 1.0,
                {"q_mic_e": q0}, at=0.4, rest={"inputs": {"i": 0.0}, "initial": {"q_mic_e": q0}})  # fmt: skip


def feedback() -> Kind:
    """A mass with a PI controller in pseudo-bonds: x" + 3 x' + 2 x = 2 r, of eigenvalues -1 and -2."""
    nodes = [bg.Se("force", "kp*(r - v) + ki*x_i"), bg.Sf("ref", "r - v"), bg.Zero("int"),
             bg.C("acc", 1, effort="x_i"), bg.One("mass"), bg.I("m", "m", flow="v")]  # fmt: skip

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        # m v' = 3 (1 - v) + 2 x, x' = 1 - v, m = 1: of e = 1 - v it is e" + 3 e' + 2 e = 0, e' (0) = -3.
        return {"v": 1 + np.exp(-t) - 2 * np.exp(-2 * t)}

    return Kind("sources that read signals", bond_graph(nodes, "force>mass>m ref>int>acc"),
                {"m": 1.0, "kp": 3.0, "ki": 2.0}, {"r": "1"}, known, 1.0, at=0.3,
                rest={"inputs": {"r": 1.0}})  # fmt: skip


def accumulators() -> Kind:
    """Two gas bladders on one pipe, the second twice the first: it takes two thirds of what is pumped."""
    nodes = [bg.Sf("pump", "Q"), bg.Zero("n"), bg.C("a", law="p_0*(V/(V - q_a))**1.4", effort="p"),
             bg.C("b", law="p_0*(2*V/(2*V - q_b))**1.4", effort="p_b")]  # fmt: skip

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"p": 2 * (1 - 0.4 * t) ** -1.4}

    return Kind("two nonlinear storages on one node", bond_graph(nodes, "pump>n>a n>b"),
                {"p_0": 2.0, "V": 1.0}, {"Q": "1.2"}, known, 1.0, {"p": 2.0}, at=0.3,
                rest={"inputs": {"Q": 0.0}, "initial": {"p": 2.0}})  # fmt: skip


def reaction() -> Kind:
    """A + B <-> C from no A, whose potential is log(0): x' = 1 - 2 x - x^2 of what there is of A."""
    nodes: list[tuple] = [bg.One("j")]
    for one in "ABC":
        nodes += [bg.Zero(f"z{one}", effort=f"mu_{one}"), bg.C(one, law=f"log(q_{one})")]
    nodes += [bg.R("r", law="k*(exp(mu_A + mu_B) - exp(mu_C))", gives="flow")]
    graph = bond_graph(nodes, "zA>A zB>B zC>C zA>j zB>j j>r j>zC")

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        low, high = -1 - np.sqrt(2), np.sqrt(2) - 1
        part = high / low * np.exp(-2 * np.sqrt(2) * t)
        x = (high - low * part) / (1 - part)
        return {"q_A": x, "q_B": 1 + x, "q_C": 1 - x}

    return Kind("reaction that begins without one species", graph, {"k": 1.0}, {}, known, 1.0,
                {"q_A": 0.0, "q_B": 1.0, "q_C": 1.0}, at=0.3,
                rest={"inputs": {}, "initial": {"q_A": 0.5, "q_B": 1.0, "q_C": 1.0}})  # fmt: skip


def heated() -> Kind:
    """A damper of two ports: what it takes from a mass m makes entropy in a body of c (T - T_0)."""
    damper = bg.R("b", ports=["rod", "heat"], gives={"heat": "flow"},
                  law={"rod": "d*f_b_rod", "heat": "-d*f_b_rod**2/e_b_heat"})  # fmt: skip
    nodes = [bg.Se("push", "P"), bg.One("rod"), bg.I("m", "m", flow="v"), damper, bg.Zero("warm"),
             bg.C("body", law="T_0*exp(q_body/c)", effort="T")]  # fmt: skip
    graph = bond_graph(nodes, "push>rod>m warm>body")
    graph.add_edge("rod", "b", port="rod")
    graph.add_edge("warm", "b", port="heat")
    d, c = 3.0, 0.5

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        # 2 v' = 6 - 3 v from 10 on; d int v^2 dt with v = 2 + 8 exp(-1.5 t).
        v = 2 + 8 * np.exp(-1.5 * t)
        heat = d * (4 * t - 32 / 1.5 * np.expm1(-1.5 * t) - 64 / 3 * np.expm1(-3 * t))
        return {"v": v, "q_body": c * np.log1p(heat / (c * 300))}

    return Kind("damper whose heat is taken up", graph, {"m": 2.0, "d": d, "T_0": 300.0, "c": c},
                {"P": "6"}, known, 1.0, {"v": 10.0}, at=0.4, rest={"inputs": {"P": 0.0}})  # fmt: skip


def _kinked(name: str, law: str, left: float) -> Kind:
    """A mass from -1 on by a push of 4, over b = 1 one way and ``left`` the other."""
    p, goes = 4.0, np.log1p(left / 4.0) / left
    nodes = [
        bg.Se("push", "P"),
        bg.One("n"),
        bg.I("m", "m", flow="v"),
        bg.R("b", flow="w", law=law),
    ]

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"v": stepwise(t, (0, lambda s: p / left - (1 + p / left) * np.exp(-left * s)),
                              (goes, lambda s: p * (1 - np.exp(-s))))}  # fmt: skip

    return Kind(name, bond_graph(nodes, "push>n>m n>b"), {"m": 1.0, "b": 1.0}, {"P": f"{p}"}, known, 1.0,
                {"v": -1.0}, at=0.6, rest={"inputs": {"P": 1.0}, "initial": {"v": 0.5}})  # fmt: skip


def piecewise() -> Kind:
    return _kinked("law in pieces", "b*Max(w, 0) + 2*b*Min(w, 0)", 2.0)


def table() -> Kind:
    """A table of five points, straight between them: 2 w below zero, w above."""
    spline = sp.interpolating_spline(1, sp.Symbol("w"), [-2, -1, 0, 1, 4], [-4, -2, 0, 1, 4])
    return _kinked("law as a table", spline, 2.0)


def play() -> Kind:
    """Two inertias through a gap: they meet, swing half a time through and part again, as they met."""
    J1, J2, k, gap, apart = 0.1, 0.3, 30.0, 0.1, 1.0
    graph = assemble(
        shaft("a"), shaft("b"), engine("e", "T", at="a"), inertia("J_1", "J_1", at="a", speed="w_1"),
        inertia("J_2", "J_2", at="b", speed="w_2"), compliant_shaft("s", "a", "b", "k", gap="g"),
    )  # fmt: skip
    w = np.sqrt(k * (1 / J1 + 1 / J2))
    free, swing = gap / apart, np.pi / w
    parts = [(0.0, lambda s: apart + 0 * s)]
    for n in range(20):
        meets, sign = free / 2 + n * (free + swing), (-1) ** n
        parts += [(meets, lambda s, sign=sign: sign * apart * np.cos(w * s)),
                  (meets + swing, lambda s, sign=sign: -sign * apart + 0 * s)]  # fmt: skip

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        relative = stepwise(t, *parts)
        return {"w_1": J2 / (J1 + J2) * relative, "w_2": -J1 / (J1 + J2) * relative}

    return Kind("backlash", graph, {"J_1": J1, "J_2": J2, "k": k, "g": gap}, {"T": "0"}, known, 0.97,
                {"w_1": J2 / (J1 + J2) * apart, "w_2": -J1 / (J1 + J2) * apart},
                at=0.02, rest={"inputs": {"T": 0.0}})  # fmt: skip


def soft_stop() -> Kind:
    """A mass that meets a spring at 0.05 m and is thrown back."""
    m, k, v0, meets = 2.0, 500.0, 0.5, 0.1
    w = np.sqrt(k / m)
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"),
             bg.C("k", law="k*Max(q_k - 0.05, 0)")]  # fmt: skip

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"v": stepwise(t, (0, lambda s: v0 + 0 * s), (meets, lambda s: v0 * np.cos(w * s)),
                              (meets + np.pi / w, lambda s: -v0 + 0 * s))}  # fmt: skip

    return Kind("stop with a stiffness", bond_graph(nodes, "push>n>m n>k"), {"m": m, "k": k}, {"P": "0"},
                known, 0.97, {"v": v0}, at=0.04,
                rest={"inputs": {"P": 10.0}, "initial": {"q_k": 0.1}})  # fmt: skip


def large() -> Kind:
    """A hundred masses, ninety-nine springs, in one shape of their own: a standing wave that decays."""
    n, m, k, b, shape = 100, 1.0, 400.0, 0.4, 3
    nodes, bonds = [bg.Se("push", "P")], ["push>n0"]
    for i in range(n):
        nodes += [bg.One(f"n{i}"), bg.I(f"m{i}", "m", flow=f"v{i}"), bg.R(f"b{i}", "b")]
        bonds += [f"n{i}>m{i} n{i}>b{i}"]
    for i in range(n - 1):
        nodes += [bg.Zero(f"z{i}"), bg.C(f"k{i}", "1/k", effort=f"s{i}")]
        bonds += [f"n{i}>z{i}>n{i + 1} z{i}>k{i}"]
    form = np.cos(np.pi * shape * (np.arange(n) + 0.5) / n)
    decay = b / (2 * m)
    w = np.sqrt(4 * k / m * np.sin(np.pi * shape / (2 * n)) ** 2 - decay**2)

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        course = np.exp(-decay * t) * (np.cos(w * t) - decay / w * np.sin(w * t))
        return {f"v{i}": form[i] * course for i in range(n)}

    return Kind("199 states", bond_graph(nodes, " ".join(bonds)), {"m": m, "k": k, "b": b}, {"P": "0"},
                known, 2.0, {f"v{i}": float(form[i]) for i in range(n)}, at=0.7,
                rest={"inputs": {"P": 0.0}})  # fmt: skip


LAWFUL = (
    loop_of_laws,
    driven_dependent, inverted_storage, energy_field, heated, accumulators, reaction, feedback, piecewise,
    table, play, soft_stop, large,
)  # fmt: skip
