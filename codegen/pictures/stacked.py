"""Curves over time in panels, one above the other."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from codegen.numbers.arrays import Array
from codegen.pictures.canvas import name_curves, rule, stack
from codegen.pictures.marks import Marks, draw
from codegen.pictures.style import TEXT, curve


@dataclass(frozen=True)
class Line:
    """One curve; ``values`` at ``time`` [s]."""

    time: Array
    values: Array
    label: str


@dataclass(frozen=True)
class Panel:
    """One axis: its label, its curves, and a heading where something has to be said of it."""

    label: str
    lines: tuple[Line, ...]
    heading: str = ""


def stacked(panels: Sequence[Panel], marks: Marks, title: str = "", tall: float = 1.45) -> Any:
    """A figure of panels, each ``tall`` [in], that share the time axis."""
    figure, axes = stack(len(panels), tall)
    for axis, panel in zip(axes, panels, strict=True):
        fill(axis, panel)
    along(axes, panels, marks)
    figure.align_ylabels(axes)
    if title:
        figure.suptitle(title, fontsize=TEXT + 1)
    return figure


def fill(axis: Any, panel: Panel) -> None:
    """Draw a panel's curves, each with a colour and a line of its own, into an axis."""
    for number, line in enumerate(panel.lines):
        axis.plot(line.time, line.values, label=line.label, linewidth=1.2, **curve(number))
    axis.set_ylabel(panel.label, fontsize=TEXT)
    axis.margins(x=0)
    rule(axis)
    if panel.heading:
        axis.set_title(panel.heading, fontsize=TEXT, loc="left")
    if len(panel.lines) > 1 or panel.lines[0].label not in panel.label:
        name_curves(axis)


def along(axes: Sequence[Any], panels: Sequence[Panel], marks: Marks) -> float:
    """Mark events along all axes, and label the time below the last; how high the marks' labels are [pt]."""
    lines = [line for panel in panels for line in panel.lines]
    begin = min(float(line.time[0]) for line in lines)
    end = max(float(line.time[-1]) for line in lines)
    said, height = draw(axes, marks, begin, end)
    axes[-1].set_xlabel("Time [s]" + (f"   ({said})" if said else ""), fontsize=TEXT)
    return height
