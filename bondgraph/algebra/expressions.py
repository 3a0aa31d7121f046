"""Text, numbers and sympy expressions become exact sympy expressions; nothing is ever evaluated as Python."""

import ast
import keyword
import math
import unicodedata
from collections.abc import Callable
from fractions import Fraction
from numbers import Integral, Rational, Real
from typing import Any

import sympy as sp

from bondgraph.algebra.residues import residues
from bondgraph.errors import ExpressionError

TIME = sp.Symbol("t")
"""The time, in laws and known sources."""

MAX_LENGTH = 4_000
MAX_DEPTH = 100
MAX_EXPONENT = 1_000
MAX_DIGITS = 400
MAX_TERMS = 10_000

_NOT_REAL = (sp.nan, sp.zoo, sp.oo, -sp.oo, sp.I)

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
    "sqrt": (1, 1, sp.sqrt),
    "abs": (1, 1, sp.Abs),
    "Abs": (1, 1, sp.Abs),
    "sign": (1, 1, sp.sign),
    "min": (2, 16, sp.Min),
    "max": (2, 16, sp.Max),
    "Min": (2, 16, sp.Min),
    "Max": (2, 16, sp.Max),
}
"""Functions that text may use: least and most number of arguments, and what is built."""

_PARTS = (
    sp.Add, sp.Mul, sp.Pow, sp.Symbol, sp.Number, sp.NumberSymbol, sp.exp,
    *(build for *_, build in FUNCTIONS.values() if isinstance(build, type)),
    sp.Piecewise, sp.functions.elementary.piecewise.ExprCondPair,
    sp.core.relational.Relational, sp.logic.boolalg.BooleanFunction, sp.logic.boolalg.BooleanAtom,
)  # fmt: skip
"""What an expression may be made of; piecewise laws come as sympy expressions only."""

_BINARY: dict[type, Callable[[Any, Any], Any]] = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b,
    ast.Pow: lambda a, b: _power(a, b),
}


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
    return sp.Symbol(name)


def expression(value: object, where: str) -> sp.Expr:
    """The exact expression that a number, a text or a sympy expression stands for.

    Text may hold numbers, names, ``+ - * / **``, parentheses and the functions in `FUNCTIONS`;
    names become plain symbols. A float counts as the rational of its shortest decimal form.

    Raises `ExpressionError`, naming ``where``, for anything else: text that calls or imports,
    numbers that are not finite and real, names that cannot be symbols.

    >>> expression("h1/(h1 - 1)", "node 'gear'"), expression(0.1, "node 'gear'")
    (h1/(h1 - 1), 1/10)
    """
    if isinstance(value, str):
        result = _from_text(value, where)
    elif isinstance(value, sp.Expr):
        floats = value.atoms(sp.Float)
        result = (
            value.xreplace({part: _decimal(part, where) for part in floats}) if floats else value
        )
    elif isinstance(value, Real | sp.Number) and not isinstance(value, bool):
        result = number(value, where)
    else:
        raise ExpressionError(f"{where}: {value!r} is neither a number, a text nor an expression")
    try:
        _check_value(result, value, where)
        _check_parts(result, where)
    except (OverflowError, RecursionError) as error:
        raise ExpressionError(f"{where}: {_short(str(value))} is out of bounds: {error}") from None
    return result


def _check_value(expr: sp.Expr, value: object, where: str) -> None:
    if expr.is_real is False or (not isinstance(expr, sp.Symbol) and expr.has(*_NOT_REAL)):
        raise ExpressionError(f"{where}: {value!r} is not a finite real expression")


def expanded_terms(expr: sp.Expr) -> int:
    """An upper bound on the number of terms that multiplying an expression out would give."""
    if expr.is_Add:
        return sum(map(expanded_terms, expr.args))
    if expr.is_Mul:
        return math.prod(map(expanded_terms, expr.args))
    if expr.is_Pow and expr.exp.is_Integer:
        terms, power = expanded_terms(expr.base), abs(int(expr.exp))
        return math.comb(terms + power - 1, power) if terms > 1 else 1
    return 1


def _check_parts(expr: sp.Expr, where: str) -> None:
    """Refuse what no backend could print, no stage could decide, or no patience could expand."""
    if isinstance(expr, sp.Symbol) and expr.is_commutative:
        symbol(expr.name, where)
        return
    for part in sp.preorder_traversal(expr):
        if not isinstance(part, _PARTS) or part.is_commutative is False:
            raise ExpressionError(
                f"{where}: {_short(str(part))} is not allowed; an expression holds numbers, names, "
                f"+ - * / ** and the functions {', '.join(sorted(FUNCTIONS))}"
            )
        if isinstance(part, sp.Symbol):
            symbol(part.name, where)
        elif isinstance(part, sp.Expr) and not _may_be_real(part):
            raise ExpressionError(f"{where}: {_short(str(part))} is not a real number")
        if part.is_Pow and part.exp.is_Rational and abs(part.exp) > MAX_EXPONENT:
            raise ExpressionError(f"{where}: an exponent of more than {MAX_EXPONENT}")
        if part.is_Rational and max(abs(part.p), part.q).bit_length() > 4 * MAX_DIGITS:
            raise ExpressionError(f"{where}: a number of more than {MAX_DIGITS} digits")
    if expanded_terms(expr) > MAX_TERMS:
        raise ExpressionError(f"{where}: multiplied out it would have over {MAX_TERMS} terms")
    try:
        residues()(expr)
    except ZeroDivisionError:
        raise ExpressionError(f"{where}: a denominator of {_short(str(expr))} vanishes") from None


def _may_be_real(part: sp.Expr) -> bool:
    """False for a constant that is complex or has no value, such as a root of -1 inside a cosine."""
    if part.is_number is False or part.is_real:
        return True
    value = part.evalf() if part.is_real is None else sp.I
    if not value.is_number or value.has(*_NOT_REAL[:4]):
        return False
    real, imaginary = value.as_real_imag()
    return bool(abs(imaginary) <= 1e-9 * abs(real))


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
    return _decimal(value, where)


def _decimal(value: Any, where: str) -> sp.Rational:
    if not math.isfinite(float(value)):
        raise ExpressionError(f"{where}: {value!r} is not a finite number")
    # numpy writes a short float as the decimal it was meant to be; sympy would pad it.
    text = repr(float(value)) if isinstance(value, float | sp.Float) else str(value)
    exact = Fraction(text)
    return sp.Rational(exact.numerator, exact.denominator)


def _from_text(text: str, where: str) -> sp.Expr:
    if len(text) > MAX_LENGTH:
        raise ExpressionError(f"{where}: text of {len(text)} characters, at most {MAX_LENGTH}")
    if _nesting(text) > MAX_DEPTH:
        raise ExpressionError(f"{where}: parentheses nested deeper than {MAX_DEPTH}")
    try:
        tree = ast.parse(text.strip(), mode="eval").body
        return _build(tree, where, 0)
    except ExpressionError:
        raise
    except SyntaxError as error:
        raise ExpressionError(
            f"{where}: {_short(text)} is not an expression: {error.msg}"
        ) from None
    except (ValueError, OverflowError, RecursionError, MemoryError) as error:
        raise ExpressionError(f"{where}: {_short(text)} is not an expression: {error}") from None


def _nesting(text: str) -> int:
    depth = deepest = 0
    for character in text:
        depth += (character in "([{") - (character in ")]}")
        deepest = max(deepest, depth)
    return deepest


def _build(node: ast.AST, where: str, depth: int) -> sp.Expr:
    """The expression of one syntax node; only the listed kinds of node exist here.

    A chain of sums and products is deep in the syntax tree without being nested, so it is walked in a loop.
    """
    if depth > MAX_DEPTH:
        raise ExpressionError(f"{where}: expression nested deeper than {MAX_DEPTH}")
    pending: list[tuple[type, ast.AST]] = []
    while isinstance(node, ast.BinOp) and type(node.op) in _BINARY:
        pending.append((type(node.op), node.right))
        node = node.left
    result = _leaf(node, where, depth)
    for operator, right in reversed(pending):
        operand = _build(right, where, depth + 1)
        if operator is ast.Div and operand.is_zero:
            raise ExpressionError(f"{where}: division by zero")
        try:
            result = _BINARY[operator](result, operand)
        except ExpressionError as error:
            raise ExpressionError(f"{where}: {error}") from None
    return result


def _leaf(node: ast.AST, where: str, depth: int) -> sp.Expr:
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        if isinstance(node.value, int) and node.value.bit_length() > 4 * MAX_DIGITS:
            raise ExpressionError(f"{where}: a number of more than {MAX_DIGITS} digits")
        return number(node.value, where)
    if isinstance(node, ast.Name):
        return symbol(node.id, where)
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.UAdd | ast.USub):
        operand = _build(node.operand, where, depth + 1)
        return -operand if isinstance(node.op, ast.USub) else operand
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
        return _call(node.func.id, node.args, where, depth)
    raise ExpressionError(
        f"{where}: {_short(ast.unparse(node))} is not allowed; an expression holds numbers, names, "
        f"+ - * / ** and the functions {', '.join(sorted(FUNCTIONS))}"
    )


def _call(name: str, arguments: list[ast.expr], where: str, depth: int) -> sp.Expr:
    if name not in FUNCTIONS:
        raise ExpressionError(
            f"{where}: {name!r} is not a function an expression may use; "
            f"there are {', '.join(sorted(FUNCTIONS))}"
        )
    least, most, build = FUNCTIONS[name]
    if not least <= len(arguments) <= most:
        raise ExpressionError(f"{where}: {name} takes {least} argument(s), not {len(arguments)}")
    return build(*(_build(argument, where, depth + 1) for argument in arguments))


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


def _short(text: str) -> str:
    return repr(text if len(text) <= 60 else text[:57] + "...")
