"""`drawing`: a bond graph as a picture."""

from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Any

from bondgraph.drawing.compose import scene
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

    def svg(self) -> str:
        """The picture as an SVG document; the same graph gives the same bytes everywhere."""
        return svg(self.scene)

    def text(self) -> str:
        """The bonds for a terminal, a line each, ``|`` at the end that receives the effort."""
        boxes = [node.labels[0].box for node in self.scene.nodes]
        rows = {at: (round(box.bottom), box.left) for at, box in enumerate(boxes)}
        return listing(self.subject, rows, self.powers)

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
    graph: Any, powers: bool = False, values: bool = True, title: str = "Bond graph"
) -> Drawing:
    """Draw a causal graph, or a declared one whose causality is then assigned.

    Half arrows point with positive power, the causal stroke lies at the end that receives the effort;
    storages in derivative causality stand in a dashed frame. ``powers`` writes efforts over and flows
    under the bonds, where the one-port or a junction at the bond has a name for them. ``values=False``
    writes names of elements instead of their values and conditions.

    The first source is on top. Elements left of their bond read ``J :I``, so that the symbol is at the
    bond. A switch is a Sw with what turns it on above zero (a diode with what it lets through, a latch with
    what turns it off, too); in a mode it is on or off. A graph that `assign_causality` refuses is drawn
    without strokes, with the reason under it.

    Raises `StructureError` for what is not a bond graph.

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
    what = subject(graph, values)
    return Drawing(scene(what, title, powers), what, powers)
