"""Signals and laws as they are typed: a closed list of calls over numbers, nothing is evaluated."""

import ast
import inspect
import re
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

import bondgraph as bg
import codegen
from bondgraph.algebra.expressions import expression

SIGNALS: Mapping[str, type[codegen.Signal]] = MappingProxyType(
    {
        "constant": codegen.Constant, "step": codegen.Step, "ramp": codegen.Ramp,
        "sine": codegen.Sine, "lag": codegen.Lag, "pulse": codegen.Pulse,
        "square": codegen.Square, "sawtooth": codegen.Sawtooth, "pwm": codegen.PWM,
    }
)  # fmt: skip
"""What a signal may be made of, beside numbers and sums."""

DATA = re.compile(r"@(?P<path>.+?):(?P<time>[^:,]+),(?P<value>[^:,]+)(?::(?P<kind>[^:,]*))?")
"""Data in a file: its columns, and what is between their rows."""

DATA_FORM = "@FILE:TIME,VALUE[:linear|held|pchip]"

LONGEST = 1_000
DEEPEST = 20


def forms() -> str:
    """How each signal is written."""
    called = [f"{name}({', '.join(_arguments(name))})" for name in SIGNALS]
    return ", ".join([*called, DATA_FORM])


def signal(text: str) -> codegen.Signal:
    """The signal that a text describes: a number, one of `SIGNALS`, a sum of them, or columns of a file.

    Raises `SignalError` for anything else, `MissingExtraError` without the package that reads the file.

    >>> signal("lag(step(0.1, 350), 0.04)")
    Lag(signal=Step(time=0.1, value=350.0, initial=0.0), time_constant=0.04)
    >>> signal("-2.5")
    Constant(value=-2.5)
    >>> signal("pwm(10e3, 0.3, high=24)").high
    24.0
    """
    return _data(text) if text.startswith("@") else _signal(_parsed(text), 0)


def _data(text: str) -> codegen.Signal:
    """Two columns of a file, which stand alone."""
    found = DATA.fullmatch(text)
    if found is None:
        raise bg.SignalError(f"{text[:60]!r} is not {DATA_FORM}, as in @cycle.csv:t,v:held")
    path, time, value, kind = (None if one is None else one.strip() for one in found.groups())
    return codegen.Sampled.read(path, str(time), str(value), "linear" if kind is None else kind)


def law(text: str, tables: Sequence[bg.LookupTable] = ()) -> object:
    """A law: an expression, or ``friction(level[, curve[, breakaway]])``; it may call ``tables``.

    >>> law("friction(tau_h, 1 + 0.2*exp(-slip/0.1))").breakaway
    6/5
    """
    if not text.lstrip().startswith("friction"):
        return expression(text, "law", tables)
    tree = _parsed(text)
    if not (isinstance(tree, ast.Call) and _called(tree) == "friction" and not tree.keywords):
        return expression(text, "law", tables)
    if not 1 <= len(tree.args) <= 3:
        raise bg.ExpressionError("dry friction is friction(level), or (level, curve, breakaway)")
    level, curve, breakaway = (*(ast.unparse(argument) for argument in tree.args), None, None)[:3]
    return bg.DryFriction(level, "1" if curve is None else curve, breakaway, tables)


def table_file(text: str) -> tuple[str, dict[str, str]]:
    """The file of a table, and how it is looked into.

    >>> table_file("map.csv,method=pchip,outside=refuse")
    ('map.csv', {'method': 'pchip', 'outside': 'refuse'})
    """
    path, *choices = text.split(",")
    found = {}
    for choice in choices:
        key, equals, value = choice.partition("=")
        if key.strip() not in ("method", "outside") or not equals:
            raise bg.TableError(f"{choice.strip()!r} is neither method=... nor outside=... there")
        found[key.strip()] = value.strip()
    return path.strip(), found


def _parsed(text: str) -> ast.expr:
    if len(text) > LONGEST:
        raise bg.SignalError(f"text of {len(text)} characters, at most {LONGEST} are read")
    try:
        return ast.parse(text.strip(), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise bg.SignalError(_refusal(text)) from None


def _refusal(text: str) -> str:
    return f"{text[:60]!r} is neither a number nor a signal; there are {forms()}, and sums"


def _arguments(name: str) -> list[str]:
    """The arguments of a signal, those that may be left out in brackets."""
    parameters = inspect.signature(SIGNALS[name]).parameters.values()
    return [one.name if one.default is one.empty else f"[{one.name}]" for one in parameters]


def _called(node: ast.Call) -> str:
    return node.func.id if isinstance(node.func, ast.Name) else ""


def _signal(node: ast.expr, depth: int) -> codegen.Signal:
    if depth > DEEPEST:
        raise bg.SignalError(f"signals nested deeper than {DEEPEST}")
    if isinstance(node, ast.Call) and _called(node) in SIGNALS:
        return _call(node, depth)
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add) and _has_call(node):
        return _signal(node.left, depth + 1) + _signal(node.right, depth + 1)
    return codegen.Constant(_number(node))


def _has_call(node: ast.AST) -> bool:
    return any(isinstance(part, ast.Call) and _called(part) in SIGNALS for part in ast.walk(node))


def _call(node: ast.Call, depth: int) -> codegen.Signal:
    name = _called(node)
    names = list(inspect.signature(SIGNALS[name]).parameters)

    def value(argument: ast.expr, at: str) -> Any:
        is_signal = at == "signal" or (at == "duty" and _has_call(argument))
        return _signal(argument, depth + 1) if is_signal else _number(argument)

    given = dict(zip(names, node.args, strict=False))
    more = {str(keyword.arg): keyword.value for keyword in node.keywords}
    form = f"{name}({', '.join(_arguments(name))})"
    if len(node.args) > len(names) or set(more) - set(names) or set(more) & set(given):
        raise bg.SignalError(f"{ast.unparse(node)[:60]!r} is not {form}")
    try:
        return SIGNALS[name](**{at: value(one, at) for at, one in {**given, **more}.items()})
    except TypeError:
        raise bg.SignalError(f"{ast.unparse(node)[:60]!r} is not {form}") from None


def _number(node: ast.expr) -> float:
    text = ast.unparse(node)
    try:
        return float(expression(text, "signal"))
    except (bg.ExpressionError, TypeError, OverflowError):
        raise bg.SignalError(_refusal(text)) from None
