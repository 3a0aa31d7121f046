"""How equations are compared with those of textbooks: exactly, state by state or as transfer functions."""

from collections.abc import Hashable, Mapping

import networkx as nx
import sympy as sp
from sympy.polys.matrices import DomainMatrix

import bondgraph as bg

s = sp.Symbol("s")


def rates(graph: "nx.DiGraph[Hashable]", energy: bool = True) -> dict[str, sp.Expr]:
    """The rate of every state, in energy states or co-energy ones."""
    found = bg.explicit(bg.derive(graph, outputs=[]), energy=energy)
    return {str(state): rate for state, rate in found.items()}


def agree(found: Mapping[str, sp.Expr], expected: Mapping[str, str]) -> None:
    """The same states, and rates that differ by nothing."""
    assert set(found) == set(expected)
    for state, text in expected.items():
        assert sp.cancel(found[state] - bg.expression(text, state)) == 0, state


def transfer(model: bg.LinearModel | bg.StateEquations, at: int = 0) -> sp.Expr:
    """The first output over one of the inputs, as a fraction of polynomials in s."""
    pencil = DomainMatrix.from_Matrix(s * model.A - model.J).to_field()
    driven = DomainMatrix.from_Matrix(model.B[:, at] + s * model.E[:, at]).to_field()
    pencil, driven = pencil.unify(driven)
    solved = pencil.lu_solve(driven).to_Matrix()
    return sp.cancel((model.F * solved)[0] + model.D[0, at] + s * model.G[0, at])
