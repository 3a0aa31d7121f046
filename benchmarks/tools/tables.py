"""Lines of the tables: what a tool said as cells, with its ratio to ours."""

from collections.abc import Mapping, Sequence
from typing import Any

WIDTHS = (18, 11, 8, 10, 8, 10, 8, 11, 8)
"""Of the name and of the cells after it."""


def line(cells: Sequence[str], said: str) -> str:
    """Cells to the right of a name, and what is said after them.

    >>> line(["ours", "1.2", ""], "right")
    'ours                      1.2          right'
    """
    name, *others = cells
    right = "".join(f"{cell:>{width}}" for cell, width in zip(others, WIDTHS[1:], strict=False))
    return f"{name:<{WIDTHS[0]}}{right}  {said}".rstrip()


def number(value: float | None) -> str:
    """A figure with three digits that tell.

    >>> number(0.0123456), number(123456.0), number(None)
    ('0.0123', '123,000', '-')
    """
    if value is None:
        return "-"
    return f"{float(f'{value:.3g}'):,.0f}" if value >= 1000 else f"{value:.3g}"


def ratio(value: float | None, base: float | None) -> str:
    """How many times as large as ours.

    >>> ratio(3.0, 1.5), ratio(None, 1.0)
    ('2', '')
    """
    return "" if value is None or not base else number(value / base)


def trouble(found: Mapping[str, Any]) -> str:
    """Why there is no answer, or nothing.

    >>> trouble({"cannot": "circuits only"}), trouble({"over": 60.0}), trouble({"answer": 1})
    ('cannot: circuits only', 'not ready after 60 s', '')
    """
    if "answer" in found:
        return ""
    if "cannot" in found:
        return f"cannot: {found['cannot']}"
    if "error" in found:
        return f"fails: {found['error'][:90]}"
    return f"not ready after {found['over']:g} s"
