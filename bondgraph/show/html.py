"""Small tables for notebooks."""

from collections.abc import Iterable, Sequence
from html import escape


def html_table(head: Sequence[object], rows: Iterable[Sequence[object]]) -> str:
    """A table whose first column is names; all text is escaped.

    >>> html_table(["", "first"], [["a<b", 1]])
    '<table><tr><th></th><th>first</th></tr><tr><th>a&lt;b</th><td>1</td></tr></table>'
    """
    lines = ["".join(f"<th>{_text(one)}</th>" for one in head)] if head else []
    for name, *values in rows:
        lines.append(f"<th>{_text(name)}</th>" + "".join(f"<td>{_text(v)}</td>" for v in values))
    return "<table>" + "".join(f"<tr>{line}</tr>" for line in lines) + "</table>"


def html_lines(lines: Iterable[object]) -> str:
    """Lines of text, one paragraph.

    >>> html_lines(["1 run", "2 < 3"])
    '<p>1 run<br>2 &lt; 3</p>'
    """
    return "<p>" + "<br>".join(map(_text, lines)) + "</p>"


def _text(value: object) -> str:
    return escape(str(value), quote=False)
