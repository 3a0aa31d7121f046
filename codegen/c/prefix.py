"""External symbols of a model under names of its own, so that several models link into one program."""

import re
from collections.abc import Iterable

from bondgraph.errors import ParameterError
from codegen.program.identifiers import RESERVED

_FUNCTION = re.compile(r"^(?!static |typedef |extern )[a-z][^;{}()=]*?\b(bg_\w+)\([^;{}]*\);", re.M)
_DATA = re.compile(r"^extern ([^;()]*);", re.M)
_NAME = re.compile(r"\b(bg_\w+)(?=\[|,|$)")


def external_symbols(headers: Iterable[str]) -> tuple[str, ...]:
    """What the headers of the runtime declare as functions and data, in alphabetical order.

    >>> external_symbols(["extern const bg_a bg_b[], bg_c;", "int bg_f(bg_a *a);"])
    ('bg_b', 'bg_c', 'bg_f')
    """
    found: set[str] = set()
    for text in headers:
        found |= set(_FUNCTION.findall(text))
        for declared in _DATA.findall(text):
            found |= set(_NAME.findall(declared))
    return tuple(sorted(found))


def renamed(prefix: str, symbols: Iterable[str]) -> list[str]:
    """Macros that put the prefix before every symbol.

    Raises `ParameterError` unless the prefix is empty or begins an identifier of C.
    """
    if not prefix:
        return []
    plain = isinstance(prefix, str) and prefix.isascii() and prefix.isidentifier()
    if not plain or prefix.startswith("_") or prefix in RESERVED["c"]:
        raise ParameterError(
            f"prefix {prefix!r}: symbols of C begin with a letter from a to z, go on with letters, "
            "digits and underscores, and are no word of the language; take one such as 'front_'"
        )
    return [f"#define {name} {prefix}{name}" for name in symbols]
