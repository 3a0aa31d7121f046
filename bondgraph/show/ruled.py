"""What nodes of signals with several ways come to: states within bounds, relays, signals of a bounded rate.

Each is one equation with a value for each way, and with when it is that: as text, as LaTeX, and as sympy.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import Protocol, Self

import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.reduce.motion import slope_of
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


class _Read:
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
class Bounded(_Read):
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
            found.append((zero, sp.And(_le(z, self.low), _le(led, zero))))
            free.append(sp.Or(_lt(self.low, z), _le(zero, led)))
        if self.high is not None:
            found.append((zero, sp.And(_le(self.high, z), _le(zero, led))))
            free.append(sp.Or(_lt(z, self.high), _le(led, zero)))
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
        return _cases((led, rf"\text{{within }} {within}"), ("0", at))

    @property
    def _where(self) -> str:
        return "the bound" if None in (self.low, self.high) else "a bound"

    def _within(self, written: Callable[[sp.Expr], str], sign: str) -> str:
        parts = [written(one) for one in (self.low, self.state, self.high) if one is not None]
        return f" {sign} ".join(parts)


@dataclass(frozen=True)
class Turning(_Read):
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
        return (self.on, _le(self.low, self.read)), (self.off, _le(self.read, self.high))

    def text(self, whole: bool = True) -> str:
        """``on once read > high, off once read < low``."""
        read = plain(self.read)
        return (
            f"{plain(self.on)} once {read} > {plain(self.high)}, "
            f"{plain(self.off)} once {read} < {plain(self.low)}"
        )

    def latex(self) -> str:
        """Cases: on and off."""
        return _cases(
            (typeset(self.on), rf"\text{{once }} {typeset(self.read)} > {typeset(self.high)}"),
            (typeset(self.off), rf"\text{{once }} {typeset(self.read)} < {typeset(self.low)}"),
        )


@dataclass(frozen=True)
class Following(_Read):
    """A state that goes to what it reads at a bounded rate, and follows it where that is slower.

    >>> r, step = sp.symbols("r step")
    >>> print(Following(r, step, sp.Integer(2), sp.Integer(2)).text())
    2 while step > r, -2 while step < r; r = step while |step'| <= 2
    """

    state: sp.Symbol
    read: sp.Expr
    rise: sp.Expr
    fall: sp.Expr

    @property
    def left(self) -> sp.Symbol:
        """Its rate."""
        return rate(self.state)

    @property
    def ways(self) -> tuple[Way, ...]:
        """Up, down, and along with what it reads."""
        r, read = self.state, self.read
        names = sorted(read.free_symbols, key=str)
        slope = sp.Add(*(slope_of(read, n) * (1 if n == TIME else rate(n)) for n in names))
        along = sp.Max(-self.fall, sp.Min(self.rise, slope))
        met = sp.And(_le(read, r), _le(r, read))
        return (self.rise, _lt(r, read)), (-self.fall, _lt(read, r)), (along, met)

    def text(self, whole: bool = True) -> str:
        """``rise while read > r, -fall while read < r; r = read while slow enough``."""
        r, read, rise, fall = map(plain, (self.state, self.read, self.rise, -self.fall))
        led = f"{read}'" if self.read.is_Symbol else f"({read})'"
        slow = f"|{led}| <= {rise}" if self.rise == self.fall else f"{fall} <= {led} <= {rise}"
        return f"{rise} while {read} > {r}, {fall} while {read} < {r}; {r} = {read} while {slow}"

    def latex(self) -> str:
        """Cases: up, down and along."""
        r, read, rise, fall = map(typeset, (self.state, self.read, self.rise, -self.fall))
        led = (
            typeset(rate(self.read)) if self.read.is_Symbol
            else rf"\frac{{d}}{{dt}}\left({read}\right)"
        )  # fmt: skip
        slow = (
            rf"|{led}| \leq {rise}" if self.rise == self.fall
            else rf"{fall} \leq {led} \leq {rise}"
        )  # fmt: skip
        along = rf"{r} = {read},\ \text{{while }} {slow}"
        return _cases((rise, f"{read} > {r}"), (fall, f"{read} < {r}"), (led, along))


def _le(low: sp.Expr, high: sp.Expr) -> sp.Basic:
    """That one is not above the other, unsolved."""
    return sp.Le(low, high, evaluate=False)


def _lt(low: sp.Expr, high: sp.Expr) -> sp.Basic:
    return sp.Lt(low, high, evaluate=False)


def _cases(*rows: tuple[str, str]) -> str:
    body = r" \\ ".join(f"{value} & {when}" for value, when in rows)
    return rf"\begin{{cases}} {body} \end{{cases}}"
