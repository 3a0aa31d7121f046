"""Values of blocks: texts put together from what users tell; names stay names."""

from collections.abc import Iterable
from numbers import Real
from typing import Any

import sympy as sp

from bondgraph.algebra.atoms import number
from bondgraph.algebra.expressions import expression
from bondgraph.errors import ExpressionError, StructureError


def told(where: str, template: str, **parts: Any) -> str | sp.Expr:
    """A text with texts and numbers at its places, in brackets where they need some; with an expression
    of sympy among them an expression.

    Raises `StructureError`, naming ``where``, for a part that is none of these.

    >>> told("here", "max({low}, {input})", low=-1, input="a - b")
    'max((-1), (a - b))'
    >>> told("here", "{k}*{input}", k=sp.Symbol("k")**2, input="a - b")
    k**2*(a - b)
    """
    for part, value in parts.items():
        if not isinstance(value, str | Real | sp.Expr) or isinstance(value, bool):
            raise StructureError(
                f"{where}: its {part} is {value!r}; give a number, a name or an expression"
            )
    if not any(isinstance(value, sp.Expr) and not value.is_Rational for value in parts.values()):
        return template.format(**{part: _bracketed(where, one) for part, one in parts.items()})
    places = {part: f"{part}_" for part in parts}
    whole = expression(template.format(**places), where)
    given = {sp.Symbol(places[part]): expression(one, where) for part, one in parts.items()}
    return whole.xreplace(given)


def known(value: Any, where: str) -> sp.Rational | None:
    """The number that a value is, as a number or as a text; None of names and expressions.

    >>> known("0.5", "here"), known("k", "here")
    (1/2, None)
    """
    try:
        found = expression(value, where) if isinstance(value, str) else number(value, where)
    except ExpressionError:
        return None
    return found if isinstance(found, sp.Rational) else None


def ratio(where: str, top: Any, bottom: Any) -> Any:
    """A quotient, of two numbers exact."""
    if known(bottom, where) == 1:
        return top
    if (a := known(top, where)) is not None and (b := known(bottom, where)) is not None:
        return a / b
    return told(where, "{top}/{bottom}", top=top, bottom=bottom)


def combination(where: str, terms: Iterable[tuple[Any, Any]]) -> str | sp.Expr:
    """The sum of factors times signals, without those whose factor is zero.

    >>> combination("here", [(2, "x"), (0, "y"), (1, "z"), (-1, "u - v"), ("-k", "w")])
    '2*x + z - (u - v) - k*w'
    """
    text, parts = "", {}
    for at, (factor, signal) in enumerate(terms):
        size = known(factor, where)
        if size == 0:
            continue
        sign, rest = parted(factor) if size is None else ("-" if size < 0 else "", abs(size))
        text += f" {sign or '+'} " if text else sign
        parts[f"s{at}"] = signal
        if rest == 1:
            text += f"{{s{at}}}"
        else:
            text += f"{{f{at}}}*{{s{at}}}"
            parts[f"f{at}"] = rest
    return told(where, text or "0", **parts)


def parted(value: Any) -> tuple[str, Any]:
    """The minus before a name and the name; no minus and the same of anything else.

    >>> parted("-k"), parted("-k + 1")
    (('-', 'k'), ('', '-k + 1'))
    """
    text = value.strip() if isinstance(value, str) else ""
    return ("-", text[1:]) if text[:1] == "-" and text[1:].isidentifier() else ("", value)


def _bracketed(where: str, value: Any) -> str:
    if isinstance(value, str):
        text = value.strip()
        return text if text.isidentifier() or text.isdecimal() else f"({text})"
    size = number(value, where)
    text = repr(float(value)) if isinstance(value, float) else str(size)
    return text if size >= 0 and "/" not in text else f"({text})"
