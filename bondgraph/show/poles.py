"""Poles of a linear model in numbers, as text, LaTeX and a table."""

from collections.abc import Sequence
from typing import Protocol

from bondgraph.show.blocks import aligned
from bondgraph.show.display import Space, counted
from bondgraph.show.html import html_lines, html_table

MOST = 20
"""Poles and pairs; more are counted."""


class Swinging(Protocol):
    """A pole or a pair of poles."""

    @property
    def pole(self) -> complex:
        """That with Im >= 0 [1/s]."""

    @property
    def frequency(self) -> float:
        """``|pole| / 2 pi`` [Hz]."""

    @property
    def damping(self) -> float:
        """``-Re pole / |pole|``."""


class Sized(Space, Protocol):
    """A linear model in numbers, and its poles."""

    def modes(self) -> Sequence[Swinging]:
        """Poles and pairs, slowest first."""


def pole_text(pole: complex, sign: str = "±", unit: str = "i") -> str:
    """A pole, or a pair of poles.

    >>> pole_text(-2.5), pole_text(-1 + 3j)
    ('-2.5', '-1 ± 3i')
    """
    real = f"{pole.real:.5g}"
    return f"{real} {sign} {pole.imag:.5g}{unit}" if pole.imag else real


def poles_latex(modes: Sequence[Swinging]) -> str:
    """All of them on a line."""
    shown = [pole_text(mode.pole, r"\pm", r"\,i") for mode in modes[:MOST]]
    more = rf",\; \text{{and {len(modes) - MOST} more}}" if len(modes) > MOST else ""
    return r"\text{poles [1/s]: } " + r",\; ".join(shown) + more


def space_text(space: Sized) -> str:
    """Sizes, and every pole and pair with its frequency and damping."""
    head, rows = _table(space)
    return "\n".join([head, *aligned(rows)])


def space_html(space: Sized) -> str:
    """The same as a table."""
    head, rows = _table(space)
    return html_lines([head]) + html_table(rows[0], rows[1:])


def _table(space: Sized) -> tuple[str, list[tuple[str, ...]]]:
    modes = space.modes()
    sizes = [
        counted(len(names), what)
        for names, what in (
            (space.states, "state"),
            (space.inputs, "input"),
            (space.outputs, "output"),
        )
    ]
    head = ", ".join(sizes)
    if len(modes) > MOST:
        head += f"; the slowest {MOST} of {len(modes)} modes"
    rows: list[tuple[str, ...]] = [("pole [1/s]", "frequency [Hz]", "damping")]
    for mode in modes[:MOST]:
        rows.append((pole_text(mode.pole), f"{mode.frequency:.5g}", f"{mode.damping:.5g}"))
    return head, rows
