"""A bond graph as text for a terminal: a line a bond, from top to bottom, with strokes and half arrows."""

from collections.abc import Mapping

from bondgraph.drawing.compose import LEGEND
from bondgraph.drawing.rich import plain
from bondgraph.drawing.subject import Item, Link, Subject

MARK = " *"
"""Behind a dependent storage."""


def listing(subject: Subject, rows: Mapping[int, tuple[float, float]], powers: bool) -> str:
    """The bonds in the order of their places, ``|`` at the end that receives the effort.

    ``rows``: every node's place in the picture, layer first.
    """
    links = sorted(subject.links, key=lambda link: _place(link, rows))
    cells = [_cells(subject, link, powers) for link in links]
    widths = [max(len(row[at]) for row in cells) for at in range(len(cells[0]))] if cells else []
    lines = [
        "  ".join(cell.ljust(wide) for cell, wide in zip(row, widths, strict=True)).rstrip()
        for row in cells
    ]
    if any(item.dependent for item in subject.items):
        lines.append(f"{MARK.strip()} {LEGEND}")
    if subject.remark:
        lines.append(subject.remark)
    return "\n".join(lines or [_name(item) for item in subject.items])


def _place(link: Link, rows: Mapping[int, tuple[float, float]]) -> tuple[object, ...]:
    upper, lower = sorted((rows[link.tail], rows[link.head]))
    return upper, lower


def _cells(subject: Subject, link: Link, powers: bool) -> list[str]:
    at_tail = "|" if link.receiver == link.tail else " "
    at_head = "|" if link.receiver == link.head else " "
    row = [
        _name(subject.items[link.tail]),
        f"{at_tail}──⇀{at_head}",
        _name(subject.items[link.head]),
    ]
    return row + ([plain(link.effort), plain(link.flow)] if powers else [])


def _name(item: Item) -> str:
    beside = plain(item.beside)
    if item.junction:
        return f"{item.symbol} {beside}"
    return f"{item.symbol}: {beside}{MARK if item.dependent else ''}"
