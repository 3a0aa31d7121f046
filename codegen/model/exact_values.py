"""Exact numbers for parameters: rationals, expressions at them, rows of such in residues."""

from collections.abc import Iterable, Mapping

import sympy as sp

from bondgraph.algebra.atoms import normal, number
from bondgraph.algebra.residues import residues
from bondgraph.errors import ParameterError


def exact_parameters(parameters: Mapping[str, object]) -> dict[str, sp.Rational]:
    """Every parameter as the rational it stands for; `ParameterError` for what is not a number."""
    result: dict[str, sp.Rational] = {}
    for name, value in parameters.items():
        if not isinstance(name, str):
            raise ParameterError(f"parameter {name!r}: a parameter's name must be a text")
        try:
            result[str(normal(name))] = number(value, f"parameter {name!r}")
        except ValueError as error:
            raise ParameterError(str(error)) from None
    return result


def at_parameters(expr: sp.Expr, parameters: Mapping[str, sp.Rational]) -> sp.Expr:
    """An expression with exact numbers for its parameters."""
    return expr.xreplace(
        {name: parameters[name.name] for name in expr.free_symbols if name.name in parameters}
    )


def residue_rows(
    rows: Iterable[Mapping[int, sp.Expr]], parameters: Mapping[str, sp.Rational]
) -> list[dict[int, int]]:
    """Rows in residues at these parameters, less what is zero there."""
    value = residues()
    found = [{j: value(at_parameters(e, parameters)) for j, e in row.items()} for row in rows]
    return [{j: entry for j, entry in row.items() if entry} for row in found]
