"""A run in a notebook: what ran it, where its states begin, end and turn, and what happened."""

from collections.abc import Mapping, Sequence

from bondgraph.show.display import listed
from bondgraph.show.html import html_lines, html_table
from codegen.numbers.arrays import Array
from codegen.record.summary import MOST, event_lines, head_line, state_rows
from codegen.runs.track import Event


def run_html(
    time: Array, states: Mapping[str, Array], columns: Sequence[str], units: Mapping[str, str],
    events: Sequence[Event], backend: str,
) -> str:  # fmt: skip
    """Times, samples and backend in a line; the states as a table; the columns' names; the events."""
    parts = [html_lines([f"{head_line(time, events)}, run by {backend}"])]
    if states:
        head, *rows = state_rows(states, units)
        parts.append(html_table(head, rows))
    more = [f"Columns: {listed(columns)}"] if columns else []
    if len(states) > MOST:
        more.insert(0, f"and {len(states) - MOST} more states")
    parts += [html_lines(lines) for lines in (more, event_lines(events)) if lines]
    return "".join(parts)
