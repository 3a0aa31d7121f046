"""Writes ``docs/routes.md``: ``python -m oracles.routes``."""

from pathlib import Path

from bondgraph.writing import write_text
from oracles.routes.page import page

write_text(Path(__file__).parents[4] / "docs" / "routes.md", page())
