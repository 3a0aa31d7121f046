"""Names and expressions as runs of text, with Greek letters, subscripts and exponents."""

import re
import unicodedata
from collections.abc import Hashable, Iterable
from dataclasses import dataclass
from types import MappingProxyType

import sympy as sp
from sympy.core.alphabets import greeks
from sympy.printing.conventions import split_super_sub

from bondgraph.show.plain import one_line


@dataclass(frozen=True)
class Run:
    """A piece of text on one level: 0 the line, -1 a subscript, 1 an exponent."""

    text: str
    level: int = 0


Rich = tuple[Run, ...]
"""A line of text."""

MOST = 24
"""Longer texts are cut, with an ellipsis."""

SHORT = 2
"""Longer subscripts stay ordinary letters in a terminal, where they are easier to read."""

_TOKEN = re.compile(r"\d+\.?\d*(?:e[+-]?\d+)?|[^\W\d]\w*|\*\*\d+|\*\*|.", re.DOTALL)


def _letters() -> dict[str, str]:
    letters = {}
    for name in greeks:
        called = name.replace("lambda", "lamda")  # as Unicode spells it
        letters[name] = unicodedata.lookup(f"GREEK SMALL LETTER {called}")
        letters[name.capitalize()] = unicodedata.lookup(f"GREEK CAPITAL LETTER {called}")
    return letters


GREEK = MappingProxyType(_letters())
"""The letters that go by their names."""

_LOW = MappingProxyType(
    dict(zip("0123456789aehijklmnoprstuvx", "₀₁₂₃₄₅₆₇₈₉ₐₑₕᵢⱼₖₗₘₙₒₚᵣₛₜᵤᵥₓ", strict=True))
)
_HIGH = MappingProxyType(dict(zip("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹", strict=True)))


def named(name: Hashable) -> Rich:
    """A name with its subscript where it starts with a Greek letter or has a letter or two before it.

    >>> named("omega_t1"), named("halfshaft_1")
    ((Run(text='ω', level=0), Run(text='t1', level=-1)), (Run(text='halfshaft_1', level=0),))
    """
    text = str(name)
    if not text.isidentifier():
        return (Run(_cut(text)),)
    base, above, below = split_super_sub(text)
    if above or not base or (base not in GREEK and len(base) > 2):
        return (Run(_cut(text)),)
    letter = Run(GREEK.get(base, base))
    return (letter, Run(_cut("_".join(below)), -1)) if below else (letter,)


def formula(value: sp.Expr) -> Rich:
    """An expression on one line.

    >>> plain(formula(sp.sympify("r*omega_1**2/2")))
    'ω₁²·r/2'
    """
    runs: list[Run] = []
    for token in _TOKEN.findall(one_line(value)):
        if token.isidentifier():
            runs.extend(named(token))
        elif token.startswith("**") and token != "**":
            runs.append(Run(token[2:], 1))
        else:
            runs.append(Run({"*": "·", "**": "^", "-": "−"}.get(token, token)))
    return joined(runs)


def listed(names: Iterable[object]) -> Rich:
    """Names with commas between them.

    >>> plain(listed(["omega", "v_1"]))
    'ω, v₁'
    """
    runs: list[Run] = []
    for name in names:
        runs += [Run(", "), *named(str(name))] if runs else named(str(name))
    return joined(runs)


def joined(runs: list[Run]) -> Rich:
    """The runs with neighbours of one level made one."""
    found: list[Run] = []
    for run in runs:
        if found and found[-1].level == run.level:
            found[-1] = Run(found[-1].text + run.text, run.level)
        else:
            found.append(run)
    return tuple(found)


def plain(rich: Rich) -> str:
    """The text for a terminal: subscripts as characters where there are such, else after ``_``."""
    return "".join(_plain(run) for run in rich)


def length(rich: Rich) -> int:
    """How many characters there are."""
    return sum(len(run.text) for run in rich)


def _plain(run: Run) -> str:
    if run.level == 0:
        return run.text
    known, mark = (_LOW, "_") if run.level < 0 else (_HIGH, "^")
    if len(run.text) <= SHORT and all(letter in known for letter in run.text):
        return "".join(known[letter] for letter in run.text)
    return mark + run.text


def _cut(text: str) -> str:
    """One printable line that is not too long."""
    line = "".join(letter if letter.isprintable() else "�" for letter in text)
    return line if len(line) <= MOST else line[: MOST - 1] + "…"
