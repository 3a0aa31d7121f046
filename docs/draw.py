"""Draws the pictures of this folder: ``python docs/draw.py``."""

from pathlib import Path

import networkx as nx

import bondgraph as bg
import differentials
from bondgraph.writing import write_text

FOLDER = Path(__file__).parent / "pictures"

PICTURES = {
    "alsd.svg": ("alsd", "Active limited slip differential (Fig. 7a)"),
    "fig2a.svg": ("passive", "Passive differential (Fig. 2a)"),
}
"""File to differential and title."""


PENDULUM = "pendulum.svg"


def pendulum() -> "nx.DiGraph[str]":
    """A weight on a rod, dragged sideways: its angle modulates both transformers."""
    graph: nx.DiGraph[str] = nx.DiGraph()
    graph.add_nodes_from([
        bg.One("turn"), bg.I("J", "J", flow="omega"), bg.Df("angle", integrate="theta"),
        bg.TF("across", "l*cos(theta)"), bg.One("v_x"), bg.R("drag", "b"),
        bg.TF("up", "l*sin(theta)"), bg.One("v_y"), bg.Se("weight", "-m*g"),
    ])  # fmt: skip
    graph.add_edges_from([
        ("turn", "J"), ("turn", "angle"), ("turn", "across"), ("across", "v_x"), ("v_x", "drag"),
        ("turn", "up"), ("up", "v_y"), ("weight", "v_y"),
    ])  # fmt: skip
    return graph


def picture(file: str) -> str:
    """What the file should hold."""
    if file == PENDULUM:
        return bg.drawing(pendulum(), title="Pendulum: its angle modulates two transformers").svg()
    name, title = PICTURES[file]
    return bg.drawing(differentials.graph(name), title=title).svg()


if __name__ == "__main__":
    for file in (*PICTURES, PENDULUM):
        write_text(FOLDER / file, picture(file))
