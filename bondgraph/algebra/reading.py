"""Text becomes an expression by the syntax it has; nothing is ever evaluated as Python."""

import ast
import re
from collections.abc import Callable, Mapping
from typing import Any

import sympy as sp

from bondgraph.algebra.atoms import CONSTANTS, MAX_DIGITS, MAX_EXPONENT, normal, number, symbol
from bondgraph.algebra.conditions import PIECEWISE, read_pieces
from bondgraph.algebra.functions import ALLOWED, FUNCTIONS
from bondgraph.errors import ExpressionError, nearest, shortened

MAX_LENGTH = 4_000
MAX_DEPTH = 100

_BINARY: dict[type, Callable[[Any, Any], Any]] = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b,
    ast.Pow: lambda a, b: _power(a, b),
}

_SPELLED: dict[type, str] = {
    ast.BitXor: "a power is written **, as in x**2",
    ast.IfExp: "a choice is written Piecewise((a, condition), (b, True))",
    ast.Compare: "a comparison stands in a condition, as in Piecewise((a, x > 1), (b, True))",
    ast.BoolOp: "and, or, not stand in a condition, as in Piecewise((a, x > 1 and y > 1), (b, True))",
    ast.Not: "and, or, not stand in a condition, as in Piecewise((a, not x > 1), (b, True))",
}
"""What belongs somewhere else or is spelled otherwise here."""

_OTHERWISE = dict.fromkeys(
    ("clip", "clamp", "limit", "sat", "saturate", "saturation"),
    "a bound is written max(low, min(high, x))",
) | {"if": "a choice is written Piecewise((a, condition), (b, True))"}
"""Functions of other languages, and what says the same here."""

_SYMBOLS = (("&&", "and"), ("||", "or"), ("!", "not"), ("=", "=="))
"""Spellings of other languages that are no syntax here."""


Functions = Mapping[str, tuple[int, int, Callable[..., Any]]]
"""What text may call: least and most number of arguments, and what is built."""


def read(text: str, where: str, functions: Functions = FUNCTIONS) -> sp.Expr:
    """The expression of a text; `ExpressionError`, naming ``where``, for what is none."""
    if len(text) > MAX_LENGTH:
        raise ExpressionError(f"{where}: text of {len(text)} characters, at most {MAX_LENGTH}")
    if _nesting(text) > MAX_DEPTH:
        raise ExpressionError(f"{where}: parentheses nested deeper than {MAX_DEPTH}")
    try:
        return _build(ast.parse(text.strip(), mode="eval").body, where, 0, functions)
    except ExpressionError:
        raise
    except SyntaxError as error:
        raise ExpressionError(
            f"{where}: {shortened(text)} is not an expression: {error.msg}{_spelling(text)}"
        ) from None
    except (ValueError, OverflowError, RecursionError, MemoryError) as error:
        raise ExpressionError(f"{where}: {shortened(text)} is not an expression: {error}") from None


def _spelling(text: str) -> str:
    """What an operator of another language is called here, after a text that is no syntax."""
    equation = re.fullmatch(r"\s*\w+\s*=(?!=)\s*(.+)", text, re.DOTALL)
    if equation is not None:
        return f"; write what stands on the right alone, {shortened(equation[1].strip())}"
    for theirs, ours in _SYMBOLS:
        if re.search(rf"(?<![<>=!]){re.escape(theirs)}(?!=)", text):
            return f"; {theirs} is written {ours} here"
    return ""


def _nesting(text: str) -> int:
    depth = deepest = 0
    for character in text:
        depth += (character in "([{") - (character in ")]}")
        deepest = max(deepest, depth)
    return deepest


def _build(node: ast.AST, where: str, depth: int, functions: Functions) -> sp.Expr:
    """The expression of one syntax node; only the listed kinds of node exist here.

    A chain of sums and products is deep in the syntax tree without being nested, so it is walked in a loop.
    """
    if depth > MAX_DEPTH:
        raise ExpressionError(f"{where}: expression nested deeper than {MAX_DEPTH}")
    pending: list[tuple[type, ast.AST]] = []
    while isinstance(node, ast.BinOp) and type(node.op) in _BINARY:
        pending.append((type(node.op), node.right))
        node = node.left
    result = _leaf(node, where, depth, functions)
    for operator, right in reversed(pending):
        operand = _build(right, where, depth + 1, functions)
        if operator is ast.Div and operand.is_zero:
            raise ExpressionError(f"{where}: division by zero")
        try:
            result = _BINARY[operator](result, operand)
        except ExpressionError as error:
            raise ExpressionError(f"{where}: {error}") from None
    return result


def _leaf(node: ast.AST, where: str, depth: int, functions: Functions) -> sp.Expr:
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        if isinstance(node.value, int) and node.value.bit_length() > 4 * MAX_DIGITS:
            raise ExpressionError(f"{where}: a number of more than {MAX_DIGITS} digits")
        return number(node.value, where)
    if isinstance(node, ast.Name):
        name = str(normal(node.id))
        return CONSTANTS[name] if name in CONSTANTS else symbol(name, where)
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.UAdd | ast.USub):
        operand = _build(node.operand, where, depth + 1, functions)
        return -operand if isinstance(node.op, ast.USub) else operand
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
        return _call(node.func.id, node.args, where, depth, functions)
    kind = type(node.op) if isinstance(node, ast.BinOp | ast.UnaryOp) else type(node)
    way = _of_module(node, functions) or _SPELLED.get(kind, ALLOWED)
    raise ExpressionError(f"{where}: {shortened(ast.unparse(node))} is not allowed; {way}")


def _of_module(node: ast.AST, functions: Functions) -> str:
    """How a function or number of a module is called here, of `np.sqrt(x)`; nothing for what is none."""
    whole = node.func if isinstance(node, ast.Call) else node
    if not isinstance(whole, ast.Attribute) or not isinstance(whole.value, ast.Name):
        return ""
    if whole.attr in functions and isinstance(node, ast.Call):
        return f"functions stand without their module, as in {whole.attr}(x)"
    return f"a constant is called {whole.attr} here" if whole.attr in CONSTANTS else ""


def _call(
    name: str, arguments: list[ast.expr], where: str, depth: int, functions: Functions
) -> sp.Expr:
    name = str(normal(name))

    def build(node: ast.AST) -> sp.Expr:
        return _build(node, where, depth + 1, functions)

    if name == PIECEWISE:
        return read_pieces(arguments, build, where)
    if name not in functions:
        known = sorted([*functions, PIECEWISE])
        if name in _OTHERWISE:
            raise ExpressionError(
                f"{where}: {name!r} is not a function an expression may use; {_OTHERWISE[name]}"
            )
        raise ExpressionError(
            f"{where}: {name!r} is not a function an expression may use{nearest(name, known)}; "
            f"there are {', '.join(known)}, and the lookup tables that it is given as tables"
        )
    least, most, made = functions[name]
    if not least <= len(arguments) <= most:
        raise ExpressionError(f"{where}: {name} takes {least} argument(s), not {len(arguments)}")
    return made(*map(build, arguments))


def _power(base: Any, exponent: Any) -> sp.Expr:
    """A power, unless writing it out would take more than a sensible number of digits."""
    if exponent.is_Rational and abs(exponent) > MAX_EXPONENT:
        raise ExpressionError(f"an exponent of more than {MAX_EXPONENT}")
    factor = base.as_coeff_Mul()[0]
    if factor.is_Rational and factor not in (1, -1) and exponent.is_Rational:
        digits = max(len(str(abs(factor.p))), len(str(factor.q))) * abs(exponent)
        if digits > MAX_DIGITS:
            raise ExpressionError(f"a power of more than {MAX_DIGITS} digits")
        if base.is_zero and exponent.is_negative:
            raise ExpressionError("division by zero")
    return base**exponent
