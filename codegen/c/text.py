"""Pieces of C as text: comments, strings, tables, statements of bearable length."""

import re
import textwrap
from collections.abc import Iterable, Sequence

WIDTH = 100
"""Lines are broken beyond this many characters."""


_STRING = re.compile(r'"(?:[^"\\]|\\.)*"')
"""A string of C."""

_BLANK = "\0"
"""In place of a blank in one while lines are broken; no string of C has it as such."""


def comment(text: str) -> list[str]:
    """A comment that no name can end or continue.

    >>> comment("a */ b")
    ['/* a * / b */']
    """
    plain = "".join(one if one.isprintable() else " " for one in text)
    plain = plain.replace("*/", "* /").replace("/*", "/ *").replace("\\", "/").replace("??", "? ?")
    return textwrap.wrap(
        f"/* {plain} */",
        WIDTH,
        subsequent_indent=" * ",
        break_long_words=False,
        break_on_hyphens=False,
    )


def quoted(text: str) -> str:
    """A text as a C string of its UTF-8 bytes.

    >>> quoted('a"b'), quoted("τ??")
    ('"a\\\\"b"', '"\\\\317\\\\204\\\\?\\\\?"')
    """
    parts = []
    for byte in text.encode():
        one = chr(byte)
        if one in '"\\?':
            parts.append(f"\\{one}")
        else:
            parts.append(one if 32 <= byte < 127 else f"\\{byte:03o}")
    return f'"{"".join(parts)}"'


def statement(text: str, indent: int = 4) -> list[str]:
    """A statement, broken at its blanks where it is long, but not at those of strings."""
    pad = " " * indent
    lines = textwrap.wrap(
        _STRING.sub(lambda found: found[0].replace(" ", _BLANK), text),
        WIDTH,
        initial_indent=pad,
        subsequent_indent=pad + "    ",
        break_long_words=False,
        break_on_hyphens=False,
    )
    return [line.replace(_BLANK, " ") for line in lines]


def array(head: str, entries: Iterable[str], empty: str = "0") -> list[str]:
    """A constant array; C knows none without an entry, so an empty one has one that nothing uses.

    >>> array("static const int a[]", [])
    ['static const int a[] = {0};']
    """
    listed = list(entries) or [empty]
    line = f"{head} = {{{', '.join(listed)}}};"
    if len(line) <= WIDTH:
        return [line]
    return [f"{head} = {{", *statement(", ".join(listed)), "};"]


def strings(name: str, texts: Sequence[str]) -> list[str]:
    """A constant array of strings."""
    return array(f"const char *const {name}[]", map(quoted, texts), '""')


def integers(name: str, numbers: Iterable[int], local: bool = False) -> list[str]:
    """A constant array of integers."""
    return array(f"{'static ' if local else ''}const int {name}[]", map(str, numbers))


def doubles(name: str, numbers: Iterable[float], local: bool = False) -> list[str]:
    """A constant array of doubles, in digits that give them back."""
    head = f"{'static ' if local else ''}const double {name}[]"
    return array(head, (repr(float(one)) for one in numbers), "0.0")
