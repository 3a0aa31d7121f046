"""Small models with textbook equations, and the rate of their states worked out exactly."""

from collections.abc import Mapping, Sequence

import networkx as nx
import numpy as np
import sympy as sp
from references.build import bond_graph

import bondgraph as bg

FRICTION = bg.DryFriction("F_c")


def series_circuit() -> nx.DiGraph:
    """Source, resistance, inductance and capacitance in series: V - R i - v = L i', i = C v'."""
    nodes = [bg.Se("source", "V"), bg.One("loop"), bg.R("resistor", "R"), bg.I("coil", "L", flow="i"),
             bg.C("plates", "C", effort="v")]  # fmt: skip
    return bond_graph(nodes, "source>loop>resistor loop>coil loop>plates")


def oscillator(*more: tuple, law: object = FRICTION) -> nx.DiGraph:
    """A mass on a spring that rubs on the ground: m v' = P - F - f, F' = k v; P where it is pushed."""
    nodes = [bg.One("mass"), bg.I("m", "m", flow="v"), bg.C("spring", "1/k", effort="F"),
             bg.R("ground", law=law, effort="f", flow="slip"), *more]  # fmt: skip
    extra = " ".join(f"{name}>mass" for name, _ in more)
    return bond_graph(nodes, f"mass>m mass>spring mass>ground {extra}")


def block(law: object = FRICTION) -> nx.DiGraph:
    """A mass on the ground under a push P: m v' = P - f."""
    nodes = [bg.Se("push", "P"), bg.One("mass"), bg.I("m", "m", flow="v"),
             bg.R("ground", law=law, effort="f", flow="slip")]  # fmt: skip
    return bond_graph(nodes, "push>mass>m mass>ground")


def pulled_block(law: object = FRICTION) -> nx.DiGraph:
    """A mass on the ground pulled by a spring whose end moves at V: m v' = F - f, F' = k (V - v)."""
    nodes = [bg.Sf("motor", "V"), bg.Zero("spring"), bg.C("k", "1/k", effort="F"), bg.One("mass"),
             bg.I("m", "m", flow="v"), bg.R("ground", law=law, effort="f", flow="slip")]  # fmt: skip
    return bond_graph(nodes, "motor>spring>k spring>mass>m mass>ground")


def exact_rate(
    equations: bg.StateEquations,
    parameters: Mapping[str, object],
    x: Sequence[float],
    u: Sequence[float],
) -> np.ndarray:
    """``A^-1 (J x + B u)`` in rational arithmetic."""
    values = {sp.Symbol(name): sp.Rational(str(number)) for name, number in parameters.items()}
    A, J, B = (sp.Matrix(M).subs(values) for M in (equations.A, equations.J, equations.B))
    state, given = (sp.Matrix([sp.Rational(float(entry)) for entry in v]) for v in (x, u))
    right = J * state
    if len(u):
        right += B * given
    return np.array(A.LUsolve(right).evalf(20).tolist(), dtype=float)[:, 0]


def belt(*more: tuple, law: object = FRICTION) -> nx.DiGraph:
    """A mass that rubs on a belt moving at V_b: slip = v - V_b, m v' = -f less what ``more`` takes."""
    nodes = [bg.One("mass"), bg.I("m", "m", flow="v"), bg.Zero("contact"), bg.Sf("belt", "V_b"),
             bg.R("rub", law=law, effort="f", flow="slip"), *more]  # fmt: skip
    extra = " ".join(f"mass>{name}" for name, _ in more)
    return bond_graph(nodes, f"mass>m mass>contact>rub contact>belt {extra}")


def stacked_blocks() -> nx.DiGraph:
    """Block 2 on block 1 on the ground, pushed by P_1 and P_2; slips v_1 and v_2 - v_1."""
    nodes = [
        bg.Se("push1", "P_1"), bg.Se("push2", "P_2"), bg.One("n1"), bg.One("n2"), bg.Zero("between"),
        bg.I("m1", "m_1", flow="v_1"), bg.I("m2", "m_2", flow="v_2"),
        bg.R("ground", law=bg.DryFriction("L_1", 1, "r_1"), effort="f_1", flow="s_1"),
        bg.R("contact", law=bg.DryFriction("L_2", 1, "r_2"), effort="f_2", flow="s_2"),
    ]  # fmt: skip
    return bond_graph(nodes, "push1>n1>m1 n1>ground push2>n2>m2 n2>between>n1 between>contact")


def clutches(*laws: object) -> nx.DiGraph:
    """Two shafts of inertias I_1 and I_2 under torques T_1 and T_2, with a clutch for each law between."""
    nodes = [bg.Se("t1", "T_1"), bg.Se("t2", "T_2"), bg.One("n1"), bg.One("n2"), bg.Zero("between"),
             bg.One("slip"), bg.I("i1", "I_1", flow="w_1"), bg.I("i2", "I_2", flow="w_2")]  # fmt: skip
    nodes += [bg.R(f"c{i}", law=law, effort=f"f_{i}", flow="slip") for i, law in enumerate(laws)]
    bonds = " ".join(f"slip>c{i}" for i in range(len(laws)))
    return bond_graph(nodes, f"t1>n1>i1 t2>n2>i2 n1>between>n2 between>slip {bonds}")
