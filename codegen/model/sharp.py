"""The rates of an affine model as rows over what it is given, with far more digits than doubles have.

Where storages and resistances differ by many powers of ten, the slow motions are in digits that
doubles round away: two masses that a stiff damper joins stop by a drag that is lost in its resistance.
"""

from collections.abc import Mapping, Sequence
from decimal import MAX_EMAX, MIN_EMIN, Context, Decimal, localcontext
from math import prod

import sympy as sp

from bondgraph.algebra.expressions import TIME
from codegen.numbers.pairs import Pair, from_decimals
from codegen.program.records import Block, Program

DIGITS = 120
"""Of all numbers here; pairs have 32."""

ONE = Decimal(1)

Form = dict[int, Decimal]
"""A sum of columns times numbers; the last column is 1."""


def sharp_rates(program: Program, parameters: Mapping[str, sp.Rational]) -> Pair:
    """The rates of s over [s, w, dw, 1], of an affine model without friction.

    ``parameters``: exact. s has one component where there is no state, as a closed model's.
    """
    with localcontext(Context(prec=DIGITS, Emax=MAX_EMAX, Emin=MIN_EMIN)):
        made = _Forms(program, parameters)
        rates = made.rates() or [{}]
        width = max(len(rates), 1) + 2 * len(program.external) + 1
        return from_decimals([[row.get(j, Decimal(0)) for j in range(width)] for row in rates])


class NotAffineError(ArithmeticError):
    """An expression is written in products of signals, which may cancel."""


class _Forms:
    """A program evaluated over forms, as a closed model evaluates it over numbers."""

    def __init__(self, program: Program, parameters: Mapping[str, sp.Rational]) -> None:
        self._program = program
        n, own = len(program.states), len(program.law_states)
        size, w = max(n + own, 1), len(program.external)
        self._one = size + 2 * w
        self._known: dict[sp.Symbol, Form] = {
            name: self._constant(_decimal(parameters[name.name])) for name in program.parameters
        }
        self._matrices = self._assembled()
        self._u: list[Form] = [{} for _ in program.inputs]
        self._du: list[Form] = [{} for _ in program.inputs]
        self._xi: list[Form] = [{j: ONE} for j in range(n)]
        self._z: list[Form] = [{n + j: ONE} for j in range(own)]
        self._w: list[Form] = [{size + j: ONE} for j in range(w)]
        self._dw: list[Form] = [{size + w + j: ONE} for j in range(w)]

    def rates(self) -> list[Form]:
        """The rate of each component of s; the steps are those of `ClosedModel.evaluate`."""
        program, matrices = self._program, self._matrices
        outside = program.given
        for at, column in enumerate(outside):
            self._u[column], self._du[column] = self._w[at], self._dw[at]
        x: list[Form] = []
        y: list[Form] = []
        self._give(program.known.inputs, program.known.values, self._u, x, y)
        self._give(program.known.inputs, program.known_rates, self._du, x, y)
        x = _added(self._xi, _product(matrices["R"], self._u))
        y = _product(matrices["F"], x)
        y = _added(y, _product(matrices["D"], self._u))
        y = _added(y, _product(matrices["G"], self._du))
        for group in program.groups:
            before = list(self._u)
            self._give(group.inputs, group.values, self._u, x, y)
            new = [
                _sum([(ONE, now), (Decimal(-1), old)])
                for now, old in zip(self._u, before, strict=True)
            ]
            y = _added(y, _product(matrices["D"], new))
        rates = _added(_product(matrices["P"], x), _product(matrices["Q"], self._u))
        return [*rates, *(y[at] for at in program.law_rates)]

    def _give(
        self, inputs: Sequence[int], code: Block, to: list[Form], x: list[Form], y: list[Form]
    ) -> None:
        """What laws give, where x and y are known so far."""
        program = self._program
        named: dict[sp.Symbol, Form] = {TIME: {}}
        for names, forms in (
            (program.external_rates, self._dw), (program.external, self._w),
            (program.inputs, self._u), (program.readings, y), (program.law_states, self._z),
            (program.states, x),
        ):  # fmt: skip
            named |= dict(zip(names, forms, strict=False))
        for column, value in zip(
            inputs, self._results(code, {**named, **self._known}), strict=True
        ):
            to[column] = value

    def _results(self, code: Block, named: dict[sp.Symbol, Form]) -> list[Form]:
        for name, expr in code.assignments:
            named[name] = self._form(expr, named)
        return [self._form(expr, named) for expr in code.results]

    def _form(self, expr: sp.Expr, named: Mapping[sp.Symbol, Form]) -> Form:
        """An expression in which products and powers have signals in one factor at most."""
        if expr.is_Symbol:
            return named[expr]
        if expr.is_Add:
            return _sum([(ONE, self._form(part, named)) for part in expr.args])
        parts = [self._form(part, named) for part in expr.args] if expr.is_Mul else []
        if parts:
            signals = [part for part in parts if not self._is_constant(part)]
            scale = prod(
                (self._number(part) for part in parts if self._is_constant(part)), start=ONE
            )
            if len(signals) < 2:
                return _sum([(scale, signals[0] if signals else self._constant(ONE))])
        elif all(self._is_constant(named[name]) for name in expr.free_symbols):
            if expr.is_Pow and expr.exp.is_Integer:
                return self._constant(self._number(self._form(expr.base, named)) ** int(expr.exp))
            known = {name: self._number(named[name]) for name in expr.free_symbols}
            return self._constant(_value(expr, known))
        expanded = sp.expand(expr)
        if expanded == expr:
            raise NotAffineError(f"{expr} is not affine in the signals")
        return self._form(expanded, named)

    def _is_constant(self, form: Form) -> bool:
        return set(form) <= {self._one}

    def _number(self, form: Form) -> Decimal:
        return form.get(self._one, Decimal(0))

    def _constant(self, value: Decimal) -> Form:
        return {self._one: value} if value else {}

    def _assembled(self) -> dict[str, list[Form]]:
        """The matrices as rows, solved for the rates: as `numbers.assembled`."""
        program = self._program
        values = self._results(program.coefficients, dict(self._known))
        rows: dict[str, list[Form]] = {}
        start = 0
        for name, pattern in program.layout.items():
            rows[name] = [{} for _ in range(pattern.shape[0])]
            for i, j in zip(pattern.rows, pattern.columns, strict=True):
                if values[start]:
                    rows[name][i][j] = values[start][self._one]
                start += 1
        for name, right in (("P", "J"), ("Q", "B"), ("R", "E")):
            rows[name] = _solved(rows["A"], rows[right])
        rows["F"] = _added(rows["F"], _product(rows["H"], rows["P"]))
        rows["D"] = _added(rows["D"], _product(rows["H"], rows["Q"]))
        rows["G"] = _added(rows["K"], _product(rows["H"], rows["R"]))
        return rows


def _sum(parts: Sequence[tuple[Decimal, Form]]) -> Form:
    total: Form = {}
    for factor, form in parts:
        for column, value in form.items():
            total[column] = total.get(column, Decimal(0)) + factor * value
    return {column: value for column, value in total.items() if value}


def _product(rows: Sequence[Form], forms: Sequence[Form]) -> list[Form]:
    return [_sum([(value, forms[j]) for j, value in row.items()]) for row in rows]


def _added(one: Sequence[Form], two: Sequence[Form]) -> list[Form]:
    return [_sum([(ONE, a), (ONE, b)]) for a, b in zip(one, two, strict=True)]


def _solved(A: Sequence[Form], right: Sequence[Form]) -> list[Form]:
    """``A^-1 right``, by elimination with the largest pivot of each column."""
    left, right = [dict(row) for row in A], [dict(row) for row in right]
    for i in range(len(left)):
        pivot = max(range(i, len(left)), key=lambda r: abs(left[r].get(i, Decimal(0))))
        left[i], left[pivot] = left[pivot], left[i]
        right[i], right[pivot] = right[pivot], right[i]
        scale = 1 / left[i][i]
        left[i], right[i] = _sum([(scale, left[i])]), _sum([(scale, right[i])])
        for r in range(len(left)):
            if r != i and i in left[r]:
                factor = -left[r][i]
                left[r] = _sum([(ONE, left[r]), (factor, left[i])])
                right[r] = _sum([(ONE, right[r]), (factor, right[i])])
                left[r].pop(i, None)
    return right


def _value(expr: sp.Expr, known: Mapping[sp.Symbol, Decimal]) -> Decimal:
    """A constant expression."""
    if expr.is_Rational:
        return _decimal(expr)
    digits = {name: sp.Float(str(value), DIGITS) for name, value in known.items()}
    return Decimal(str(sp.N(expr.xreplace(digits), DIGITS)))


def _decimal(value: sp.Rational) -> Decimal:
    return Decimal(int(value.p)) / Decimal(int(value.q))
