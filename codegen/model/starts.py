"""The values with which runs begin that a graph declares, in numbers."""

from collections.abc import Mapping

import numpy as np
import sympy as sp

from bondgraph.declare.elements import Element
from bondgraph.equations import StateEquations
from bondgraph.errors import ParameterError
from codegen.model.exact_values import exact_parameters
from codegen.numbers.arrays import Array
from codegen.numbers.lambdified import lambdified
from codegen.tuning import TUNING

DIGITS = 30
"""Enough to see a start on a branch that is almost level."""


def told_starts(equations: StateEquations, parameters: Mapping[str, object]) -> dict[str, float]:
    """The declared start of each state that has one.

    Raises `ParameterError` where it is no finite number, or on another branch of its law than that which is
    turned round.
    """
    if not equations.starts:
        return {}
    known = {sp.Symbol(name): value for name, value in exact_parameters(parameters).items()}
    found = {}
    for state, start in equations.starts.items():
        value = start.subs(known)
        if not (value.is_number and value.is_finite and value.is_real):
            raise ParameterError(f"the start of {state} is {value}, which is not a finite number")
        found[state.name] = float(value)
    for given, (element, back) in equations.starts_back.items():
        _check_branch(element, back.subs(known), given, found[given.name], known)
    return found


def _check_branch(
    element: Element,
    back: sp.Expr,
    given: sp.Symbol,
    value: float,
    known: Mapping[sp.Symbol, sp.Expr],
) -> None:
    """Refuse a start that is not what the law's inverse makes of what the law gives there."""
    assert element.start is not None
    start, told = float(element.start.subs(known)), sp.N(back, DIGITS)
    found = float(told) if told.is_number and told.is_real else float("nan")
    if not abs(found - start) <= TUNING.same_branch * max(abs(start), 1.0):
        raise ParameterError(
            f"{element.kind} {element.name!r}: it starts at {start:.9g}, where its law gives {given} = "
            f"{value:.9g}, but the law is turned round along the branch on which it gives that at "
            f"{found:.9g}; begin there, give the inverse of the branch that is meant, or put a storage that "
            "can be independent beside it"
        )


def starts_of_runs(
    equations: StateEquations, parameters: Mapping[str, Array], runs: int
) -> dict[str, Array]:
    """The same of many runs, from the parameters of each by name; no number where there is none."""
    found = {}
    for state, start in equations.starts.items():
        names = sorted(name.name for name in start.free_symbols)
        value = lambdified(names, start)(*(parameters[name] for name in names))
        found[state.name] = np.broadcast_to(np.asarray(value, dtype=float), (runs,))
    for state, (element, back) in equations.starts_back.items():
        assert element.start is not None
        names = sorted(name.name for name in back.free_symbols | element.start.free_symbols)
        with np.errstate(all="ignore"):
            told = lambdified(names, [back, element.start])(*(parameters[name] for name in names))
        again, start = (np.asarray(one, dtype=float) for one in told)
        same = np.abs(again - start) <= TUNING.same_branch * np.maximum(np.abs(start), 1.0)
        found[state.name] = np.where(same, found[state.name], np.nan)
    return found
