"""Whether explicit rates are those of the matrices: ``A x' - J x - B u - E u'`` at rational numbers."""

import random
from collections.abc import Mapping

import sympy as sp

import bondgraph as bg


def rationals(names: "set[sp.Symbol]", seed: int = 0) -> dict[sp.Symbol, sp.Rational]:
    """A rational number for each name, none of them zero, the same whatever other names there are."""
    return {
        name: sp.Rational(random.Random(f"{seed} {name}").randint(1, 40), 7)
        * random.Random(f"{seed} sign {name}").choice([1, 1, 1, -1])
        for name in names
    }


def at(expr: sp.Expr, point: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
    """An expression at a point: exact where it is a fraction of polynomials, else in forty digits."""
    value = sp.sympify(expr).xreplace(dict(point))
    return value if value.is_Rational else sp.N(value, 40)


def rates_at(
    found: "bg.ExplicitRates", point: Mapping[sp.Symbol, sp.Expr]
) -> dict[sp.Symbol, sp.Expr]:
    """The rates of states at a point, parts with names worked out one after the other."""
    assert not found.implicit
    known = dict(point)
    for name, part in found.where.items():
        known[name] = at(part, known)
    return {state: at(rate, known) for state, rate in found.items()}


def left_over(
    equations: bg.StateEquations, found: "bg.ExplicitRates", seed: int = 0
) -> list[sp.Expr]:
    """``A x' - J x - B u - E u'`` of equations without laws, row by row, relative to its largest term."""
    rates_of = {u: sp.Symbol(f"d_{u}") for u in equations.inputs}
    point = rationals({*equations.parameters, *equations.states, *equations.inputs, *rates_of.values(),
                       *equations.varying, *equations.integrals}, seed)  # fmt: skip
    rates = rates_at(found, point)
    x = {j: point[name] for j, name in enumerate(equations.states)}
    u = {j: point[name] for j, name in enumerate(equations.inputs)}
    du = {j: point[rates_of[name]] for j, name in enumerate(equations.inputs)}
    dx = {j: rates[name] for j, name in enumerate(equations.states)}
    left = []
    for i in range(len(equations.states)):
        terms = [
            sign * at(entry, point) * column[j]
            for sign, matrix, column in ((1, equations.A, dx), (-1, equations.J, x),
                                         (-1, equations.B, u), (-1, equations.E, du))
            for (row, j), entry in matrix.todok().items() if row == i
        ]  # fmt: skip
        left.append(sp.Add(*terms) / max([1, *map(abs, terms)]))
    return left
