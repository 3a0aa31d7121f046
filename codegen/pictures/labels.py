"""Names as a reader knows them: Greek letters, indices, units."""

import re
from collections.abc import Iterable

LETTERS = """
alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi pi rho sigma tau upsilon phi chi
psi omega Gamma Delta Theta Lambda Xi Pi Sigma Upsilon Phi Psi Omega
"""
GREEK = frozenset(LETTERS.split())
"""Those that mathematical text knows by name."""

NAME = re.compile(r"([A-Za-z]+)(\d*)((?:_[A-Za-z0-9]+)*)")


def pretty(name: str) -> str:
    r"""A name in matplotlib's mathematical text, or as it stands where it is not letters and digits.

    >>> pretty("omega_t1"), pretty("F"), pretty("speed")
    ('$\\omega_{\\mathrm{t1}}$', '$F$', '$\\mathrm{speed}$')
    """
    found = NAME.fullmatch(name)
    if found is None:
        return plain(name)
    head, digits, rest = found.groups()
    indices = [part for part in (digits, *rest.split("_")) if part]
    below = "_{" + ",".join(map(_letters, indices)) + "}" if indices else ""
    return f"${_letters(head)}{below}$"


def plain(text: str) -> str:
    """A text that stays as it is, dollars included."""
    return text.replace("$", r"\$")


def _letters(word: str) -> str:
    if word in GREEK:
        return rf"\{word}"
    return word if len(word) == 1 else rf"\mathrm{{{word}}}"


def measured(name: str, unit: str) -> str:
    """A pretty name with its unit, if one is told."""
    return f"{pretty(name)} [{unit}]" if unit else pretty(name)


def common(names: Iterable[str], units: Iterable[str]) -> str:
    """The label of an axis with several signals: their names if they are few, their unit if it is one."""
    shown, told = list(names), set(units)
    unit = told.pop() if len(told) == 1 else ""
    text = ", ".join(map(pretty, shown)) if len(shown) <= 3 else ""
    return f"{text} [{unit}]".strip() if unit else text
