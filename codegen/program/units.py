"""The units that elements tell."""

from collections.abc import Mapping
from types import MappingProxyType

import sympy as sp

from bondgraph.equations import StateEquations


def units(equations: StateEquations) -> Mapping[sp.Symbol, str]:
    """What elements tell of their unit: that of what they give, or of their state."""
    result: dict[sp.Symbol, str] = {}
    named = {*equations.states, *equations.inputs}
    for element in equations.elements.values():
        for symbol in (element.given, element.effort, element.flow):
            if element.unit and symbol in named:
                result.setdefault(symbol, element.unit)
    return result


def told_units(equations: StateEquations) -> Mapping[str, str]:
    """The same by name, read-only."""
    return MappingProxyType({symbol.name: unit for symbol, unit in units(equations).items()})
