"""The paper's figures, panel for panel. Needs matplotlib, the optional extra ``pictures``."""

from os import PathLike
from typing import Any

from bondgraph import MissingExtraError
from codegen import Result

Panel = tuple[str, tuple[tuple[str, str, str], ...]]
"""An axis label, and for each curve the signal, its label and its line style."""

FIG_11: tuple[Panel, ...] = (
    ("In Trq\n[N m]", (("tau_h", r"$\tau_h$", "C1--"), ("tau_e", r"$\tau_e$", "C0-"))),
    (r"$\tau_f$" + "\n[N m]", (("tau_f", r"$\tau_f$", "C0-"),)),
    ("Out Trq\n[N m]", (("tau_hs1", r"$\tau_{hs1}$", "C0-"), ("tau_hs2", r"$\tau_{hs2}$", "C1--"))),
    (
        "Diff Spd\n[rad/s]",
        (
            ("omega_2", r"$\omega_2$", "C1--"),
            ("omega_c", r"$\omega_e/i$", "C2:"),
            ("omega_1", r"$\omega_1$", "C0-"),
        ),
    ),
    (r"$\omega_f$" + "\n[rad/s]", (("omega_f", r"$\omega_f$", "C0-"),)),
    (
        "Whl Spd\n[rad/s]",
        (("omega_t1", r"$\omega_{t1}$", "C0-"), ("omega_t2", r"$\omega_{t2}$", "C1--")),
    ),
)
"""Fig. 11: the ALSD's answer to a step of the engine torque and one of the clutch torque."""


def draw(result: Result, panels: tuple[Panel, ...], title: str, path: str | PathLike[str]) -> None:
    """Draw a run as the paper does, one panel above the other, stick phases shaded, into a PNG.

    Raises `MissingExtraError` without matplotlib.
    """
    figure, axes = _subplots(len(panels))
    for axis, (label, curves) in zip(axes, panels, strict=True):
        for name, text, style in curves:
            axis.plot(result.time, result[name], style, label=text, linewidth=1.1)
        for begin, end in stuck_spans(result):
            axis.axvspan(begin, end, color="0.88", linewidth=0)
        axis.set_ylabel(label)
        axis.grid(True, linewidth=0.3)
        axis.margins(x=0)
        axis.legend(loc="center left", bbox_to_anchor=(1.005, 0.5), frameon=False, fontsize=9)
    axes[0].set_title(title, fontsize=10)
    axes[-1].set_xlabel("Time [s]   (grey: the clutch sticks)")
    figure.align_ylabels(axes)
    figure.savefig(path, dpi=150, bbox_inches="tight")


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


def _subplots(count: int) -> tuple[Any, Any]:
    """A figure of its own, outside any global state of matplotlib."""
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise MissingExtraError(
            "pictures need matplotlib; install the optional extra: pip install bondgraph-toolkit[pictures]"
        ) from None
    figure = Figure(figsize=(7.2, 1.45 * count), layout="constrained")
    FigureCanvasAgg(figure)
    return figure, figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0]
