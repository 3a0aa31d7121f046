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
