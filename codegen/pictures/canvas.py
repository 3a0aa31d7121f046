"""Figures of matplotlib, outside its global state: nothing to close, nothing that opens a window."""

from typing import Any

from bondgraph.errors import MissingExtraError
from codegen.pictures.style import TEXT

WIDTH = 7.2
"""Of every picture [in]."""


def canvas(height: float) -> Any:
    """An empty `matplotlib.figure.Figure` of that height [in]; `MissingExtraError` without matplotlib."""
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise MissingExtraError(
            "pictures need matplotlib; install the optional extra: pip install bondgraph-toolkit[pictures]"
        ) from None
    figure = Figure(figsize=(WIDTH, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def stack(count: int, height: float) -> tuple[Any, list[Any]]:
    """A figure, and axes below one another that share what runs to the right; each so high [in]."""
    figure = canvas(height * count + 0.35)
    return figure, list(figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0])


def rule(axis: Any) -> None:
    """Fine lines across an axis, and small numbers beside it."""
    axis.grid(True, linewidth=0.3)
    axis.tick_params(labelsize=TEXT - 1)


def name_curves(axis: Any) -> None:
    """A legend to the right of an axis, where it covers nothing."""
    axis.legend(
        loc="center left", bbox_to_anchor=(1.005, 0.5), frameon=False, fontsize=TEXT, handlelength=2.6
    )  # fmt: skip
