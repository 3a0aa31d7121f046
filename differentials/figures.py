"""The paper's figures, panel for panel. Needs matplotlib, the optional extra ``pictures``."""

from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bondgraph import MissingExtraError
from codegen import Result
from differentials.scenarios import STIFFNESSES
from differentials.topologies import Differential, catalog

BLUE, ORANGE, GREEN, PINK = "#0072B2", "#D55E00", "#009E73", "#CC79A7"
"""Colours that differ for every eye (Okabe and Ito)."""

STYLES = ((BLUE, "-"), (ORANGE, "--"), (GREEN, "-."), (PINK, ":"))


@dataclass(frozen=True)
class Curve:
    """A signal, or the difference of two, of a run; ``run`` is the number of the run in a figure."""

    signal: str
    label: str
    color: str
    line: str
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
    shade: bool = True


def panels(chosen: Differential) -> tuple[Panel, ...]:
    """The panels of Figs. 11, 13 and 14 for any differential: torques above, speeds below."""
    wheels = range(1, chosen.wheels + 1)
    levels = tuple(chosen.clutches.values())
    marks = [level.removeprefix("tau_h") for level in levels]
    shown = [("In Trq\n[N m]", [*((level, _tau("h", level[5:])) for level in levels),
                                ("tau_e", r"$\tau_e$")])]  # fmt: skip
    if marks:
        shown.append(("Cltch Trq\n[N m]", [(f"tau_f{mark}", _tau("f", mark)) for mark in marks]))
    if chosen.full or chosen.name == "passive_halfshafts":
        shown.append(("Out Trq\n[N m]", [(f"tau_hs{j}", _tau("hs", j)) for j in wheels]))
    if chosen.name == "passive_input_shaft":
        shown.append(("Shaft Trq\n[N m]", [("tau_is", _tau("is", ""))]))
    speeds = [(f"omega_{j}", rf"$\omega_{j}$") for j in wheels]
    ratio = "i_f" if chosen.wheels == 4 else "i"
    shown.append(("Diff Spd\n[rad/s]", [*speeds, ("omega_c", rf"$\omega_e/{ratio}$")]))
    if marks:
        slips = [(f"omega_f{mark}", _omega("f", mark)) for mark in marks]
        shown.append(("Cltch Spd\n[rad/s]", slips))
    shown.append(("Whl Spd\n[rad/s]", [(f"omega_t{j}", _omega("t", j)) for j in wheels]))
    return tuple(Panel(label, _styled(curves)) for label, curves in shown)


def _tau(letters: str, mark: object) -> str:
    return rf"$\tau_{{{letters}{mark}}}$"


def _omega(letters: str, mark: object) -> str:
    return rf"$\omega_{{{letters}{mark}}}$"


def _styled(curves: list[tuple[str, str]]) -> tuple[Curve, ...]:
    styles = (*STYLES, ("0.35", ":"))
    return tuple(
        Curve(signal, label, color, line)
        for (signal, label), (color, line) in zip(curves, styles, strict=False)
    )


def _stiffness_panel(letter: str, speed: int, first: int) -> Panel:
    curves = tuple(
        Curve("tau_hs1", f"$k/k_0$ = {factor:g}", color, line, minus="tau_hs2", run=first + at)
        for at, (factor, (color, line)) in enumerate(zip(STIFFNESSES, STYLES, strict=True))
    )
    return Panel(r"$\Delta\tau$ [N m]", curves, rf"({letter}) $\omega_0$ = {speed} rad/s")


figures: Mapping[str, Figure] = MappingProxyType(
    {
        "fig11": Figure("Response of the ALSD", (("alsd", "fig11"),), panels(catalog["alsd"])),
        "fig12": Figure(
            "ALSD: initial speed and halfshaft stiffness",
            tuple(("alsd", f"fig12_{speed}_{k:g}") for speed in (20, 80) for k in STIFFNESSES),
            (_stiffness_panel("a", 20, 0), _stiffness_panel("b", 80, len(STIFFNESSES))),
            shade=False,
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
    """Draw runs as the paper does, one panel above the other, stick phases shaded, into a PNG.

    Raises `MissingExtraError` without matplotlib.
    """
    tall = 2.6 if len(figure.panels) < 3 else 1.45
    canvas, axes = _subplots(len(figure.panels), tall)
    for axis, panel in zip(axes, figure.panels, strict=True):
        for curve in panel.curves:
            time = results[curve.run].time
            axis.plot(
                time, curve.values(results), color=curve.color, linestyle=curve.line,
                label=curve.label, linewidth=1.1,
            )  # fmt: skip
        for begin, end in stuck_spans(results[0]) if figure.shade else ():
            axis.axvspan(begin, end, color="0.88", linewidth=0)
        axis.set_ylabel(panel.label)
        if panel.heading:
            axis.set_title(panel.heading, fontsize=9, loc="left")
        axis.grid(True, linewidth=0.3)
        axis.margins(x=0)
        axis.legend(loc="center left", bbox_to_anchor=(1.005, 0.5), frameon=False, fontsize=9)
    canvas.suptitle(figure.title, fontsize=10)
    shaded = figure.shade and stuck_spans(results[0])
    axes[-1].set_xlabel("Time [s]" + ("   (grey: a clutch sticks)" if shaded else ""))
    canvas.align_ylabels(axes)
    canvas.savefig(path, dpi=150, bbox_inches="tight")


def stuck_spans(result: Result) -> list[tuple[float, float]]:
    """Begin and end [s] of every stretch in which a friction port sticks after its first event."""
    begun: dict[object, float] = {}
    spans: list[tuple[float, float]] = []
    for event in result.events:
        if event.kind == "stick":
            begun[event.port] = event.time
        elif event.port in begun:
            spans.append((begun.pop(event.port), event.time))
    return spans + [(begin, float(result.time[-1])) for begin in begun.values()]


def _subplots(count: int, tall: float) -> tuple[Any, Any]:
    """A figure of its own, outside any global state of matplotlib."""
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure as Canvas
    except ImportError:
        raise MissingExtraError(
            "pictures need matplotlib; install the optional extra: pip install bondgraph-toolkit[pictures]"
        ) from None
    canvas = Canvas(figsize=(7.2, tall * count), layout="constrained")
    FigureCanvasAgg(canvas)
    return canvas, canvas.subplots(count, 1, sharex=True, squeeze=False)[:, 0]
