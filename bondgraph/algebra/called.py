"""Functions that generated code calls by a name of their own, and that are numbers at numbers."""

from collections.abc import Callable
from typing import Any

import sympy as sp


def has_value(found: sp.Expr) -> bool:
    """Whether what was asked for in numbers is one: sympy's zero in digits is an integer.

    >>> has_value(sp.Float(0.5)), has_value(sp.Integer(0)), has_value(sp.nan), has_value(sp.Symbol("x"))
    (True, True, False, False)
    """
    return bool(found.is_Number and found.is_finite)


class Called(sp.Function):  # type: ignore[misc]
    """A function whose first arguments say which one it is, the others being its arguments.

    To exact algebra nothing is known of it but its derivatives.
    """

    FIXED = 1
    """So many arguments come before those that have numbers."""

    GUARDS = False
    """Whether it is its argument, and there for refusing what is outside alone."""

    @property
    def places(self) -> tuple[sp.Expr, ...]:
        """The arguments that have numbers."""
        return tuple(self.args[self.FIXED :])

    @property
    def code(self) -> str:
        """What it is called in Python over numpy, where names that begin so are nobody else's."""
        raise NotImplementedError

    @property
    def numeric(self) -> Callable[..., float]:
        """The function of numbers that is called there."""
        raise NotImplementedError

    @property
    def is_number(self) -> bool:
        """Whether it has a value."""
        return all(place.is_number for place in self.places)

    def _eval_is_finite(self) -> bool | None:
        """A number, wherever it has one; nothing is told of others."""
        found = self.evalf() if self.is_number else None
        return True if found is not None and has_value(found) else None

    _eval_is_extended_real = _eval_is_finite

    def _eval_evalf(self, prec: int) -> sp.Expr | None:
        places = [place.evalf() for place in self.places]
        if not all(place.is_real for place in places):
            return None
        value = self.numeric(*map(float, places))
        return sp.nan if value != value else sp.Float(value, precision=prec)

    def _numpycode(self, printer: Any) -> str:
        return f"{self.code}({', '.join(map(printer._print, self.places))})"


def unguarded(expr: sp.Expr) -> sp.Expr:
    """The same without what is there for its ends alone."""
    return expr.replace(
        lambda part: isinstance(part, Called) and part.GUARDS, lambda part: part.places[0]
    )
