"""What nodes of signals with several ways come to: states within bounds and relays; `following` has more.

Each is one equation with a value for each way, and with when it is that: as text, as LaTeX, and as sympy.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import Protocol, Self

import sympy as sp

from bondgraph.show.plain import plain
from bondgraph.show.sums import rate, typeset

Into = Callable[[sp.Expr], sp.Expr]
"""Puts something into an expression."""

Way = tuple[sp.Expr, sp.Basic]
"""A value, and the condition under which it may be that."""


class Ruled(Protocol):
    """A left side, its name's node apart, that is one of several values."""

    @property
    def left(self) -> sp.Symbol:
        """What is told."""

    @property
    def reads(self) -> set[sp.Symbol]:
        """The names on the right."""

    @property
    def expressions(self) -> tuple[sp.Expr, ...]:
        """All that `put` puts into, in its order."""

    @property
    def ways(self) -> tuple[Way, ...]:
        """Under no condition is there none; where two hold, as of what remembers, it is one of them."""

    def put(self, into: Into) -> Self:
        """The same with something put into what is read."""

    def text(self, whole: bool = True) -> str:
        """The right side; not ``whole``: without what has been told beside the same before."""

    def latex(self) -> str:
        """The right side in LaTeX."""


class Read:
    """What such records have in common: their expressions are their fields but the first, their name."""

    @property
    def reads(self) -> set[sp.Symbol]:
        """The names on the right."""
        return set().union(*(value.free_symbols for value in self.expressions))

    @property
    def expressions(self) -> tuple[sp.Expr, ...]:
        """All that is read, each by itself."""
        return tuple(value for value in self._given().values() if value is not None)

    def put(self, into: Into) -> Self:
        """The same with something put into what is read."""
        told = {k: None if value is None else into(value) for k, value in self._given().items()}
        return replace(self, **told)  # type: ignore[type-var]

    def _given(self) -> dict[str, sp.Expr | None]:
        return {one.name: getattr(self, one.name) for one in fields(self)[1:]}  # type: ignore[arg-type]


@dataclass(frozen=True)
class Bounded(Read):
    """A state that stays within bounds: at one it rests while its rate leads beyond.

    >>> z, u = sp.symbols("z u")
    >>> print(Bounded(z, u, sp.Integer(-1), None).text())
    u within -1 <= z: at the bound z' = 0 while u leads beyond
    """

    state: sp.Symbol
    rate: sp.Expr
    low: sp.Expr | None
    high: sp.Expr | None

    @property
    def left(self) -> sp.Symbol:
        """Its rate."""
        return rate(self.state)

    @property
    def ways(self) -> tuple[Way, ...]:
        """Zero at a bound, the rate everywhere else."""
        zero, z, led = sp.Integer(0), self.state, self.rate
        found: list[Way] = []
        free: list[sp.Basic] = []
        if self.low is not None:
            found.append((zero, sp.And(at_most(z, self.low), at_most(led, zero))))
            free.append(sp.Or(below(self.low, z), at_most(zero, led)))
        if self.high is not None:
            found.append((zero, sp.And(at_most(self.high, z), at_most(zero, led))))
            free.append(sp.Or(below(z, self.high), at_most(led, zero)))
        return (*found, (led, sp.And(*free)))

    def text(self, whole: bool = True) -> str:
        """``rate within low <= z <= high``, and what it does at a bound."""
        told = f"{plain(self.rate)} within {self._within(plain, '<=')}"
        if not whole:
            return told
        led = plain(self.rate) if self.rate.is_Symbol else "that"
        return f"{told}: at {self._where} {self.left} = 0 while {led} leads beyond"

    def latex(self) -> str:
        """Cases: within and at a bound."""
        led = typeset(self.rate)
        within = self._within(typeset, r"\leq")
        at = rf"\text{{at {self._where}, while this leads beyond}}"
        return cases((led, rf"\text{{within }} {within}"), ("0", at))

    @property
    def _where(self) -> str:
        return "the bound" if None in (self.low, self.high) else "a bound"

    def _within(self, written: Callable[[sp.Expr], str], sign: str) -> str:
        parts = [written(one) for one in (self.low, self.state, self.high) if one is not None]
        return f" {sign} ".join(parts)


@dataclass(frozen=True)
class Turning(Read):
    """A signal of two values that remembers: one once it reads more than ``high``, one once less.

    >>> relay, omega = sp.symbols("relay omega")
    >>> print(Turning(relay, omega, *map(sp.Integer, (1, 2, 0, 1))).text())
    1 once omega > 2, 0 once omega < 1
    """

    name: sp.Symbol
    read: sp.Expr
    low: sp.Expr
    high: sp.Expr
    off: sp.Expr
    on: sp.Expr

    @property
    def left(self) -> sp.Symbol:
        """The signal."""
        return self.name

    @property
    def ways(self) -> tuple[Way, ...]:
        """Between the thresholds both may be."""
        return (self.on, at_most(self.low, self.read)), (self.off, at_most(self.read, self.high))

    def text(self, whole: bool = True) -> str:
        """``on once read > high, off once read < low``."""
        read = plain(self.read)
        return (
            f"{plain(self.on)} once {read} > {plain(self.high)}, "
            f"{plain(self.off)} once {read} < {plain(self.low)}"
        )

    def latex(self) -> str:
        """Cases: on and off."""
        return cases(
            (typeset(self.on), rf"\text{{once }} {typeset(self.read)} > {typeset(self.high)}"),
            (typeset(self.off), rf"\text{{once }} {typeset(self.read)} < {typeset(self.low)}"),
        )


def at_most(low: sp.Expr, high: sp.Expr) -> sp.Basic:
    """That one is not above the other, unsolved."""
    return sp.Le(low, high, evaluate=False)


def below(low: sp.Expr, high: sp.Expr) -> sp.Basic:
    """That one is below the other, unsolved."""
    return sp.Lt(low, high, evaluate=False)


def cases(*rows: tuple[str, str]) -> str:
    """Values and when they are so, in LaTeX."""
    body = r" \\ ".join(f"{value} & {when}" for value, when in rows)
    return rf"\begin{{cases}} {body} \end{{cases}}"
