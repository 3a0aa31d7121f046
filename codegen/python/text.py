"""How generated Python is laid out: lines of bearable length, tables, and docstrings."""

import re
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise

WIDTH = 100
"""Lines are broken beyond this many characters, where they can be."""

RULE = "# " + "-" * (WIDTH - 12)

_BREAKS = re.compile(r"(?<= )(?=[-+*/] |if |else )|(?<=, )")
"""Places between the parts of an expression: before operators, after commas."""


def filled(parts: Sequence[str], indent: int) -> list[str]:
    """Parts side by side on as few lines as take them."""
    lines, space = [""], WIDTH - indent
    for part in parts:
        if lines[-1] and len(lines[-1]) + len(part.rstrip()) > space:
            lines.append("")
        lines[-1] += part
    return [" " * indent + line.rstrip() for line in lines]


def assignment(
    name: str, text: str, indent: int = 4, end: str = "", sign: str = " = "
) -> list[str]:
    """``name = text``; a long one in parentheses, a line for each of its terms, or of its factors.

    >>> assignment("a", "b + c")
    ['    a = b + c']
    """
    pad = " " * indent
    if len(line := f"{pad}{name}{sign}{text}{end}") <= WIDTH:
        return [line]
    lines = [f"{pad}{name}{sign}("]
    for part in _terms(text):
        fits = len(part) + indent + 4 <= WIDTH
        pieces = [part] if fits else [piece for piece in _BREAKS.split(part) if piece]
        lines += filled(pieces, indent + 4)
    return [*lines, f"{pad}){end}"]


def _terms(text: str) -> list[str]:
    """An expression cut before its sums' operators, or its products' if it is no sum."""
    places: dict[str, list[int]] = {"+-": [], "*/": []}
    depth = 0
    for at, letter in enumerate(text):
        depth += (letter in "([") - (letter in ")]")
        if depth == 0 and text[at - 1 : at] == " " and text[at + 1 : at + 2] == " ":
            for operators, found in places.items():
                if letter in operators:
                    found.append(at)
    cuts = [0, *(places["+-"] or places["*/"]), len(text)]
    return [text[a:b].rstrip() for a, b in pairwise(cuts)]


def listing(opening: str, entries: Iterable[str], closing: str, indent: int = 0) -> list[str]:
    """Entries between brackets: on one line if they fit, else filled.

    >>> listing("X = (", ["1", "2"], ")")
    ['X = (1, 2)']
    """
    entries, pad = list(entries), " " * indent
    line = f"{pad}{opening}{', '.join(entries)}{closing}"
    if len(line) <= WIDTH:
        return [line]
    body = filled([f"{entry}, " for entry in entries], indent + 4)
    return [pad + opening, *body, f"{pad}{closing}  # fmt: skip"]


def names_tuple(name: str, values: Sequence[object]) -> list[str]:
    """A constant that holds a tuple of values."""
    closing = ",)" if len(values) == 1 and len(quoted(values[0])) < WIDTH / 2 else ")"
    return listing(f"{name} = (", [quoted(value) for value in values], closing)


def table(name: str, entries: Mapping[str, object]) -> list[str]:
    """A constant that holds a dictionary, one entry a line."""
    lines = [f"    {quoted(key)}: {value!r}," for key, value in entries.items()]
    return [f"{name} = {{", *lines, "}"] if lines else [f"{name} = {{}}"]


def quoted(value: object) -> str:
    """A text in double quotes, anything else as Python writes it.

    >>> quoted("a"), quoted(1)
    ('"a"', '1')
    """
    if not isinstance(value, str):
        return repr(value)
    inside = value.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{inside}"' if value.isprintable() else repr(value)


def plain(text: str) -> str:
    """A text that may stand in a docstring or a comment, on one line."""
    shown = "".join(letter if letter.isprintable() else "?" for letter in " ".join(text.split()))
    return shown.replace("\\", "/").replace('"""', "'''")
