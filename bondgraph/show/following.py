"""What a limited rate comes to: up, down, or along with what it reads."""

from dataclasses import dataclass

import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.reduce.motion import slope_of
from bondgraph.show.plain import plain
from bondgraph.show.ruled import Read, Way, at_most, below, cases
from bondgraph.show.sums import rate, typeset


@dataclass(frozen=True)
class Following(Read):
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
        met = sp.And(at_most(read, r), at_most(r, read))
        return (self.rise, below(r, read)), (-self.fall, below(read, r)), (along, met)

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
        return cases((rise, f"{read} > {r}"), (fall, f"{read} < {r}"), (led, along))
