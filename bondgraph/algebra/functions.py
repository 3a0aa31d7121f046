"""The functions that text may use, and what expressions may be made of."""

from collections.abc import Callable
from typing import Any

import sympy as sp

from bondgraph.algebra.whole import Floor, remainder


def hypotenuse(a: sp.Expr, b: sp.Expr) -> sp.Expr:
    """The longest side of a triangle with a right angle between sides ``a`` and ``b``."""
    return sp.sqrt(a**2 + b**2)


FUNCTIONS: dict[str, tuple[int, int, Callable[..., Any]]] = {
    "sin": (1, 1, sp.sin),
    "cos": (1, 1, sp.cos),
    "tan": (1, 1, sp.tan),
    "asin": (1, 1, sp.asin),
    "acos": (1, 1, sp.acos),
    "atan": (1, 1, sp.atan),
    "atan2": (2, 2, sp.atan2),
    "sinh": (1, 1, sp.sinh),
    "cosh": (1, 1, sp.cosh),
    "tanh": (1, 1, sp.tanh),
    "exp": (1, 1, sp.exp),
    "log": (1, 1, sp.log),
    "log10": (1, 1, lambda x: sp.log(x, 10)),
    "sqrt": (1, 1, sp.sqrt),
    "hypot": (2, 2, hypotenuse),
    "abs": (1, 1, sp.Abs),
    "Abs": (1, 1, sp.Abs),
    "sign": (1, 1, sp.sign),
    "min": (2, 16, sp.Min),
    "floor": (1, 1, Floor),
    "ceil": (1, 1, lambda x: -Floor(-x)),
    "mod": (2, 2, remainder),
    "max": (2, 16, sp.Max),
    "Min": (2, 16, sp.Min),
    "Max": (2, 16, sp.Max),
}
"""Functions that text may use: least and most number of arguments, and what is built."""

PARTS = (
    sp.Add, sp.Mul, sp.Pow, sp.Symbol, sp.Number, sp.NumberSymbol, sp.exp,
    *(build for *_, build in FUNCTIONS.values() if isinstance(build, type)),
    sp.Piecewise, sp.functions.elementary.piecewise.ExprCondPair,
    sp.core.relational.Relational, sp.logic.boolalg.BooleanFunction, sp.logic.boolalg.BooleanAtom,
)  # fmt: skip
"""What an expression may be made of."""

ALLOWED = (
    "an expression holds numbers, names, + - * / **, the functions "
    f"{', '.join(sorted(FUNCTIONS))}, and Piecewise((value, condition), ..., (value, True))"
)
"""What a refusal names as the way out."""


def without_logarithms(expr: sp.Expr) -> sp.Expr:
    """An expression in which an exponential of a sum of logarithms is a product, as mass action is.

    It is the same where the logarithms are numbers.

    >>> a, b, RT = sp.symbols("a b RT")
    >>> without_logarithms(sp.exp((RT*sp.log(a) + 2*RT*sp.log(b))/RT))
    a*b**2
    """

    def product(part: sp.Expr) -> sp.Expr:
        inside = part.args[0]
        found = sp.exp(sp.expand_mul(inside))
        return found if len(found.atoms(sp.log)) < len(inside.atoms(sp.log)) else part

    return expr.replace(lambda part: isinstance(part, sp.exp) and part.has(sp.log), product)
