"""Lines of a recording as Python text over plain floats."""

import re
from collections.abc import Sequence
from functools import lru_cache

import sympy as sp
from sympy.core.relational import Relational
from sympy.logic.boolalg import Boolean

from bondgraph.algebra.called import Called
from bondgraph.algebra.lookups import Handle
from bondgraph.inverses.inverse import Turning
from codegen.program.printing import printed
from codegen.program.records import Block
from codegen.straight.sums import Line, Sum, Value
from codegen.tuning import TUNING

PLAIN = (
    sp.Add, sp.Mul, sp.Pow, sp.Symbol, sp.Number, sp.NumberSymbol, Relational, Boolean, sp.Piecewise,
    sp.functions.elementary.piecewise.ExprCondPair, sp.Abs, sp.sign, sp.Min, sp.Max, sp.sin, sp.cos, sp.tan,
    sp.asin, sp.acos, sp.atan, sp.atan2, sp.sinh, sp.cosh, sp.tanh, sp.asinh, sp.acosh, sp.atanh, sp.exp,
    sp.log, sp.floor, sp.ceiling, sp.erf, Called, Handle, Turning,
)  # fmt: skip
"""What is written over floats."""

BRANCH = "Branch"
"""The function of that name is, too."""

_TOKEN = re.compile(r"_([ac])(\d+)_")


@lru_cache(maxsize=256)
def writable(code: Block) -> bool:
    """Whether all that a block is made of is written over floats."""
    return all(
        isinstance(part, PLAIN) or type(part).__name__ == BRANCH
        for value in code.values
        for part in sp.preorder_traversal(value)
    )


@lru_cache(maxsize=256)
def _texts(code: Block) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """A block's assignments and results, with tokens for the names that are put in."""
    tokens = {name.name: f"_c{at}_" for at, (name, _) in enumerate(code.assignments)}
    tokens |= {name.name: f"_a{at}_" for at, name in enumerate(code.arguments)}
    temporaries = (printed(value, "floats", tokens) for _, value in code.assignments)
    return tuple(temporaries), tuple(printed(value, "floats", tokens) for value in code.results)


def written(line: Line) -> list[str]:
    """A line as statements."""
    read = [text_of(value) for value in line.read]
    if isinstance(line.code, Block):
        return _block(line, line.code, read)
    if line.code == "!":
        return _checked(read)
    if line.code in ("*", "/"):
        return [f"{line.names[0]} = ({read[0]}){line.code}({read[1]})"]
    if line.code == "+":
        return [f"{line.names[0]} = {read[0]}"]
    return [f"{', '.join(line.names)}, = loops[{line.code}]({', '.join(read)})"]


def _block(line: Line, code: Block, read: Sequence[str]) -> list[str]:
    inside = [f"({text})" if text.startswith("-") else text for text in read]
    own = f"{line.names[0]}_" if line.names else ""

    def put(text: str) -> str:
        return _TOKEN.sub(lambda m: inside[int(m[2])] if m[1] == "a" else f"{own}{m[2]}", text)

    temporaries, results = _texts(code)
    texts = [f"{own}{at} = {put(text)}" for at, text in enumerate(temporaries)]
    return texts + [f"{name} = {put(text)}" for name, text in zip(line.names, results, strict=True)]


def _checked(read: Sequence[str]) -> list[str]:
    """Levels and curves must not be below zero, nor breakaway efforts below friction at rest."""
    level, cap, curve, rest = (f"({text})" for text in read)
    share = repr(1 - TUNING.breakaway)
    sound = f"{level} >= 0.0 and {curve} >= 0.0 and {cap} >= {level}*{rest}*{share}"
    return [f"if not ({sound}):", "    return None"]


def text_of(value: Value) -> str:
    """A sum, or a number."""
    if not isinstance(value, Sum):
        return repr(float(value))
    text = ""
    for name, factor in value.terms.items():
        size = name if abs(factor) == 1 else f"{abs(factor)!r}*{name}"
        text += (" - " if factor < 0 else " + ") + size
    if value.constant:
        text += f" {'-' if value.constant < 0 else '+'} {abs(value.constant)!r}"
    return text[3:] if text.startswith(" + ") else f"-{text[3:]}"
