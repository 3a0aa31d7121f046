"""A picture as PNG or PDF, by matplotlib, the optional extra ``pictures``."""

from pathlib import Path
from typing import Any

from bondgraph.drawing.metrics import FAMILY, SHIFT, SMALL, run_width
from bondgraph.drawing.shapes import INK, MARKED, Label, Scene
from bondgraph.drawing.svg import DOT, FINE, THICK, THIN, branches, full_arrows
from bondgraph.errors import MissingExtraError
from bondgraph.layout.boxes import Box, Point
from bondgraph.writing import replacing

DOTS_PER_INCH = 200
_POINTS = 72


def save_figure(scene: Scene, path: Path) -> None:
    """Write the picture as the suffix says, one unit of the picture a point.

    Raises `MissingExtraError` without matplotlib, `WriteError` where the file cannot be written.
    """
    figure, axes = _canvas(scene)
    for bond in scene.bonds:
        _line(axes, bond.path if bond.other else bond.path + (bond.barb,), THIN)
        if bond.stroke:
            _line(axes, bond.stroke, THICK)
    for signal in scene.signals:
        _line(axes, signal.path, FINE)
    _heads(axes, scene)
    for box in scene.frames:
        _frame(axes, box, MARKED, (0, (3, 2)))
    for box in scene.blocks:
        _frame(axes, box, INK, "-")
    for label in scene.labels:
        _text(axes, label)
    # Without a date, so that the same picture is the same bytes.
    stamp = {"CreationDate": None} if path.suffix == ".pdf" else {"Software": None}
    metadata = {"Title": scene.title, **stamp}
    with replacing(path) as file:
        figure.savefig(file, format=path.suffix[1:], dpi=DOTS_PER_INCH, metadata=metadata)


def _canvas(scene: Scene) -> tuple[Any, Any]:
    """A page of the picture's size, outside any global state of matplotlib."""
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise MissingExtraError(
            "PNG and PDF need matplotlib; install the optional extra: "
            "pip install bondgraph-toolkit[pictures], or save as .svg"
        ) from None
    figure = Figure(figsize=(scene.width / _POINTS, scene.height / _POINTS))
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_xlim(0, scene.width)
    axes.set_ylim(scene.height, 0)
    axes.set_axis_off()
    return figure, axes


def _line(axes: Any, points: tuple[Point, ...], wide: float) -> None:
    xs, ys = zip(*points, strict=True)
    axes.plot(xs, ys, color=INK, linewidth=wide, solid_capstyle="round", solid_joinstyle="round")


def _heads(axes: Any, scene: Scene) -> None:
    """Full arrows, and dots where signals branch off."""
    from matplotlib.patches import Circle, Polygon

    for corners in full_arrows(scene):
        axes.add_patch(Polygon(corners, facecolor=INK, edgecolor=INK, linewidth=FINE))
    for point in branches(scene):
        axes.add_patch(Circle(point, DOT, facecolor=INK, linewidth=0))


def _frame(axes: Any, box: Box, colour: str, style: Any) -> None:
    from matplotlib.patches import Rectangle

    corner, wide, high = (box.left, box.top), box.right - box.left, box.bottom - box.top
    axes.add_patch(
        Rectangle(corner, wide, high, fill=False, edgecolor=colour, linewidth=THIN, linestyle=style)
    )


def _text(axes: Any, label: Label) -> None:
    x = label.x
    for run in label.rich:
        size = label.size * (SMALL if run.level else 1.0)
        axes.text(
            x, label.y + SHIFT[run.level] * label.size, run.text, fontsize=size, fontfamily=FAMILY,
            color=label.colour, ha="left", va="baseline", parse_math=False,
        )  # fmt: skip
        x += run_width(run.text, run.level, label.size)
