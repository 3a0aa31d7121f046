"""Names and numbers of expressions: plain symbols, exact rationals, and how large a number may be."""

import keyword
import math
import unicodedata
from fractions import Fraction
from numbers import Integral, Rational, Real
from typing import Any

import sympy as sp

from bondgraph.errors import ExpressionError

MAX_EXPONENT = 1_000
MAX_DIGITS = 400

CONSTANTS = {"pi": sp.pi}
"""Names of numbers, in text; no symbol may have one of them."""


def normal(name: object) -> object:
    """A name as Python itself would read it: letters that look alike are one letter (NFKC)."""
    return unicodedata.normalize("NFKC", name) if isinstance(name, str) else name


def symbol(name: object, where: str) -> sp.Symbol:
    """A plain symbol of that name, refused if generated code could not carry the name.

    >>> symbol("omega_1", "node 'left'")
    omega_1
    """
    name = normal(name)
    if not isinstance(name, str) or not name.isidentifier() or keyword.iskeyword(name):
        raise ExpressionError(
            f"{where}: {name!r} cannot be a symbol; use letters, digits and underscores, "
            "not starting with a digit and not a Python keyword"
        )
    if name in CONSTANTS:
        raise ExpressionError(f"{where}: {name} is a number and cannot be a symbol; rename it")
    return sp.Symbol(name)


def number(value: object, where: str) -> sp.Rational:
    """The exact rational that a Python or numpy number stands for, floats by their shortest decimal.

    >>> number(0.3, "parameter 'r'")
    3/10
    """
    if isinstance(value, bool) or not isinstance(value, Real | sp.Number):
        raise ExpressionError(f"{where}: {value!r} is not a number")
    if isinstance(value, Integral):
        return sp.Integer(int(value))
    if isinstance(value, Rational):
        return sp.Rational(int(value.numerator), int(value.denominator))
    return decimal(value, where)


def decimal(value: Any, where: str) -> sp.Rational:
    """The rational of a float's shortest decimal form."""
    if not math.isfinite(float(value)):
        raise ExpressionError(f"{where}: {value!r} is not a finite number")
    # numpy writes a short float as the decimal it was meant to be; sympy would pad it.
    text = repr(float(value)) if isinstance(value, float | sp.Float) else str(value)
    exact = Fraction(text)
    return sp.Rational(exact.numerator, exact.denominator)
