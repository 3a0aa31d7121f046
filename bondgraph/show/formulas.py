"""Rates as equations, one a line: text and LaTeX."""

from collections.abc import Mapping

import sympy as sp

from bondgraph.show.display import MOST_SIGNS, written
from bondgraph.show.latex import aligned
from bondgraph.show.statements import Statement
from bondgraph.show.sums import rate, signed_terms


def rates_text(rates: Mapping[sp.Symbol, sp.Expr]) -> str:
    """``v' = F/m - ...``, a state a line, long ones on several.

    >>> m, F, v = sp.symbols("m F v")
    >>> print(rates_text({v: F/m}))
    v' = F/m
    """
    one = sp.Integer(1)
    return "\n".join(
        line
        for state, right in rates.items()
        for line in written([(one, rate(state))], signed_terms(right))
    )


def rates_latex(rates: Mapping[sp.Symbol, sp.Expr]) -> str | None:
    """The same for a notebook; None where nothing is there, or it is too long to be read."""
    text = aligned(Statement(rate(state), signed_terms(right)) for state, right in rates.items())
    return f"$${text}$$" if text and len(text) <= 4 * MOST_SIGNS else None
