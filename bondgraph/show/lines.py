"""Sentences and sums broken into lines."""

import re
from collections.abc import Sequence


def words(sentence: str) -> list[str]:
    """The words of a sentence; what is equal is one.

    >>> words("off, f_D = 0 while e_D <= 0")
    ['off,', 'f_D = 0', 'while', 'e_D <= 0']
    """
    return re.split(r"(?<!=) (?!<?=)", sentence)


def wrapped(pieces: Sequence[str], width: int, indent: str) -> list[str]:
    """Pieces joined by spaces into lines that end before one that would be too long."""
    lines: list[str] = []
    for piece in pieces:
        if lines and len(lines[-1]) + len(piece) < width:
            lines[-1] += f" {piece}"
        else:
            lines.append((indent if lines else "") + piece)
    return lines
