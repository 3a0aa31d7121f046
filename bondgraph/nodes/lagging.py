"""`Lagging`: what a delay gives, of what, how late."""

from dataclasses import dataclass

import sympy as sp


@dataclass(frozen=True)
class Lagging:
    """``given(t) = value(t - time)``, and ``start`` for as long as there is nothing to read yet.

    ``time`` [s] and ``start`` are numbers or have parameters; ``value`` is an expression of signals.
    """

    given: sp.Symbol
    value: sp.Expr
    time: sp.Expr
    start: sp.Expr
