"""A graph with numbers for its parameters, every value checked where it stands."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import sympy as sp

from bondgraph.declare.names import named_by
from bondgraph.declare.validate import validate, with_elements
from bondgraph.errors import ParameterError, SingularStorageError, StructureError
from bondgraph.nodes.elements import Element
from bondgraph.nodes.laws import ExpressionLaw
from codegen.model.exact_values import at_parameters, exact_parameters


def valued_graph(graph: Any, parameters: Mapping[str, object]) -> Any:
    """The validated graph with exact numbers for all values; a port that a parameter names is closed by it.

    Raises `ParameterError` for missing numbers, values without a meaning and parameters named like signals;
    `StructureError` for values that change and laws that are no constants; `SingularStorageError` for
    storages that may cancel one another.
    """
    checked = validate(graph)
    exact = exact_parameters(parameters)
    elements: list[Element] = [checked.nodes[name]["element"] for name in checked]
    signals = {name.name for element in elements for name in named_by(element)}
    inputs = {e.given.name for e in elements if e.given is not None}
    for name in sorted(exact.keys() & (signals - inputs)):
        raise ParameterError(f"parameter {name} names a signal of the model; rename it")
    made = {e.name: _valued(e, exact, signals) for e in elements}
    return with_elements(checked, made)


def _valued(element: Element, exact: Mapping[str, sp.Rational], signals: Iterable[str]) -> Element:
    where = f"{element.kind} {element.name!r}"
    if element.integral is not None:
        raise StructureError(f"{where} integrates; derive the graph and use simulator")
    if element.switch is not None:
        raise StructureError(f"{where} is a switch; take the graph in one mode, see in_mode")
    law = _law(element, where, exact, signals)
    value, row = element.value, element.row
    if value is not None:
        value = _number(value, where, exact, signals)
        if value.is_zero and not element.kind.resists:
            raise ParameterError(f"{where}: its value {element.value} is zero or infinite")
    if element.kind.resists and value is not None and value.is_zero:
        # Nothing at all between effort and flow: it gives the effort zero, whatever flows.
        zero = ExpressionLaw(sp.Integer(0))
        return replace(element, value=None, row=(), gives="effort", law=zero)
    if row:
        row = tuple((name, _number(entry, where, exact, signals)) for name, entry in row)
    if element.kind.stores and (row or value is None or not value.is_positive):
        raise SingularStorageError(
            f"{where} is a field or not positive: floats would decide whether A has an inverse; derive the "
            "graph, which decides it exactly"
        )
    return replace(element, value=value, row=row, law=law)


def _law(
    element: Element, where: str, exact: Mapping[str, sp.Rational], signals: Iterable[str]
) -> ExpressionLaw | None:
    """A constant law as a number; of an input that a parameter names, that number."""
    given, law = element.given, element.law
    if law is None:
        named = (
            given is not None
            and given.name in exact
            and (element.kind.supplies or element.kind.resists)
        )
        return ExpressionLaw(exact[given.name]) if named and given is not None else None
    if not isinstance(law, ExpressionLaw) or law.state is not None or _moving(law, exact):
        raise StructureError(
            f"{where} has a law that is no constant; derive the graph and use simulator"
        )
    return ExpressionLaw(_number(law.expression, where, exact, signals))


def _moving(law: ExpressionLaw, exact: Mapping[str, sp.Rational]) -> bool:
    return any(name.name not in exact for name in law.free_symbols)


def _number(
    expr: sp.Expr, where: str, exact: Mapping[str, sp.Rational], signals: Iterable[str]
) -> sp.Expr:
    """A value at the parameters, exact; a real, finite number."""
    value = at_parameters(expr, exact)
    for name in sorted(map(str, value.free_symbols)):
        if name in signals or name == "t":
            raise StructureError(
                f"{where}: its value {expr} changes with {name}; derive the graph and use simulator"
            )
        raise ParameterError(f"{where}: its value {expr} needs a number for {name} in parameters")
    if value.has(sp.zoo, sp.nan, sp.oo) or not value.is_real:
        raise ParameterError(f"{where}: {expr} has no finite real value at these parameters")
    return value
