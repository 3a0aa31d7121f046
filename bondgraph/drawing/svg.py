"""A picture as SVG: plain text, the same bytes for the same picture, nothing outside it needed."""

from collections.abc import Iterator
from xml.sax.saxutils import escape

from bondgraph.drawing.metrics import FAMILY, SHIFT, SMALL, run_width
from bondgraph.drawing.shapes import INK, MARKED, Label, Scene
from bondgraph.layout.boxes import Box, Point

FINE, THIN, THICK = 0.7, 1.2, 2.0
"""Widths of signals, of bonds and of causal strokes."""

DOT = 1.8
"""Radius of the dot where a signal branches off."""

DASH = "3 2"
_FONTS = f"{FAMILY}, Verdana, sans-serif"


def svg(scene: Scene) -> str:
    """The picture as a document, with its title and a description in words."""
    return "\n".join(_lines(scene)) + "\n"


def _lines(scene: Scene) -> Iterator[str]:
    wide, high = f"{scene.width:g}", f"{scene.height:g}"
    yield (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{wide}" height="{high}" '
        f'viewBox="0 0 {wide} {high}" role="img">'
    )
    yield f"<title>{escape(scene.title)}</title>"
    yield f"<desc>{escape(scene.description)}</desc>"
    yield f'<rect width="{wide}" height="{high}" fill="#ffffff"/>'
    yield (
        f'<g fill="none" stroke="{INK}" stroke-width="{THIN}" stroke-linecap="round" '
        'stroke-linejoin="round">'
    )
    for bond in scene.bonds:
        yield f'<path d="{_path(bond.path if bond.other else bond.path + (bond.barb,))}"/>'
    for bond in scene.bonds:
        if bond.stroke:
            yield f'<path d="{_path(bond.stroke)}" stroke-width="{THICK}"/>'
    for signal in scene.signals:
        yield f'<path d="{_path(signal.path)}" stroke-width="{FINE}"/>'
    for head in full_arrows(scene):
        yield f'<path d="{_path(head)}Z" fill="{INK}" stroke-width="{FINE}"/>'
    for x, y in branches(scene):
        yield f'<circle cx="{_number(x)}" cy="{_number(y)}" r="{DOT}" fill="{INK}" stroke="none"/>'
    yield "</g>"
    for box in scene.frames:
        yield _frame(box, MARKED, f' stroke-dasharray="{DASH}"')
    for box in scene.blocks:
        yield _frame(box, INK)
    yield f'<g font-family="{_FONTS}" xml:space="preserve">'
    for label in scene.labels:
        yield _text(label)
    yield "</g>"
    yield "</svg>"


def full_arrows(scene: Scene) -> list[tuple[Point, Point, Point]]:
    """The corners of every full arrow: of signals, and of bonds that carry no power."""
    bonds = [(one.barb, one.path[-1], one.other) for one in scene.bonds if one.other]
    return [*bonds, *((one.barbs[0], one.path[-1], one.barbs[1]) for one in scene.signals)]


def branches(scene: Scene) -> list[Point]:
    """Where signals branch off."""
    return [one.path[0] for one in scene.signals if one.branch]


def _text(label: Label) -> str:
    """Every run at its own place and width, so that no viewer's font can move it."""
    parts = []
    x = label.x
    for run in label.rich:
        wide = run_width(run.text, run.level, label.size)
        small = f' font-size="{_number(label.size * SMALL)}"' if run.level else ""
        y = label.y + SHIFT[run.level] * label.size
        parts.append(
            f'<tspan x="{_number(x)}" y="{_number(y)}" textLength="{_number(wide)}" '
            f'lengthAdjust="spacingAndGlyphs"{small}>{escape(run.text)}</tspan>'
        )
        x += wide
    return f'<text font-size="{_number(label.size)}" fill="{label.colour}">{"".join(parts)}</text>'


def _frame(box: Box, colour: str, dashes: str = "") -> str:
    wide, high = box.right - box.left, box.bottom - box.top
    return (
        f'<rect x="{_number(box.left)}" y="{_number(box.top)}" width="{_number(wide)}" '
        f'height="{_number(high)}" rx="2" fill="none" stroke="{colour}" stroke-width="{THIN}"{dashes}/>'
    )


def _path(points: tuple[Point, ...]) -> str:
    return "M" + " L".join(f"{_number(x)} {_number(y)}" for x, y in points)


def _number(value: float) -> str:
    """At most two decimals, and no sign on a zero."""
    return f"{round(value, 2) + 0.0:.6g}"
