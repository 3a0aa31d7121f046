"""A bond graph as text for a terminal: a line a bond, from top to bottom, with strokes and half arrows."""

from collections.abc import Sequence

from bondgraph.drawing.compose import LEGEND
from bondgraph.drawing.rich import plain
from bondgraph.drawing.subject import Item, Link, Signal, Subject

MARK = " *"
"""Behind a dependent storage."""


def listing(subject: Subject, order: Sequence[int], powers: bool, numbers: bool = False) -> str:
    """The bonds in the order of their places, ``|`` at the end that receives the effort, then the signals
    and what makes them.

    ``order``: the nodes as one reads the picture.
    """
    rows = {item: at for at, item in enumerate(order)}
    number = {id(link): str(at) for at, link in enumerate(subject.links, 1)}
    links = sorted(subject.links, key=lambda link: sorted((rows[link.tail], rows[link.head])))
    cells = [[number[id(link)]] * numbers + _cells(subject, link, powers) for link in links]
    cells += [[""] * numbers + _signal(subject, one) for one in subject.signals]
    cells += [[""] * numbers + _does(item) for item in subject.items if item.lines]
    lines = _aligned(cells)
    if any(item.dependent for item in subject.items):
        lines.append(f"{MARK.strip()} {LEGEND}")
    if subject.remark:
        lines.append(subject.remark)
    return "\n".join(lines or [_name(item) for item in subject.items])


def _aligned(cells: Sequence[Sequence[str]]) -> list[str]:
    """The rows as lines, their cells under each other."""
    count = max((len(row) for row in cells), default=0)
    rows = [[*row, *[""] * (count - len(row))] for row in cells]
    widths = [max(len(row[at]) for row in rows) for at in range(count)]
    return [
        "  ".join(cell.ljust(wide) for cell, wide in zip(row, widths, strict=True)).rstrip()
        for row in rows
    ]


def _cells(subject: Subject, link: Link, powers: bool) -> list[str]:
    at_tail = "|" if link.receiver == link.tail else " "
    at_head = "|" if link.receiver == link.head else " "
    names = [
        _name(subject.items[end]) + (f" [{plain(port)}]" if port else "")
        for end, port in zip((link.tail, link.head), link.ports, strict=True)
    ]
    row = [names[0], f"{at_tail}──{'→' if link.active else '⇀'}{at_head}", names[1]]
    return row + ([plain(link.effort), plain(link.flow)] if powers else [])


def _signal(subject: Subject, signal: Signal) -> list[str]:
    """What has a signal, what reads it, and its name."""
    first, last = (_name(subject.items[end]) for end in (signal.source, signal.reader))
    return [first, " ┄┄→ ", last, plain(signal.names)]


def _does(item: Item) -> list[str]:
    """A node of signals, and what it does."""
    return [_name(item), "  =  ", ", ".join(map(plain, item.lines))]


def _name(item: Item) -> str:
    beside = plain(item.beside)
    if item.junction:
        return f"{item.symbol} {beside}"
    return f"{item.symbol}: {beside}{MARK if item.dependent else ''}"
