"""The values with which runs begin that a graph declares, in numbers."""

from collections.abc import Mapping

import numpy as np
import sympy as sp

from bondgraph.equations import StateEquations
from bondgraph.errors import ParameterError
from codegen.model.exact_values import exact_parameters
from codegen.numbers.arrays import Array
from codegen.numbers.lambdified import lambdified


def told_starts(equations: StateEquations, parameters: Mapping[str, object]) -> dict[str, float]:
    """The declared start of each state that has one; `ParameterError` where it is no finite number."""
    if not equations.starts:
        return {}
    known = {sp.Symbol(name): value for name, value in exact_parameters(parameters).items()}
    found = {}
    for state, start in equations.starts.items():
        value = start.subs(known)
        if not (value.is_number and value.is_finite and value.is_real):
            raise ParameterError(f"the start of {state} is {value}, which is not a finite number")
        found[state.name] = float(value)
    return found


def starts_of_runs(
    equations: StateEquations, parameters: Mapping[str, Array], runs: int
) -> dict[str, Array]:
    """The same of many runs, from the parameters of each by name; no number where there is none."""
    found = {}
    for state, start in equations.starts.items():
        names = sorted(name.name for name in start.free_symbols)
        value = lambdified(names, start)(*(parameters[name] for name in names))
        found[state.name] = np.broadcast_to(np.asarray(value, dtype=float), (runs,))
    return found
