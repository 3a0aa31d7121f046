"""How A comes about: the states' own storages and what dependent ones add, matrix by matrix."""

from collections.abc import Mapping, Sequence

import sympy as sp

from bondgraph.algebra.exact import Row, combined, matrix_of
from bondgraph.algebra.residues import is_zero
from bondgraph.equations import StateEquations
from bondgraph.explaining.records import Factor, Formula, Step
from bondgraph.reduce.sorting import Reduction, field_row
from bondgraph.reduce.storages import stored_rate
from bondgraph.show.powers import powers


def inertia_step(equations: StateEquations) -> Step:
    """``A = M_x + S_xd M_d S_xd^T`` where storages are constant, else ``A = M_x - S_xd Z_d``.

    M_x: what the states' own storages hold per unit of x'; S_xd: what they receive from dependent
    storages; M_d: what those hold; Z_d: what they give per unit of x'.
    """
    reduction, shown = equations.reduction, powers(equations)
    if not shown.states:
        return Step("inertia", "")
    d = len(reduction.dependent)
    own = [dict(stored_rate(reduction, port).H) for port in reduction.states]
    kept = [equations.states.index(name) for name in shown.states]
    A = Factor("A", "A", shown.A)
    M_x = Factor("M_x", "M_{x}", _part(own, len(own), kept, kept))
    if not any(_from_dependent(reduction)):
        return Step("inertia", "The matrix A", (), (), (Formula(A, ((M_x,),)),))
    S_xd = Factor("S_xd", "S_{xd}", _part(_from_dependent(reduction), d, kept, [*range(d)]))
    given = [dict(reduction.columns[port].H) for port in reduction.dependent]
    M_d = _constant(reduction, given)
    turned = Factor("S_xd^T", "S_{xd}^{T}", S_xd.matrix.T)
    if M_d is not None:
        products = ((M_x,), (S_xd, Factor("M_d", "M_{d}", matrix_of(M_d, d)), turned))
        formula = Formula(A, products)
        text = (
            "S_xd: what the states' storages receive from the dependent ones; M_d: what these hold"
        )
    else:
        minus = Factor("(-S_xd)", "(-S_{xd})", -S_xd.matrix)
        Z_d = Factor("Z_d", "Z_{d}", _part(given, len(own), [*range(d)], kept))
        formula = Formula(A, ((M_x,), (minus, Z_d)))
        text = "S_xd: what the states' storages receive from the dependent ones; Z_d: what these give per x'"
    return Step("inertia", "The matrix A", (text,), (), (formula,))


def _part(
    found: list[Row], columns: int, kept_rows: list[int], kept_columns: list[int]
) -> sp.ImmutableSparseMatrix:
    """Rows as a matrix, without those of signals' states."""
    whole = matrix_of(found, columns)
    return sp.ImmutableSparseMatrix(whole.extract(kept_rows, kept_columns))


def _from_dependent(reduction: Reduction) -> list[Row]:
    place = {port: at for at, port in enumerate(reduction.dependent)}
    rows = map(reduction.driving, reduction.states)
    return [{place[i]: entry for i, entry in row.items() if i in place} for row in rows]


def _constant(reduction: Reduction, given: Sequence[Row]) -> list[Row] | None:
    """M_d, if what the dependent storages give is ``-M_d S_xd^T x'``; None where more is to it."""
    place = {port: at for at, port in enumerate(reduction.dependent)}
    if any(reduction.structure.ports[port].element.inverse for port in reduction.dependent):
        return None
    rows = [dict(field_row(reduction, port)) for port in reduction.dependent]
    if any(other not in place for row in rows for other in row):
        return None
    M_d: list[Row] = [{place[other]: value for other, value in row.items()} for row in rows]
    S_dx: list[Row] = [{} for _ in place]
    for i, row in enumerate(_from_dependent(reduction)):
        for at, entry in row.items():
            S_dx[at][i] = -entry
    for line, row in zip(M_d, given, strict=True):
        expected = combined((S_dx[at], value) for at, value in line.items())
        if not _equal(expected, row):
            return None
    return M_d


def _equal(one: Mapping[int, sp.Expr], other: Mapping[int, sp.Expr]) -> bool:
    zero = sp.Integer(0)
    return all(is_zero(one.get(j, zero) - other.get(j, zero)) for j in one.keys() | other.keys())
