"""Storages whose energy is not positive: they are run, with a warning that names them."""

from collections.abc import Hashable, Iterator, Mapping

import numpy as np
import sympy as sp

from bondgraph.equations import StateEquations
from bondgraph.nodes.elements import Element
from codegen.model.exact_values import at_parameters
from codegen.tuning import TUNING


def negative_energies(
    equations: StateEquations, parameters: Mapping[str, sp.Rational]
) -> Iterator[str]:
    """What is to be told of linear storages whose energy falls below zero.

    Of masses, stiffnesses, matrices of fields; values that change in time are left out.
    """
    named = [repr(name) for name in _negative(equations, parameters)]
    if named:
        yield (
            f"the energy stored in {', '.join(named)} is not positive at these parameters: a negative "
            "inertia or stiffness, or a field whose matrix is not positive definite, makes most models "
            "unstable; check its value"
        )


def _negative(
    equations: StateEquations, parameters: Mapping[str, sp.Rational]
) -> Iterator[Hashable]:
    """The storages in question, a field by its own name."""
    fields: dict[Hashable, dict[Hashable, Element]] = {}
    for name, element in equations.elements.items():
        if not element.kind.stores or element.value is None:
            continue
        if element.row:
            fields.setdefault(element.owner, {})[element.name] = element
        elif (value := _number(element.value, parameters)) is not None and value < 0:
            yield name
    for owner, ports in fields.items():
        entries = [[_number(e, parameters) for _, e in port.row] for port in ports.values()]
        known = [[entry for entry in row if entry is not None] for row in entries]
        if all(len(row) == len(ports) for row in known):
            matrix = np.array(known)
            least = np.linalg.eigvalsh((matrix + matrix.T) / 2).min()
            if least < -TUNING.energy_rounding * np.abs(matrix).max():
                yield owner


def _number(value: sp.Expr, parameters: Mapping[str, sp.Rational]) -> float | None:
    """A value at the parameters, None where it is none."""
    found = sp.N(at_parameters(value, parameters))
    return float(found) if found.is_real else None
