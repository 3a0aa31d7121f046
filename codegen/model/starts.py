"""The values with which runs begin that a graph declares, in numbers."""

from collections.abc import Mapping

import numpy as np
import sympy as sp

from bondgraph.equations import StateEquations
from bondgraph.errors import ParameterError, SignalError
from bondgraph.nodes.elements import Element
from bondgraph.nodes.laws import ExpressionLaw
from codegen.model.exact_values import exact_parameters
from codegen.numbers.arrays import Array, is_finite, is_number
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


def by_states(
    equations: StateEquations, parameters: Mapping[str, object], initial: Mapping[str, float]
) -> dict[str, float]:
    """Initial values with what storages hold, ``p_m`` or ``q_C``, turned into the states that hold it.

    Of a field all that is held has to be told, or the other states. Raises `SignalError` for what a
    dependent storage holds, which the states rule, and for what is told twice.
    """
    if not isinstance(initial, Mapping):
        return initial
    states = {*equations.states, *equations.further_states}
    others = {sp.Symbol(str(n)): v for n, v in initial.items() if sp.Symbol(str(n)) not in states}
    # What is held is looked up only where a name is no state: every run passes here.
    held = equations.held if others else {}
    told = {name: value for name, value in others.items() if name in held}
    if not told:
        return dict(initial)
    _check_numbers(initial)
    rest = {name: value for name, value in initial.items() if sp.Symbol(str(name)) not in told}
    known = {sp.Symbol(name): value for name, value in exact_parameters(parameters).items()}
    known |= {sp.Symbol(str(name)): value for name, value in rest.items()}
    by_law: dict[str, float] = {}
    linear: dict[sp.Symbol, sp.Expr] = {}
    laws = laws_of_held(equations)
    for name, value in told.items():
        state, law = laws.get(name, (name, held[name].xreplace(known)))
        if name in laws:
            by_law[state.name] = _given(law.xreplace({**known, name: sp.Float(value)}), name, state)
            continue
        if not law.free_symbols or not law.free_symbols <= {*equations.states}:
            raise SignalError(
                f"initial {name}: it is {held[name]}, which other states rule, or are told; the states are "
                f"{', '.join(map(str, equations.states))}"
            )
        linear[name] = law
    return rest | by_law | _solved(linear, told)


def _given(law: sp.Expr, name: sp.Symbol, state: sp.Symbol) -> float:
    """What a law gives at what is held; `SignalError` where that is no number."""
    if not (law.is_number and law.is_finite and law.is_real):
        raise SignalError(
            f"initial {name}: the law gives {state} = {law}, no finite number; tell {state}"
        )
    return float(law)


def _check_numbers(initial: Mapping[str, float]) -> None:
    for name, value in initial.items():
        if not is_number(value) or not is_finite(value):
            raise SignalError(f"initial {name}: {value!r} is not a finite number")


def laws_of_held(equations: StateEquations) -> dict[sp.Symbol, tuple[sp.Symbol, sp.Expr]]:
    """What a storage whose law counts by its inverse holds, to its state and the law that gives that."""
    found = {}
    for port in equations.reduction.structure.ports:
        law = port.element.law
        if port.element.by_inverse and isinstance(law, ExpressionLaw) and law.state is not None:
            found[law.state] = (port.given, law.expression)
    return found


def _solved(held: Mapping[sp.Symbol, sp.Expr], told: Mapping[sp.Symbol, float]) -> dict[str, float]:
    """The states at which linear storages and fields hold this."""
    names = sorted({one for expr in held.values() for one in expr.free_symbols}, key=str)
    if len(names) != len(held):
        raise SignalError(
            f"initial {', '.join(map(str, held))}: {', '.join(map(str, names))} hold these together; tell "
            "all that is held, or the other states"
        )
    if not names:
        return {}
    matrix = np.array([[float(expr.coeff(one)) for one in names] for expr in held.values()])
    rest = dict.fromkeys(names, sp.Integer(0))
    right = [float(told[name] - expr.xreplace(rest)) for name, expr in held.items()]
    try:
        values = np.linalg.solve(matrix, np.array(right))
    except np.linalg.LinAlgError:
        raise SignalError(
            f"initial {', '.join(map(str, held))}: these do not tell {', '.join(map(str, names))}; tell the "
            "states"
        ) from None
    return {one.name: value for one, value in zip(names, values.tolist(), strict=True)}


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
