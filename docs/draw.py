"""Draws the pictures of this folder: ``python docs/draw.py``."""

from pathlib import Path

import bondgraph as bg
import differentials
from bondgraph.writing import write_text

FOLDER = Path(__file__).parent / "pictures"

PICTURES = {
    "alsd.svg": ("alsd", "Active limited slip differential (Fig. 7a)"),
    "fig2a.svg": ("passive", "Passive differential (Fig. 2a)"),
}
"""File to differential and title."""


def picture(file: str) -> str:
    """What the file should hold."""
    name, title = PICTURES[file]
    return bg.drawing(differentials.graph(name), title=title).svg()


if __name__ == "__main__":
    for file in PICTURES:
        write_text(FOLDER / file, picture(file))
