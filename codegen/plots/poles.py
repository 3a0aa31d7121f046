"""`pole_map`: the poles of a linear model in the complex plane."""

from typing import Any

import numpy as np

from bondgraph.analyse.state_space import ComplexArray, Mode, StateSpace
from codegen.pictures.canvas import name_curves, rule, stack
from codegen.pictures.style import FAINT, QUIET, SMALL, TEXT, curve

DAMPINGS = (0.1, 0.2, 0.4, 0.7)
"""Damping ratios of the rays."""

ROUNDING = 1e-9
"""Poles that are smaller, as a part of the largest, are at 0."""

BEHIND = {"facecolor": "white", "edgecolor": "none", "pad": 0.8}
"""What texts have behind them, so that no line runs through."""


def pole_map(model: StateSpace, title: str = "") -> Any:
    """A `matplotlib.figure.Figure` of the poles [1/s], oscillations with frequency and damping ratio.

    Rays join poles of one damping ratio. Raises `MissingExtraError` without matplotlib.
    """
    figure, (axis,) = stack(1, 4.4)
    poles = model.poles()
    axis.axhline(0, linewidth=0.8, color=QUIET)
    axis.axvline(0, linewidth=0.8, color=QUIET)
    decays = poles.real < -ROUNDING * abs(poles).max(initial=0.0)
    stable, others = poles[decays], poles[~decays]
    for number, (some, what) in enumerate(
        ((stable, "stable"), (others, "on the axis, or unstable"))
    ):
        if len(some):
            axis.plot(
                some.real, some.imag, linestyle="", marker="xo"[number], markersize=7, label=what,
                color=curve(number)["color"], fillstyle="none", zorder=3,
            )  # fmt: skip
    left, right, height = _limits(axis, poles)
    _rays(axis, left, height)
    _name(axis, oscillations(model), (right - left) / 2, height)
    axis.set_xlabel("Real part [1/s]", fontsize=TEXT)
    axis.set_ylabel("Imaginary part [1/s]", fontsize=TEXT)
    rule(axis)
    if len(stable) and len(others):
        name_curves(axis)
    figure.suptitle(title or "Poles", fontsize=TEXT + 1)
    return figure


def oscillations(model: StateSpace) -> list[Mode]:
    """The modes that oscillate, slowest first; poles at 0 come with imaginary parts of rounding."""
    modes = model.modes()
    least = ROUNDING * max((abs(mode.pole) for mode in modes), default=0.0)
    return [mode for mode in modes if mode.pole.imag > least]


def damping_of(mode: Mode) -> str:
    """The damping ratio as text, without what is rounding."""
    return f"{round(mode.damping, 9) + 0.0:.2g}"


def _limits(axis: Any, poles: ComplexArray) -> tuple[float, float, float]:
    """Leave room around the poles; how far the axis goes to the left, to the right, and up."""
    left = max(float(-poles.real.min(initial=0.0)), 0.0)
    right = max(float(poles.real.max(initial=0.0)), 0.0)
    height = float(abs(poles.imag).max(initial=0.0))
    size = (left + right) or height or 1.0
    left, right = left + 0.15 * size, right + 0.1 * size
    height = 1.15 * height or 0.5 * size
    axis.set_xlim(-left, right)
    axis.set_ylim(-height, height)
    return left, right, height


def _rays(axis: Any, width: float, height: float) -> None:
    """Rays of equal damping, named at the edge where there is room."""
    before = np.full(2, -np.inf)
    for ratio in DAMPINGS:
        slope = np.sqrt(1 - ratio**2) / ratio
        reach = min(width, height / slope)
        for sign in (1, -1):
            axis.plot(
                [0, -reach], [0, sign * slope * reach], linewidth=0.6, linestyle=":", color=FAINT,
                gid="ray",
            )  # fmt: skip
        end = np.array([reach / width, slope * reach / (2 * height)])
        if (abs(end - before) > (0.09, 0.04)).any():
            before = end
            left, top = reach > 0.9 * width, slope * reach > 0.95 * height
            axis.annotate(
                f"ζ = {ratio:g}", (-reach, slope * reach), xytext=(3 * left, -3 * top),
                textcoords="offset points", fontsize=SMALL, color=FAINT, bbox=BEHIND,
                ha="left" if left else "center", va="top" if top else "center",
            )  # fmt: skip


def _name(axis: Any, modes: list[Mode], middle: float, height: float) -> None:
    """Frequencies and dampings beside the upper poles; those that are close are in a column."""
    points = axis.figure.get_figheight() * 72 * 0.42
    lowest = -np.inf
    for mode in sorted(modes, key=lambda mode: mode.pole.imag):
        own = mode.pole.imag / height * points
        lowest = max(lowest + 1.4 * SMALL, own)
        side, reach = ("right", -16) if mode.pole.real > middle else ("left", 16)
        axis.annotate(
            f"{mode.damped_frequency:.4g} Hz, ζ = {damping_of(mode)}",
            (mode.pole.real, mode.pole.imag), xytext=(reach, lowest - own), textcoords="offset points",
            fontsize=SMALL, color=QUIET, ha=side, va="center", gid="mode", bbox=BEHIND,
            arrowprops={"arrowstyle": "-", "linewidth": 0.5, "color": FAINT, "shrinkA": 0, "shrinkB": 4},
        )  # fmt: skip
