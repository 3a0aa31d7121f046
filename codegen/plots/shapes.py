"""`mode_shapes`: how much each state takes part in each mode, and in which phase."""

from collections.abc import Sequence
from math import ceil
from typing import Any

import numpy as np

from bondgraph.analyse.state_space import Mode, StateSpace
from bondgraph.errors import SignalError
from codegen.pictures.canvas import canvas
from codegen.pictures.labels import pretty
from codegen.pictures.style import COLOURS, QUIET, SMALL, TEXT
from codegen.plots.poles import ROUNDING, damping_of, oscillations

COLUMNS = 2
"""Modes beside one another."""

MOST = 12
"""Modes, and states of each; of more those are drawn that are slowest, and take part most."""

LEAST = 0.02
"""What takes part by less, as a part of what does most, has no arrow: its phase says nothing."""

CAPTION = "Arrows: right, in phase with what takes part most; left, against it; up, a quarter period ahead"


def mode_shapes(
    model: StateSpace, modes: Sequence[Mode] | None = None, title: str = ""
) -> Any:  # fmt: skip
    """A `matplotlib.figure.Figure`: for each mode bars of the states' participation, and arrows of phase.

    An arrow to the right swings with the state that takes part most, one to the left against it, one
    upwards a quarter period ahead. Participation has no unit, so speeds and torques compare. ``modes``:
    else the model's 12 slowest; of more than 12 states those that take part most.

    Raises `SignalError` if there are none, `MissingExtraError` without matplotlib.
    """
    shown = model.modes() if modes is None else tuple(modes)
    if not shown:
        raise SignalError("there are no modes to draw")
    count, shown = len(shown), shown[:MOST]
    names = _taking_part(shown)
    said = f"Modes, the first {MOST} of {count}" if count > MOST else "Modes"
    rows = ceil(len(shown) / COLUMNS)
    figure = canvas(1.9 * rows + 0.5)
    axes = figure.subplots(rows, COLUMNS, sharey=True, squeeze=False).ravel()
    top = max(max(mode.participation.values()) for mode in shown)
    largest = float(abs(model.poles()).max(initial=0.0))
    swinging = {mode.pole for mode in oscillations(model)}
    for axis, mode in zip(axes, shown, strict=False):
        _draw(axis, mode, names, top)
        axis.set_title(_headline(mode, mode.pole in swinging, largest), fontsize=TEXT)
    for axis in axes[len(shown) :]:
        axis.remove()
    for axis in axes[: len(shown) : COLUMNS]:
        axis.set_ylabel("Participation", fontsize=TEXT)
    figure.suptitle(title or said, fontsize=TEXT + 1)
    figure.supxlabel(CAPTION, fontsize=SMALL, color=QUIET)
    return figure


def _taking_part(modes: Sequence[Mode]) -> list[str]:
    """The states in their order; of many those that take part most in any of the modes."""
    largest = {name: max(mode.participation[name] for mode in modes) for name in modes[0].shape}
    kept = set(sorted(largest, key=lambda name: -largest[name])[:MOST])
    return [name for name in largest if name in kept]


def _draw(axis: Any, mode: Mode, names: Sequence[str], top: float) -> None:
    part = np.array([mode.participation[name] for name in names])
    shape = np.array([mode.shape[name] for name in names])
    phases = np.angle(shape / shape[int(np.argmax(part))])
    places = np.arange(len(names))
    axis.bar(places, part, width=0.6, color=COLOURS[6])
    moved = part >= LEAST * part.max()
    # Directions and lengths are those on paper, whatever the axes' scales.
    axis.quiver(
        places[moved], part[moved] + 0.13 * top, np.cos(phases[moved]), np.sin(phases[moved]),
        angles="uv", pivot="middle", scale=max(4.5, 0.45 * len(names)), scale_units="inches",
        units="inches", width=0.018,
        headwidth=5, headlength=5, headaxislength=4.5, color=COLOURS[1], zorder=3,
    )  # fmt: skip
    axis.set_xticks(places, [pretty(name) for name in names], fontsize=TEXT)
    axis.tick_params(axis="y", labelsize=TEXT - 1)
    axis.set_xlim(-0.7, len(names) - 0.3)
    axis.set_ylim(0, 1.28 * top)
    axis.grid(True, axis="y", linewidth=0.3)
    axis.set_axisbelow(True)


def _headline(mode: Mode, swings: bool, largest: float) -> str:
    if swings:
        return f"{mode.damped_frequency:.4g} Hz, damping ratio {damping_of(mode)}"
    moved = abs(mode.pole) > ROUNDING * largest
    return f"{mode.pole.real:.4g} 1/s" if moved else "0 1/s"
