"""Names of a model as identifiers of a language that code is printed in."""

import builtins
import keyword
import math
import sys
import unicodedata
from collections.abc import Iterable, Mapping
from types import MappingProxyType

_C_WORDS = """
    auto break case char const continue default do double else enum extern float for goto if inline int
    long register restrict return short signed sizeof static struct switch typedef union unsigned void
    volatile while bool true false complex imaginary I asm fortran main NULL errno stdin stdout stderr
    acos asin atan atan2 ceil cos cosh exp fabs floor fmod frexp ldexp log log10 modf pow sin sinh sqrt tan
    tanh acosh asinh atanh cbrt copysign erf erfc exp2 expm1 fdim fma fmax fmin hypot ilogb lgamma llrint
    llround log1p log2 logb lrint lround nan nearbyint nextafter nexttoward remainder remquo rint round
    scalbln scalbn tgamma trunc signbit isnan isinf isfinite isnormal fpclassify j0 j1 jn y0 y1 yn gamma
    signgam HUGE_VAL INFINITY NAN abs labs div malloc free calloc realloc exit abort memcpy memset memmove
    strcmp strlen printf size_t ptrdiff_t offsetof assert linux unix
"""

C_WORDS = frozenset(_C_WORDS.split())
"""Keywords, and names of the standard headers, of C99 and of what compilers add."""

PYTHON_WORDS = frozenset(
    {*keyword.kwlist, *keyword.softkwlist, *dir(builtins), *dir(math), "np", "math"}
)
"""Keywords, builtins, and the names that generated Python uses."""

_MATLAB_WORDS = """
    break case catch classdef continue else elseif end for function global if otherwise parfor persistent
    return spmd switch try while
"""

MATLAB_WORDS = frozenset(_MATLAB_WORDS.split())
"""Keywords of MATLAB, which no variable is called by."""

RESERVED: Mapping[str, frozenset[str]] = MappingProxyType(
    {"c": C_WORDS, "python": PYTHON_WORDS, "matlab": MATLAB_WORDS}
)


_MODULES = frozenset(
    one.lower() for one in (*PYTHON_WORDS, *sys.stdlib_module_names, "numpy", "simulate")
)
"""What no exported module may be called, whatever the case."""


def identifiers(
    names: Iterable[str], language: str, taken: Iterable[str] = ()
) -> Mapping[str, str]:
    """An ASCII identifier of the language for every name, all different; the name itself where it can be.

    ``taken``: names that the generated code uses itself. In C, and where names differ by case alone,
    nothing is changed: identifiers are case-sensitive. Deterministic, whatever the order of a set.

    >>> dict(identifiers(["omega_1", "double", "double_", "τ"], "c"))
    {'omega_1': 'omega_1', 'double': 'double__', 'double_': 'double_', 'τ': 'tau'}
    """
    wanted = list(dict.fromkeys(names))
    used = {*taken, *RESERVED[language]}
    result: dict[str, str] = {}
    for name in wanted:
        if _plain(name) and name not in used:
            result[name] = name
            used.add(name)
    for name in wanted:
        if name not in result:
            text = _ascii(name)
            while text in used:
                text += "_"
            result[name] = text
            used.add(text)
    return MappingProxyType({name: result[name] for name in wanted})


def module_name(name: str) -> str:
    """The name of a Python module and its file: the name itself unless something else is called so.

    A module beside a script hides every other of its name, also the ones that numpy imports, and where
    files differ by more than case.

    >>> module_name("oscillator"), module_name("numpy"), module_name("Class"), module_name("１st gear")
    ('oscillator', 'numpy_', 'Class_', 'x1st_gear')
    """
    plain = name.isascii() and name.isidentifier()
    text = name if plain else _ascii(name)
    while text.lower() in _MODULES:
        text += "_"
    return text


def _plain(name: str) -> bool:
    """Whether the name is an identifier everywhere; a leading underscore belongs to the language."""
    return name.isascii() and name.isidentifier() and not name.startswith("_")


def _ascii(name: str) -> str:
    """Letters as they are, Greek ones by their names, anything else by its code."""
    parts = [_letter(one) for one in unicodedata.normalize("NFKD", name)]
    text = "".join(parts) or "x"
    return text if text[0].isalpha() else f"x{text}"


def _letter(one: str) -> str:
    if one.isascii():
        return one if one.isalnum() or one == "_" else "_"
    words = unicodedata.name(one, "").split()
    if words[:1] == ["GREEK"] and len(words) >= 4 and words[2] == "LETTER":
        return words[3].lower() if words[1] == "SMALL" else words[3].capitalize()
    if words[:1] == ["COMBINING"]:
        return ""
    return f"u{ord(one):x}"
