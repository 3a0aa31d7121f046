"""A program with numbers for its parameters: dense arrays, checked exactly before floats are trusted."""

from collections.abc import Callable, Iterable, Mapping, Sequence

import numpy as np
import sympy as sp

from bondgraph.algebra.elimination import ResidueRows
from bondgraph.algebra.exact import FixedRow, rows_of
from bondgraph.algebra.residues import residues
from bondgraph.equations import StateEquations
from bondgraph.errors import ParameterError
from bondgraph.inverses.inverse import Inverse
from bondgraph.nodes.elements import Element
from bondgraph.nodes.laws import ExpressionLaw
from bondgraph.reduce.resistances import resistive_loops
from codegen.model.exact_values import at_parameters, residue_rows
from codegen.model.numpy_backend import compiled
from codegen.numbers.arrays import Array, read_only, real_values
from codegen.program.records import Program
from codegen.standalone.matrices import Numbers, solved


def numbers(
    program: Program, equations: StateEquations, parameters: Mapping[str, sp.Rational]
) -> Numbers:
    """Evaluate constant coefficients and solve for the rates once.

    Raises `ParameterError` if a coefficient is not finite or A is singular at these parameters;
    the latter is decided exactly.
    """
    check_values(equations, parameters)
    found = assembled(program, _values(program, equations, parameters))
    for matrix in vars(found).values():
        read_only(matrix)
    return found


def check_values(equations: StateEquations, parameters: Mapping[str, sp.Rational]) -> None:
    """Refuse parameters that make a value zero, or a loop or A singular, whatever changes in time."""
    _check_elements(equations, parameters)
    _check_turned(equations, parameters)
    _check_loops(equations, parameters)
    _check_regular(equations, parameters)


def assembled(
    program: Program, values: Array, solve: Callable[[Array, Array], Array] | None = None
) -> Numbers:
    """The matrices from the nonzero entries that `Program.coefficients` gives, solved for the rates."""
    matrices: dict[str, Array] = {}
    start = 0
    for name, pattern in program.layout.items():
        matrix = np.zeros_like(values, shape=pattern.shape)
        end = start + len(pattern.rows)
        matrix[list(pattern.rows), list(pattern.columns)] = values[start:end]
        matrices[name], start = matrix, end
    return solved(**matrices, solve=solve)


def _values(
    program: Program, equations: StateEquations, parameters: Mapping[str, sp.Rational]
) -> Array:
    """The entries of all matrices at these parameters; `ParameterError` where one is not finite."""
    code = program.coefficients
    arguments = [float(parameters[name.name]) for name in code.arguments]
    try:
        with np.errstate(all="ignore"):
            values = real_values(compiled(code)(*arguments))
        finite = bool(np.isfinite(values).all())
    except (ArithmeticError, TypeError):
        finite = False
    if not finite:
        raise ParameterError(_not_finite(equations, parameters))
    return values


def _not_finite(equations: StateEquations, parameters: Mapping[str, sp.Rational]) -> str:
    """Which entry of which matrix has no finite real number at these parameters."""
    for name in "AJBEFDG":
        for (i, j), entry in sorted(getattr(equations, name).todok().items()):
            value = at_parameters(entry, parameters)
            if value.has(sp.zoo, sp.nan, sp.oo) or value.is_real is False:
                used = _listed(entry, parameters)
                return f"{name}[{i}, {j}] = {entry} has no finite real value at {used}"
    return "a coefficient has no finite real value at these parameters"


def _check_elements(equations: StateEquations, parameters: Mapping[str, sp.Rational]) -> None:
    """Refuse storages and moduli whose value is zero, or no finite number, at these parameters."""
    value = residues()
    for name, element in equations.elements.items():
        if element.value is None or element.kind.resists:
            continue
        try:
            zero = value(at_parameters(element.value, parameters)) == 0
        except (ZeroDivisionError, TypeError):
            zero = True
        if zero:
            raise ParameterError(
                f"{element.kind} {name!r}: its value {element.value} is zero or infinite at "
                f"{_listed(element.value, parameters)}"
            )


def _check_turned(equations: StateEquations, parameters: Mapping[str, sp.Rational]) -> None:
    """Refuse parameters at which a law that is turned round by a search may not go one way."""
    for name, element in equations.elements.items():
        law = element.law.expression if isinstance(element.law, ExpressionLaw) else None
        parts = {part for one in (element.inverse, law) if one for part in one.atoms(Inverse)}
        _check_powers(element, [one for one in (element.inverse, law) if one], parameters)
        needed = {factor for part in parts for factor in part.needed} | element.needed
        for factor in sorted(needed, key=str):
            if at_parameters(factor, parameters).is_nonpositive:
                raise ParameterError(
                    f"{element.kind} {name!r}: its law is turned round here, for which {factor} has "
                    f"to be positive, and here {_listed(factor, parameters)}; give the inverse of its law, "
                    "or a law in the other causality"
                )


def _check_powers(
    element: Element, expressions: Iterable[sp.Expr], parameters: Mapping[str, sp.Rational]
) -> None:
    """Refuse exponents at which what is undone of a power is a whole one, with values that no root has."""
    powers = [part for one in expressions for part in one.atoms(sp.Pow)] if element.turned else []
    for power in sorted(powers, key=str):
        if not power.exp.is_number and at_parameters(power.exp, parameters).is_integer:
            raise ParameterError(
                f"{element.kind} {element.name!r}: its law is turned round, and {power.exp} is whole at "
                f"{_listed(power.exp, parameters)}; write that exponent into the law as a number"
            )


def _listed(expr: sp.Expr, parameters: Mapping[str, sp.Rational]) -> str:
    names = sorted(expr.free_symbols, key=str)
    return ", ".join(f"{s} = {float(parameters[s.name]):g}" for s in names if s.name in parameters)


def _check_loops(equations: StateEquations, parameters: Mapping[str, sp.Rational]) -> None:
    """Refuse parameters at which a loop of bonds or resistances has no solution, by exact rank."""
    reduction = equations.reduction
    ports = reduction.structure.ports
    loops: list[tuple[str, Sequence[FixedRow]]] = [
        ("bonds", rows) for rows in reduction.structure.loops
    ]
    for group, inside in resistive_loops(reduction):
        names = ", ".join(repr(ports[i].element.name) for i in group)
        loops.append((f"the resistances {names}", inside))
    for what, rows in loops:
        exact = ResidueRows(residue_rows(rows, parameters))
        if not all(exact.pivot(i, jordan=False) for i in range(len(rows))):
            raise ParameterError(
                f"at these parameters {what} form a loop without a solution; change one, or put the number "
                "into the graph, for which another causality may be found"
            )


def _check_regular(equations: StateEquations, parameters: Mapping[str, sp.Rational]) -> None:
    """Refuse parameters at which A has no inverse, by exact rank."""
    eliminated = ResidueRows(residue_rows(rows_of(equations.A), parameters))
    for i, state in enumerate(equations.states):
        if not eliminated.pivot(i, jordan=False):
            raise ParameterError(
                f"at these parameters the matrix A is singular: {state}' is not determined; "
                "a storage is zero, or storages cancel each other"
            )
