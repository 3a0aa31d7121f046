"""Laws turned round by a search: functions of what a law gives, whose slopes are told by the law's."""

import hashlib
from collections.abc import Callable
from functools import cached_property
from typing import Any, Self

import sympy as sp

from bondgraph.algebra.called import Called, has_value
from bondgraph.inverses.rising import Rising, rising
from bondgraph.searching import place_where

PLACE = sp.Symbol("x")
"""The argument of a law that is turned round, inside it."""


class Turning(sp.AtomicExpr):  # type: ignore[misc]
    """A law that goes one way, its parameters ``a0``, ``a1``, ...: which function an `Inverse` is.

    ``shown``: what shows that it goes one way. ``begin``: where searches begin, of the parameters.
    """

    __slots__ = ("__dict__", "begin", "count", "law", "shown")
    is_commutative = True
    is_number = False

    law: sp.Expr
    count: int
    shown: Rising
    begin: sp.Expr

    def __new__(cls, law: sp.Expr, count: int, shown: Rising, begin: sp.Expr) -> Self:
        """The same object to sympy where laws are equal."""
        made: Self = sp.AtomicExpr.__new__(cls)
        made.law, made.count, made.shown, made.begin = law, count, shown, begin
        return made

    def __getnewargs__(self) -> tuple[sp.Expr, int, Rising, sp.Expr]:
        return self.law, self.count, self.shown, self.begin

    def _hashable_content(self) -> tuple[sp.Expr, int, sp.Tuple, sp.Expr]:
        # What sympy puts in order, it compares part by part.
        shown = sp.Tuple(
            self.shown.slope, sp.Tuple(*self.shown.positive), sp.Tuple(*self.shown.domain)
        )
        return self.law, self.count, shown, self.begin

    @property
    def parameters(self) -> tuple[sp.Symbol, ...]:
        """The names of its parameters, in order."""
        return tuple(sp.Symbol(f"a{at}") for at in range(self.count))

    @cached_property
    def code(self) -> str:
        """A name that no other law has."""
        parts = (self.law,) if self.begin == 0 else (self.law, self.begin)
        told = " from ".join(map(sp.srepr, parts))
        return f"inverse_{hashlib.sha256(told.encode()).hexdigest()[:12]}"

    def evaluated(self) -> list[sp.Expr]:
        """What a step of the search needs: law and slope, then all that is positive in the domain."""
        return [self.law, self.shown.slope, *self.shown.positive, *self.shown.domain]

    @cached_property
    def solver(self) -> Callable[..., float]:
        """The place where the law has a value, of that and its parameters; no number where nowhere."""
        law = sp.lambdify([PLACE, *self.parameters], self.evaluated(), modules="math", cse=True)
        begin = sp.lambdify(self.parameters, self.begin, modules="math")

        def solved(value: float, *given: float) -> float:
            return place_where(lambda x: law(x, *given), value, float(begin(*given)))

        return solved

    def _sympystr(self, printer: Any) -> str:
        return self.code


class Inverse(Called):
    """``Inverse(turning, value, a0, ...)``: where a law has a value, its parameters being these."""

    @property
    def turning(self) -> Turning:
        """The law."""
        found: Turning = self.args[0]
        return found

    @property
    def law(self) -> sp.Expr:
        """The law at the place that is found."""
        return self._there(self.turning.law)

    @property
    def code(self) -> str:
        """What it is called in Python over numpy."""
        return f"_{self.turning.code}"

    @property
    def numeric(self) -> Callable[..., float]:
        """Of the value and the parameters."""
        return self.turning.solver

    @property
    def is_number(self) -> bool:
        """Whether it has a value: not where the law never comes to that."""
        return super().is_number and has_value(self.evalf())

    def _eval_evalf(self, prec: int) -> sp.Expr | None:
        found = super()._eval_evalf(prec)
        return None if found is sp.nan else found

    @property
    def begin(self) -> sp.Expr:
        """Where searches begin."""
        names = self.turning.parameters
        return self.turning.begin.xreplace(dict(zip(names, self.places[1:], strict=True)))

    @property
    def needed(self) -> tuple[sp.Expr, ...]:
        """What has to be positive for the law to go one way."""
        return tuple(map(self._there, self.turning.shown.positive))

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """The law's slope below: one, or what a parameter changes the law by with the other sign."""
        slope = self._there(self.turning.shown.slope)
        if argindex == 2:
            return 1 / slope
        moved = sp.diff(self.turning.law, self.turning.parameters[argindex - 3])
        return -self._there(moved) / slope

    def _there(self, expr: sp.Expr) -> sp.Expr:
        """An expression of the law's names at the place that is found."""
        names = self.turning.parameters
        return expr.xreplace({PLACE: self, **dict(zip(names, self.places[1:], strict=True))})

    def _equation(self) -> sp.Expr:
        names = self.turning.parameters
        law = self.turning.law.xreplace(dict(zip(names, self.places[1:], strict=True)))
        return law - self.places[0]

    def _sympystr(self, printer: Any) -> str:
        return f"root({printer._print(self._equation())}, x)"

    def _latex(self, printer: Any, exp: str | None = None) -> str:
        inside = printer._print(self._equation())
        text = rf"\operatorname{{root}}_{{x}}\left({inside}\right)"
        return text if exp is None else rf"{{{text}}}^{{{exp}}}"


def inverse_of(law: sp.Expr, state: sp.Symbol, value: sp.Expr) -> sp.Expr | None:
    """The state where the law has a value, found by search; None where the law is not shown to go one way.

    >>> q, k, e = sp.symbols("q k e")
    >>> found = inverse_of(k*q + q**3, q, e)
    >>> found, found.diff(e).subs({k: 1, e: 10}).evalf(5)
    (root(-e + k*x + x**3, x), 0.076923)
    """
    shown = rising(law, state)
    return None if shown is None else inverse_from(law, state, value, shown, sp.Integer(0))


def inverse_from(
    law: sp.Expr, state: sp.Symbol, value: sp.Expr, shown: Rising, begin: sp.Expr
) -> sp.Expr:
    """The state where a law has a value, found by search from a place on; ``shown``: that it goes one way."""
    names = sorted((law.free_symbols | begin.free_symbols) - {state}, key=str)
    put = {state: PLACE, **{name: sp.Symbol(f"a{at}") for at, name in enumerate(names)}}
    told = Rising(
        shown.slope.xreplace(put),
        tuple(one.xreplace(put) for one in shown.positive),
        tuple(one.xreplace(put) for one in shown.domain),
    )
    return Inverse(Turning(law.xreplace(put), len(names), told, begin.xreplace(put)), value, *names)
