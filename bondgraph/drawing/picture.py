"""`drawing`: a bond graph as a picture."""

from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Any

from bondgraph.drawing.compose import Layout, Writing, scene
from bondgraph.drawing.listing import listing
from bondgraph.drawing.plot import save_figure
from bondgraph.drawing.shapes import Scene
from bondgraph.drawing.subject import Subject, subject
from bondgraph.drawing.svg import svg
from bondgraph.errors import StructureError
from bondgraph.writing import write_text


@dataclass(frozen=True)
class Drawing:
    """A picture of a bond graph, which notebooks show by itself.

    ``scene``: its nodes and bonds with their places in points, y downwards; ``subject``: what it shows.
    """

    scene: Scene
    subject: Subject = field(repr=False)
    powers: bool = False
    numbers: bool = False

    def svg(self) -> str:
        """The picture as an SVG document; the same graph gives the same bytes everywhere."""
        return svg(self.scene)

    def text(self) -> str:
        """The bonds for a terminal, a line each, ``|`` at the end that receives the effort."""
        return listing(self.subject, self.scene.order, self.powers, self.numbers)

    def save(self, path: str | PathLike[str]) -> None:
        """Write the picture as .svg, .png or .pdf, as the suffix says.

        Raises `StructureError` for another suffix, `MissingExtraError` for .png and .pdf without matplotlib,
        `WriteError` where the file cannot be written; what was there is kept.
        """
        target = Path(path)
        if target.suffix == ".svg":
            write_text(target, self.svg())
        elif target.suffix in (".png", ".pdf"):
            save_figure(self.scene, target)
        else:
            raise StructureError(
                f"a drawing is saved as .svg, .png or .pdf, not {target.suffix or target.name!r}"
            )

    def _repr_svg_(self) -> str:
        return self.svg()


def drawing(
    graph: Any, powers: bool = False, values: bool = True, title: str = "Bond graph",
    names: bool = False, numbers: bool = False, signals: bool = True, layout: Layout | None = None,
) -> Drawing:  # fmt: skip
    """Draw a causal graph, or a declared one whose causality is then assigned.

    Half arrows point with positive power, the causal stroke lies at the end that receives the effort;
    storages in derivative causality stand in a dashed frame. ``powers`` writes efforts over and flows
    under the bonds, where the one-port or a junction at the bond has a name for them. ``values=False``
    writes names of elements instead of their values and conditions, ``names`` both. ``numbers`` numbers
    the bonds in the order of ``scene.bonds``. ``layout``: whether layers follow from left to right
    ("horizontal") or from top to bottom ("vertical"); by default chains and what would be tall lie.

    What an element reads of another, in its value, law or condition, is a signal: a thin line with a full
    arrow, from the detector, junction or storage that has it. Transformers, gyrators, sources and
    resistances that signals rule are MTF, MGY, MSe, MSf, MR, those but sources also if the time does.
    ``signals=False`` leaves the lines out. Bonds to detectors carry no power and have full arrows; a
    field's bonds have the names of its ports.

    The first source is on top, or on the left. Elements left of their bond read ``J :I``, so that the
    symbol is at the bond. A switch is a Sw with what turns it on above zero (a diode with what it lets
    through, a latch with what turns it off, too); in a mode it is on or off. Parts that signals alone
    join stand side by side. A graph that `assign_causality` refuses is drawn without strokes, with the
    reason under it.

    Raises `StructureError` for what is not a bond graph, and for another layout.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("engine", "tau_e"), bg.One("shaft"), bg.I("J", "J"), bg.I("rotor", "J_r")])
    >>> g.add_edges_from([("engine", "shaft"), ("shaft", "J"), ("shaft", "rotor")])
    >>> print(drawing(g).text())
    Se: τₑ    ──⇀|  1 shaft
    1 shaft   ──⇀|  I: J
    1 shaft  |──⇀   I: Jᵣ *
    * dependent storage (derivative causality)
    """
    if layout not in (None, "horizontal", "vertical"):
        raise StructureError(f"layout is 'horizontal', 'vertical' or None, not {layout!r}")
    what = subject(graph, values, names, signals)
    writing = Writing(powers, numbers, layout)
    return Drawing(scene(what, title, writing), what, powers, numbers)
