"""One set of equations of a graph with switches, solved in one mode at one complex frequency, exactly."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import sympy as sp
from sympy.polys.matrices import DomainMatrix

import bondgraph as bg
from bondgraph.reduce.record import Reading

Answers = Mapping[sp.Symbol, Mapping[sp.Symbol, sp.Expr]]
"""Every signal per unit of every source and open port, at one complex frequency."""


def pencil(
    equations: bg.StateEquations, held: Iterable[bg.SwitchPort], s: sp.Rational
) -> tuple[sp.Matrix, sp.Matrix, list[int]]:
    """``(s A - J) x - B_H u_H = (B + s E) v`` over ``F_H x + D_HH u_H = -(D_HK + s K_HK) v``.

    Both matrices, and the inputs' columns: of what holds ports, then of sources and open ports.
    """
    switched = {equations.inputs.index(one.port.given) for one in equations.switches}
    columns = [equations.inputs.index(one.port.given) for one in held]
    driven = [j for j in range(len(equations.inputs)) if j not in switched]
    rows = [equations.readings[one.port.received] for one in held]
    n, h = len(equations.states), len(columns)
    left, right = sp.zeros(n + h, n + h), sp.zeros(n + h, len(driven))
    left[:n, :n] = s * equations.A - equations.J
    for at, j in enumerate(columns):
        left[:n, n + at] = -equations.B[:, j]
    for at, j in enumerate(driven):
        right[:n, at] = equations.B[:, j] + s * equations.E[:, j]
    for i, row in enumerate(rows, start=n):
        assert not row.H
        for j, entry in row.F.items():
            left[i, j] = entry
        for at, j in enumerate(columns):
            left[i, n + at] = row.D.get(j, 0)
        for at, j in enumerate(driven):
            right[i, at] = -row.D.get(j, 0) - s * row.K.get(j, 0)
    return left, right, [*columns, *driven]


def determinant(left: sp.Matrix) -> sp.Expr:
    """The determinant of a matrix of rationals."""
    return sp.QQ.to_sympy(DomainMatrix.from_Matrix(left).convert_to(sp.QQ).det())


def solved(left: sp.Matrix, right: sp.Matrix) -> sp.Matrix:
    """``left^-1 right`` of rationals."""
    if not left.rows:
        return sp.zeros(0, right.cols)
    one, other = (DomainMatrix.from_Matrix(m).convert_to(sp.QQ) for m in (left, right))
    return one.lu_solve(other).to_Matrix()


def answers(equations: bg.StateEquations, held: Iterable[bg.SwitchPort], s: sp.Rational) -> Answers:
    """Every named signal, ports in ``held`` being held and other switches giving zero."""
    left, right, order = pencil(equations, list(held), s)
    n, h = len(equations.states), left.rows - len(equations.states)
    found = solved(left, right)
    driven = order[h:]
    result: dict[sp.Symbol, dict[sp.Symbol, sp.Expr]] = {name: {} for name in equations.signals}
    readings = {name: equations.reduction.reading(row) for name, row in equations.signals.items()}
    for at, source in enumerate(driven):
        u = {j: found[n + k, at] for k, j in enumerate(order[:h])} | {source: sp.Integer(1)}
        x = dict(enumerate(found[:n, at]))
        for name, row in readings.items():
            value = _at(row, x, u, s)
            result[name][equations.inputs[source]] = value
    return result


def _at(
    row: Reading, x: Mapping[int, sp.Expr], u: Mapping[int, sp.Expr], s: sp.Rational
) -> sp.Expr:
    total = sum((entry * x[j] for j, entry in row.F.items()), sp.Integer(0))
    total += sum(entry * u.get(j, 0) for j, entry in row.D.items())
    total += s * sum(entry * x[j] for j, entry in row.H.items())
    return total + s * sum(entry * u.get(j, 0) for j, entry in row.K.items())


def of_the_mode(equations: bg.StateEquations, s: sp.Rational, zero: set[sp.Symbol]) -> Answers:
    """The same of equations of one mode, whose inputs that are ``zero`` are none."""
    return {
        name: {source: value for source, value in row.items() if source not in zero}
        for name, row in answers(equations, [], s).items()
    }
