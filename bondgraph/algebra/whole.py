"""The largest whole number that is not above an expression, whose jumps are known."""

from typing import Any

import sympy as sp

HARDLY = sp.Rational(1, 2**70)
"""Next to nothing, of 1."""


class Below(sp.floor):  # type: ignore[misc]
    """The same where nothing jumps, as on one side of a jump."""

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """It does not move between its jumps."""
        return sp.Integer(0)

    def _sympystr(self, printer: Any) -> str:
        return f"floor({printer._print(self.args[0])})"

    def _ccode(self, printer: Any) -> str:
        return f"floor({printer._print(self.args[0])})"

    def _pythoncode(self, printer: Any) -> str:
        return f"math.floor({printer._print(self.args[0])})"

    def _numpycode(self, printer: Any) -> str:
        return f"{printer._module_format('numpy.floor')}({printer._print(self.args[0])})"


class Floor(Below):
    """``floor(x)``: jumps by one wherever x passes a whole number.

    >>> x = sp.Symbol("x")
    >>> Floor(x), Floor(x).diff(x), Floor(sp.Rational(-3, 2))
    (floor(x), 0, -2)
    """

    @property
    def moves(self) -> bool:
        """Whether its argument moves by itself: that of ``floor(floor(x)/2)`` jumps where x does."""
        inside = self.args[0]
        still = {part: sp.Integer(0) for part in inside.atoms(Floor)}
        return bool(inside.xreplace(still).free_symbols)

    @property
    def crossing(self) -> sp.Expr:
        """What is zero where it jumps: above after an even number, below after an odd one."""
        return sp.sin(sp.pi * self.args[0])

    @property
    def size(self) -> sp.Expr:
        """The same with the sign of what is above it on a whole number itself, whatever rounding does."""
        whole = Below(self.args[0])
        after_even = 1 - 2 * (whole - 2 * Below(whole / 2))
        return after_even * (sp.sin(sp.pi * (self.args[0] - whole)) + HARDLY)

    def on_side(self, inside: sp.Expr, side: int) -> sp.Expr:
        """What it is at ``inside``, and goes on to be a half beyond, after an even number or an odd one."""
        half = sp.Rational(1, 2)
        return 2 * Below((inside + half) / 2) if side > 0 else 2 * Below((inside - half) / 2) + 1


def remainder(x: sp.Expr, by: sp.Expr) -> sp.Expr:
    """What is left of x by whole multiples, between 0 and ``by``.

    >>> x, y = sp.symbols("x y")
    >>> remainder(x, y), remainder(sp.Integer(-7), sp.Integer(3))
    (x - y*floor(x/y), 2)
    """
    return x - by * Floor(x / by)


def whole(expr: sp.Expr) -> sp.Expr:
    """An expression whose floors, ceilings, remainders and fractions are of `Floor`."""
    if not expr.has(sp.floor, sp.ceiling, sp.frac, sp.Mod):
        return expr
    expr = expr.replace(lambda part: type(part) is sp.floor, lambda part: Floor(part.args[0]))
    expr = expr.replace(sp.ceiling, lambda x: -Floor(-x))
    expr = expr.replace(sp.frac, lambda x: x - Floor(x))
    return expr.replace(sp.Mod, remainder)
