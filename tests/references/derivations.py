"""Checks a derivation as a reader would: its equations put into one another give what it ends with."""

import random
from collections.abc import Iterator, Mapping
from functools import cache, cached_property

import sympy as sp

import bondgraph as bg
import differentials

Values = dict[sp.Symbol, sp.Expr]


@cache
def explained(name: str, full: bool = False) -> bg.Explanation:
    """A differential's derivation, told once for all that is asked of it."""
    return bg.explain(differentials.graph(name, full))


class Reader:
    """What follows from the storages', laws' and junctions' equations that a derivation states.

    ``signals``: efforts and flows over what ports give; ``given``: what resistances and dependent
    storages give, as the derivation says.
    """

    def __init__(self, explanation: bg.Explanation) -> None:
        self.steps = {step.topic: step for step in explanation.steps}
        self.result = explanation.result
        self.signals = _followed(self.equations("junctions"))
        self.given = {one.left: one.right for one in self.equations("resistances")}
        self.given |= {
            one.left: one.right
            for one in self.equations("dependent")
            if not str(one.left).endswith("'") and not str(one.left).startswith(("p_", "q_"))
            and one.left not in self.signals
        }  # fmt: skip

    def equations(self, topic: str) -> tuple[bg.Equation, ...]:
        return self.steps[topic].equations if topic in self.steps else ()

    def value(self, expr: sp.Expr) -> sp.Expr:
        """An expression over states, inputs, their rates and integrals."""
        return expr.xreplace(self.signals).xreplace(self.given).xreplace(self.detected)

    @cached_property
    def detected(self) -> Values:
        return {one.left: one.right for one in self.equations("laws") if one.right == 0}

    @cached_property
    def integrals(self) -> Values:
        """The rates of integrals, by their names."""
        owners = {f"{one}'": one for one in self.result.integrals}
        rates = {one.left: one.right for one in self.equations("storages")}
        return {owners[str(r)]: self.value(right) for r, right in rates.items() if str(r) in owners}

    def rate(self, expr: sp.Expr) -> sp.Expr:
        """The total rate of an expression over states, inputs and integrals."""
        rates = {name: sp.Symbol(f"{name}'") for name in (*self.result.states, *self.result.inputs)}
        rates |= self.integrals
        return sp.Add(*(sp.diff(expr, name) * rate for name, rate in rates.items()))

    def storages(self) -> Iterator[tuple[sp.Expr, sp.Expr]]:
        """For every storage the rate of what it holds, and the effort or flow that this equals."""
        held = {one.left: one.right for one in self.equations("storages")}
        for left, right in held.items():
            name = sp.Symbol(str(left).rstrip("'"))
            if name in self.result.integrals or (left.is_Symbol and not str(left).endswith("'")):
                continue
            if name in held:
                yield self.rate(self.value(held[name])), right
            else:
                (variable,) = (s for s in left.free_symbols if str(s).endswith("'"))
                own = self.value(sp.Symbol(str(variable)[:-1]))
                yield left.coeff(variable) * self.rate(own), right


def _followed(equations: tuple[bg.Equation, ...]) -> Values:
    """Each signal over what is never on a left side, in the order the equations stand in."""
    lefts = {side for one in equations for side in one.expressions[:-1]}
    values: Values = {}
    for one in equations:
        right = one.right.xreplace(values)
        values |= dict.fromkeys(one.expressions[:-1], right)
    if any(value.free_symbols & lefts for value in values.values()):
        (values,) = sp.solve(
            [side - one.right for one in equations for side in one.expressions[:-1]],
            sorted(lefts, key=str), dict=True,
        )  # fmt: skip
    return values


def vanishes(expr: sp.Expr, seed: int = 1) -> bool:
    """Whether an expression is zero at a point of rational numbers, exactly where it has no functions."""
    rng = random.Random(seed)
    names = sorted(expr.free_symbols, key=str)
    point = {name: sp.Rational(rng.randint(2, 97), rng.randint(98, 199)) for name in names}
    value = expr.xreplace(point)
    return bool(value == 0 or abs(sp.N(value, 60)) < sp.Float("1e-40"))


def result_rows(equations: bg.StateEquations) -> list[sp.Expr]:
    """``A x' - J x - B u - E u'``, integrals, and ``y - F x - D u - G u'``, row by row."""
    x, u = sp.Matrix(equations.states), sp.Matrix(equations.inputs)
    dx, du = (
        sp.Matrix([sp.Symbol(f"{name}'") for name in names])
        for names in (equations.states, equations.inputs)
    )
    n, m, k = len(equations.states), len(equations.inputs), len(equations.outputs)
    x, dx, u, du = x.reshape(n, 1), dx.reshape(n, 1), u.reshape(m, 1), du.reshape(m, 1)
    upper = equations.A * dx - equations.J * x - equations.B * u - equations.E * du
    lower = sp.Matrix(k, 1, list(equations.outputs))
    lower -= equations.F * x + equations.D * u + equations.G * du
    integrals = [sp.Symbol(f"{name}'") - signal for name, signal in equations.integrals.items()]
    named = equations.with_readings(equations.integrals.values()).readings
    read = {
        name: sp.Matrix([[row.F.get(j, 0) for j in range(n)]]).dot(x) for name, row in named.items()
    }
    return [*upper, *(row.xreplace(read) for row in integrals), *lower]


def solved_rates(equations: bg.StateEquations) -> Mapping[sp.Symbol, sp.Expr]:
    """x' from the rows of ``A x' = ...``."""
    rates = [sp.Symbol(f"{name}'") for name in equations.states]
    found = sp.solve(result_rows(equations)[: len(rates)], rates, dict=True)
    return found[0] if found else {}
