"""The paper's figures, panel for panel. Needs matplotlib, the optional extra ``pictures``."""

from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bondgraph.writing import replacing
from codegen import Result
from codegen.pictures import stacked
from codegen.pictures.labels import pretty
from codegen.pictures.marks import Marks
from codegen.record.result import marks_of
from differentials.scenarios import STIFFNESSES
from differentials.topologies import Differential, catalog


@dataclass(frozen=True)
class Curve:
    """A signal, or the difference of two, of a run; ``run`` is the number of the run in a figure."""

    signal: str
    label: str
    minus: str | None = None
    run: int = 0

    def values(self, results: tuple[Result, ...]) -> NDArray[np.float64]:
        """The samples to draw."""
        result = results[self.run]
        return result[self.signal] - (result[self.minus] if self.minus else 0.0)


@dataclass(frozen=True)
class Panel:
    """One axis: its label, its curves, and a heading where several runs stand above one another."""

    label: str
    curves: tuple[Curve, ...]
    heading: str = ""


@dataclass(frozen=True)
class Figure:
    """A figure of the paper: the runs it shows, each a differential and a scenario, and its panels."""

    title: str
    runs: tuple[tuple[str, str], ...]
    panels: tuple[Panel, ...]
    marked: bool = True


def panels(chosen: Differential) -> tuple[Panel, ...]:
    """The panels of Figs. 11, 13 and 14 for any differential: torques above, speeds below."""
    wheels = range(1, chosen.wheels + 1)
    levels = tuple(chosen.clutches.values())
    marks = [level.removeprefix("tau_h") for level in levels]
    shown = [_panel("In Trq\n[N m]", *levels, "tau_e")]
    if marks:
        shown.append(_panel("Cltch Trq\n[N m]", *(f"tau_f{mark}" for mark in marks)))
    if chosen.full or chosen.name == "passive_halfshafts":
        shown.append(_panel("Out Trq\n[N m]", *(f"tau_hs{j}" for j in wheels)))
    if chosen.name == "passive_input_shaft":
        shown.append(_panel("Shaft Trq\n[N m]", "tau_is"))
    ratio = "i_f" if chosen.wheels == 4 else "i"
    case = Curve("omega_c", rf"$\omega_e/{ratio}$")
    speeds = _panel("Diff Spd\n[rad/s]", *(f"omega_{j}" for j in wheels))
    shown.append(Panel(speeds.label, (*speeds.curves, case)))
    if marks:
        shown.append(_panel("Cltch Spd\n[rad/s]", *(f"omega_f{mark}" for mark in marks)))
    shown.append(_panel("Whl Spd\n[rad/s]", *(f"omega_t{j}" for j in wheels)))
    return tuple(shown)


def _panel(label: str, *signals: str) -> Panel:
    return Panel(label, tuple(Curve(signal, pretty(signal)) for signal in signals))


def _stiffness_panel(letter: str, speed: int, first: int) -> Panel:
    curves = tuple(
        Curve("tau_hs1", f"$k/k_0$ = {factor:g}", minus="tau_hs2", run=first + at)
        for at, factor in enumerate(STIFFNESSES)
    )
    return Panel(r"$\Delta\tau$ [N m]", curves, rf"({letter}) $\omega_0$ = {speed} rad/s")


figures: Mapping[str, Figure] = MappingProxyType(
    {
        "fig11": Figure("Response of the ALSD", (("alsd", "fig11"),), panels(catalog["alsd"])),
        "fig12": Figure(
            "ALSD: initial speed and halfshaft stiffness",
            tuple(("alsd", f"fig12_{speed}_{k:g}") for speed in (20, 80) for k in STIFFNESSES),
            (_stiffness_panel("a", 20, 0), _stiffness_panel("b", 80, len(STIFFNESSES))),
            marked=False,
        ),
        "fig13": Figure(
            "Response of the stationary clutch TVD",
            (("stationary_tvd", "fig13"),),
            panels(catalog["stationary_tvd"]),
        ),
        "fig13_superposition": Figure(
            "Response of the superposition clutch TVD",
            (("superposition_tvd", "fig13_superposition"),),
            panels(catalog["superposition_tvd"]),
        ),
        "fig14": Figure(
            "Response of the 4WD TVD",
            (("four_wheel_drive_tvd", "fig14"),),
            panels(catalog["four_wheel_drive_tvd"]),
        ),
    }
)
"""By the paper's numbers; the superposition TVD, which its text compares with Fig. 13, beside it."""


def draw(figure: Figure, results: tuple[Result, ...], path: str | PathLike[str]) -> None:
    """Draw runs as the paper does, one panel above the other, events and stick phases marked, into a file.

    Raises `MissingExtraError` without matplotlib.
    """
    shown = [
        stacked.Panel(
            panel.label,
            tuple(
                stacked.Line(results[curve.run].time, curve.values(results), curve.label)
                for curve in panel.curves
            ),
            panel.heading,
        )
        for panel in figure.panels
    ]
    marks = marks_of(results[0]) if figure.marked else Marks()
    tall = 2.6 if len(figure.panels) < 3 else 1.45
    canvas = stacked.stacked(shown, marks, figure.title, tall)
    save_picture(canvas, path)


def save_picture(canvas: Any, path: str | PathLike[str]) -> None:
    """Write a figure of matplotlib as its path's ending says, .png without one."""
    kind = Path(path).suffix[1:] or "png"
    with replacing(path) as file:
        canvas.savefig(file, format=kind, dpi=150, bbox_inches="tight")
