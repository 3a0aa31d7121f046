"""Rates of momenta and displacements, in place of flows and efforts of linear storages."""

from collections.abc import Mapping

import sympy as sp

from bondgraph.algebra.exact import Row, solve
from bondgraph.equations import StateEquations
from bondgraph.errors import StructureError


def in_energy_states(
    equations: StateEquations, rates: Mapping[sp.Symbol, sp.Expr]
) -> tuple[dict[sp.Symbol, sp.Expr], dict[sp.Symbol, sp.Expr]]:
    """Rates of the states that are kept then, by those of co-energy ones; and co-energy by energy states.

    ``pi = M x``. Raises `StructureError` where values change in time, or a field has dependent ports.
    """
    if equations.varying:
        raise StructureError(
            "values of this graph change in time; its energy states are kept where storages have a law"
        )
    names, M = _momenta(equations)
    solved = solve(M, [{i: sp.Integer(1)} for i in range(len(M))]) if M else []
    inverse = [sp.Add(*(e * names[j] for j, e in row.items())) for row in solved]
    put_in = dict(zip(equations.states, inverse, strict=True))
    found = {
        name: sp.Add(*(value * rates[equations.states[j]] for j, value in line.items()))
        for name, line in zip(names, M, strict=True)
    }
    return found | {state: rate for state, rate in rates.items() if state not in put_in}, put_in


def _momenta(equations: StateEquations) -> tuple[list[sp.Symbol], list[Row]]:
    """The names of momenta and displacements, and what they are over states."""
    ports = equations.reduction.structure.ports
    M: list[Row] = []
    names: list[sp.Symbol] = []
    columns = {ports[port].element.name: at for at, port in enumerate(equations.reduction.states)}
    for port in equations.reduction.states:
        element = ports[port].element
        row = element.row or ((element.name, element.constant),)
        missing = [other for other, value in row if other not in columns and value != 0]
        if missing:
            raise StructureError(
                f"the field {element.owner!r} has dependent ports, so its momenta are no states of their own"
            )
        M.append({columns[other]: value for other, value in row if value != 0})
        letter = element.kind.letter
        names.append(sp.Symbol(f"{letter}_{str(element.name).replace('.', '_')}"))
    return names, M
