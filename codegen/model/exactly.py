"""Expressions with exact numbers for parameters, and rows of them in residues."""

from collections.abc import Iterable, Mapping

import sympy as sp

from bondgraph.algebra.residues import residues


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
