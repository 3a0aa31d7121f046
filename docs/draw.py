"""Draws the pictures of this folder: ``python docs/draw.py``."""

import doctest
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

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
SPEED_LOOP = "speed_loop.svg"
FIGURES = {
    "quarter_car.svg": ("tour.md", "# ", "savefig"),
    "slip_control.svg": ("your-own-differential.md", "## A slip controller", "![Slip"),
}
"""Figures of runs: file to page, and the texts between which its examples make it."""


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


def speed_loop() -> Any:
    """A motor whose speed a controller with a bounded integral sees to."""
    return bg.graph(
        [bg.Se("motor"), bg.One("shaft"), bg.I("J", "J", flow="omega"), bg.R("b", "b"), bg.Df("tacho"),
         bg.Function("ref", "30*(1 - exp(-t))"), bg.State("z", "K_i*error", low=-8, high=8),
         bg.Function("error", "plus - minus", ports=["plus", "minus"]),
         bg.Function("tau", "K*e + z", ports=["e"])],
        "motor > shaft > J, shaft > b, shaft > tacho",
        "ref > error.plus, tacho > error.minus, error > tau > motor, error > z > tau",
    )  # fmt: skip


def picture(file: str) -> str:
    """What the file should hold."""
    if file == SPEED_LOOP:
        return bg.drawing(speed_loop(), title="Blocks of signals around a bond graph").svg()
    if file == PENDULUM:
        return bg.drawing(pendulum(), title="Pendulum: its angle modulates two transformers").svg()
    name, title = PICTURES[file]
    return bg.drawing(differentials.graph(name), title=title).svg()


def shown(page: str, begin: str, end: str) -> Any:
    """The figure ``picture`` that the examples of a page make between two of its texts."""
    text = (FOLDER.parent / page).read_text(encoding="utf-8")
    text = text[text.index(begin) :].partition(end)[0]
    names: dict[str, Any] = {}
    with redirect_stdout(StringIO()):
        for example in doctest.DocTestParser().get_examples(text):
            exec(compile(example.source, page, "exec"), names)
    return names["picture"]


if __name__ == "__main__":
    import matplotlib

    # The versions of matplotlib write other bytes for the same curves.
    matplotlib.rcParams["svg.hashsalt"] = "pictures"
    for file, told in FIGURES.items():
        shown(*told).savefig(FOLDER / file, metadata={"Date": None})
    for file in (*PICTURES, PENDULUM, SPEED_LOOP):
        write_text(FOLDER / file, picture(file))
