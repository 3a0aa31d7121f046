"""`panels`: a run's signals in panels, one above the other, as papers print them."""

from collections.abc import Mapping, Sequence
from typing import Any

from bondgraph.errors import SignalError
from codegen.pictures.stacked import stacked
from codegen.record.result import Result, marks_of, panel_of


def panels(
    result: Result,
    groups: Sequence[str | Sequence[str]] | None = None,
    labels: Sequence[str | None] | None = None,
    title: str = "",
    units: Mapping[str, str] | None = None,
) -> Any:
    """A `matplotlib.figure.Figure` with a panel for each group of signals, over one time axis.

    Each state has one of its own, if none are named.
    Events are marked through all panels, and the spans shaded in which a friction port sticks. ``labels``:
    of the panels, instead of names and units. ``units``: of signals of which elements tell none.

    Raises `SignalError` for unknown names, `MissingExtraError` without matplotlib.
    """
    groups = result.states if groups is None else groups
    if isinstance(groups, str) or not groups:
        raise SignalError(
            f"groups must be a list of signals or of lists of signals, not {groups!r}"
        )
    told = [None] * len(groups) if labels is None else list(labels)
    if len(told) != len(groups):
        raise SignalError(f"{len(told)} labels for {len(groups)} panels; give each panel one")
    shown = [
        panel_of(result, [group] if isinstance(group, str) else list(group), label, units)
        for group, label in zip(groups, told, strict=True)
    ]
    return stacked(shown, marks_of(result), title)
