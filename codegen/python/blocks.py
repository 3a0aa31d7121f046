"""The blocks of a program as Python functions of parameters and an instant."""

import ast
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import sympy as sp

from bondgraph.algebra.lookups import Look
from bondgraph.errors import ExpressionError
from codegen.program.identifiers import identifiers
from codegen.program.layout import readable
from codegen.program.printing import printed
from codegen.program.records import Block, Group, Pattern, Program
from codegen.python.text import WIDTH, assignment, plain, quoted

TAKEN = (
    "parameters", "now", "tables", "matrix", "log_of", "looked_up", "looked_back", "place_where",
    "l", "O", "I",
)  # fmt: skip
"""Names that the functions use themselves, and letters that look like digits."""

_HUGGED = re.compile(r"(\b[\w.]+) \*\* (-?[\w.]+\b(?![(\[]))")
"""Powers of plain names and numbers, which are written without spaces."""


_TABLE = re.compile(r"\btables\['(\w+)'\]")
"""Tables by name, in the quotes that all else has."""


@dataclass(frozen=True)
class Names:
    """For every name of a program its identifier and the expression that gets its value."""

    identifiers: Mapping[str, str]
    places: Mapping[str, str]


def names_of(program: Program) -> Names:
    """Identifiers, and where each value stands; a parameter before an input that it holds."""

    def where(_: int, part: str, at: int, name: str) -> str:
        plain = {"t": "now.t", "p": f"parameters[{quoted(name)}]"}
        return plain.get(part, f"now.{part}[{at}]")

    found = {name.name: place for name, place in readable(program, where).items()}
    temporaries = [name.name for code in program.blocks for name, _ in code.assignments]
    return Names(identifiers([*temporaries, *found], "python", TAKEN), found)


def law_names(program: Program) -> list[str]:
    """A function's name for each group of laws: that of its port, numbered if it has several."""
    wanted = [
        f"law_{group.ports[0]}" if len(group.ports) == 1 else f"laws_solved_together_{at}"
        for at, group in enumerate(program.groups, 1)
    ]
    unique = [name if wanted.count(name) == 1 else f"{name}_{at}" for at, name in enumerate(wanted)]
    taken = ("laws_in_turn",)
    return [identifiers(unique, "python", taken)[name] for name in unique]


def text_of(expr: sp.Expr, names: Names) -> str:
    """An expression as Python with spaces around operators; `ExpressionError` if ``math`` can't do it."""
    text = printed(expr, "python", names.identifiers)
    if "Not supported" in text:
        raise ExpressionError(f"{expr} uses a function that Python's math module does not have")
    try:
        plain = _HUGGED.sub(r"\1**\2", ast.unparse(ast.parse(text, mode="eval")))
        return _TABLE.sub(r'tables["\1"]', plain)
    except RecursionError:
        return text


def function(name: str, doc: str, code: Block, results: Sequence[str], names: Names) -> list[str]:
    """A block as a function: names in, temporaries, and the lines that return the results."""
    given = "parameters, now, tables=TABLES" if looks(code) else "parameters, now"
    lines = ["", "", f"def {name}({given}):", f'    """{doc}"""']
    lines += unpacked([symbol.name for symbol in code.arguments], names)
    for temporary, value in code.assignments:
        lines += assignment(names.identifiers[temporary.name], text_of(value, names))
    return [*lines, *results]


def looks(code: Block) -> bool:
    """Whether a block looks into a table."""
    return any(value.has(Look) for value in code.values)


def bound(name: str, code: Block) -> str:
    """A block's function as one of parameters and an instant."""
    return f"looking({name}, tables)" if looks(code) else name


def unpacked(used: Sequence[str], names: Names) -> list[str]:
    """A line for every name that a function uses."""
    return [f"    {names.identifiers[name]} = {names.places[name]}" for name in used]


def values_function(
    name: str, doc: str, code: Block, comments: Sequence[str], names: Names
) -> list[str]:
    """A block as a function that returns its results as a list, each with a comment."""
    lines = ["    return ["]
    for comment, result in zip(comments, code.results, strict=True):
        lines.append(f"        # {comment}")
        lines += assignment("", text_of(result, names), indent=8, end=",", sign="")
    lines = [*lines, "    ]"] if code.results else ["    return []"]
    return function(name, doc, code, lines, names)


def group_function(name: str, group: Group, program: Program, names: Names) -> list[str]:
    """The laws of a group as a function."""
    ports = ", ".join(plain(str(port)) for port in group.ports)
    doc = f"What {ports} gives." if group.inputs else "There are none."
    if len(doc) > WIDTH - 20:
        doc = f"What {len(group.ports)} ports give."
    comments = [
        f"{plain(program.inputs[j].name)} of {plain(str(port))}"
        for j, port in zip(group.inputs, group.ports, strict=True)
    ]
    return values_function(name, doc, group.values, comments, names)


def coefficients_function(program: Program, names: Names) -> list[str]:
    """The coefficients as a function that returns the matrices by their letters."""
    heads = {"A": "A x' = J x + B u + E u'", "F": "y = F x + D u + H x' + K u'"}
    lines, start = ["    return {"], 0
    for letter, pattern in program.layout.items():
        if letter in heads:
            lines.append(f"        # {heads[letter]}")
        end = start + len(pattern.rows)
        lines += _matrix(letter, pattern, program.coefficients.results[start:end], names)
        start = end
    doc = "The matrices of the equations over X and U; the last four have a row for each of Y."
    return function("coefficients", doc, program.coefficients, [*lines, "    }"], names)


def _matrix(letter: str, pattern: Pattern, entries: Sequence[sp.Expr], names: Names) -> list[str]:
    shape = f"({pattern.shape[0]}, {pattern.shape[1]})"
    if not entries:
        return [f'        "{letter}": matrix({shape}, {{}}),']
    lines = [f'        "{letter}": matrix(', f"            {shape},", "            {"]
    for i, j, entry in zip(pattern.rows, pattern.columns, entries, strict=True):
        lines += assignment(f"({i}, {j})", text_of(entry, names), 16, ",", ": ")
    return [*lines, "            },", "        ),"]
