"""`pole_map`: the poles of a linear model in the complex plane."""

from typing import Any

import numpy as np

from bondgraph.response import Mode, StateSpace
from codegen.pictures.canvas import stack
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
    stable, others = poles[poles.real < 0], poles[poles.real >= 0]
    for number, (some, what) in enumerate(
        ((stable, "stable"), (others, "on the axis, or unstable"))
    ):
        if len(some):
            axis.plot(
                some.real, some.imag, linestyle="", marker="xo"[number], markersize=7, label=what,
                color=curve(number)["color"], fillstyle="none", zorder=3,
            )  # fmt: skip
    width, height = _limits(axis, poles)
    _rays(axis, width, height)
    _name(axis, oscillations(model), height)
    axis.set_xlabel("Real part [1/s]", fontsize=TEXT)
    axis.set_ylabel("Imaginary part [1/s]", fontsize=TEXT)
    axis.tick_params(labelsize=TEXT - 1)
    axis.grid(True, linewidth=0.3)
    if len(stable) and len(others):
        axis.legend(loc="center left", bbox_to_anchor=(1.005, 0.5), frameon=False, fontsize=TEXT)
    figure.suptitle(title or "Poles", fontsize=TEXT + 1)
    return figure


def oscillations(model: StateSpace) -> list[Mode]:
    """The modes that oscillate, slowest first; poles at 0 come with imaginary parts of rounding."""
    modes = model.modes()
    least = ROUNDING * max((abs(mode.pole) for mode in modes), default=0.0)
    return [mode for mode in modes if mode.pole.imag > least]


def _limits(axis: Any, poles: Any) -> tuple[float, float]:
    """Leave room around the poles; how far the axis goes to the left, and up."""
    left = max(float(-poles.real.min(initial=0.0)), 0.0)
    right = max(float(poles.real.max(initial=0.0)), 0.0)
    height = float(abs(poles.imag).max(initial=0.0))
    size = max(left, right, height) or 1.0
    left, right = 1.15 * left + 0.02 * size, 1.15 * right + 0.05 * size
    height = 1.15 * height if height else 0.5 * size
    axis.set_xlim(-left, right)
    axis.set_ylim(-height, height)
    return left, height


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
            left = slope * width < height
            axis.annotate(
                f"ζ = {ratio:g}", (-reach, slope * reach), xytext=(3, 0) if left else (0, -3),
                textcoords="offset points", fontsize=SMALL, color=FAINT, bbox=BEHIND,
                ha="left" if left else "center", va="center" if left else "top",
            )  # fmt: skip


def _name(axis: Any, modes: list[Mode], height: float) -> None:
    """Frequencies and dampings beside the upper poles, one above the other where they are close."""
    points = axis.figure.get_figheight() * 72 * 0.42
    lowest = -np.inf
    for mode in sorted(modes, key=lambda mode: mode.pole.imag):
        own = mode.pole.imag / height * points
        lowest = max(lowest + 1.4 * SMALL, own)
        axis.annotate(
            f"{mode.damped_frequency:.4g} Hz, ζ = {mode.damping:.2g}",
            (mode.pole.real, mode.pole.imag), xytext=(-16, lowest - own), textcoords="offset points",
            fontsize=SMALL, color=QUIET, ha="right", va="center", gid="mode", bbox=BEHIND,
            arrowprops={"arrowstyle": "-", "linewidth": 0.5, "color": FAINT, "shrinkA": 0, "shrinkB": 4},
        )  # fmt: skip
