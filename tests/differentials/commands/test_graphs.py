"""Graphs as pictures and as files."""

from collections.abc import Callable
from pathlib import Path

import networkx as nx
import pytest
from click.testing import Result

import bondgraph as bg
import differentials

Call = Callable[..., Result]


@pytest.mark.parametrize(("ending", "begins"), [("svg", b"<"), ("png", b"\x89PNG"), ("pdf", b"")])
def test_draw_writes_a_picture(ending: str, begins: bytes, call: Call, tmp_path: Path) -> None:
    done = call("draw", "alsd", "-o", f"new/alsd.{ending}")
    assert (done.exit_code, done.stdout) == (0, f"new/alsd.{ending}\n")
    assert (tmp_path / "new" / f"alsd.{ending}").read_bytes().startswith(begins)


def test_draw_without_a_file_is_text(call: Call) -> None:
    text = call("draw", "alsd").stdout
    for name in ("input", "case", "left", "right"):
        assert name in text


def test_draw_takes_layout_names_and_numbers(call: Call, tmp_path: Path) -> None:
    """A part of its own drives the source: the picture lies, has names and numbers, and the signal."""
    graph = nx.DiGraph()
    graph.add_nodes_from([
        bg.Se("drive", "-k*x"), bg.One("body"), bg.I("mass", "m"), bg.Sf("speed", "u"), bg.Zero("node"),
        bg.C("store", "c", effort="x"),
    ])  # fmt: skip
    graph.add_edges_from(
        [("drive", "body"), ("body", "mass"), ("speed", "node"), ("node", "store")]
    )
    bg.write_json(graph, tmp_path / "parts.json")
    words = ["--names", "--numbers", "--layout", "horizontal", "-o", "parts.svg"]
    assert call("draw", "parts.json", *words).exit_code == 0
    drawing = bg.drawing(graph, names=True, numbers=True, layout="horizontal")
    assert (tmp_path / "parts.svg").read_text(encoding="utf-8") == drawing.svg()
    lines = call("draw", "parts.json", "--numbers").stdout.splitlines()
    assert [line.split()[0] for line in lines] == ["1", "2", "3", "4", "C:"]
    assert "┄" not in call("draw", "parts.json", "--no-signals").stdout
    assert call("draw", "parts.json", "--layout", "round").exit_code == 2


@pytest.mark.parametrize("ending", ["json", "graphml"])
def test_what_is_converted_is_read_as_the_same_graph(
    ending: str, call: Call, tmp_path: Path
) -> None:
    target = f"alsd.{ending}"
    assert call("convert", "alsd", "--halfshafts", "-o", target).exit_code == 0
    read = {"json": bg.read_json, "graphml": bg.read_graphml}[ending](tmp_path / target)
    expected = bg.derive(differentials.graph("alsd", halfshafts=True))
    assert bg.derive(read).A == expected.A
    assert call("convert", target, "-o", "again.json").exit_code == 0
    assert bg.derive(bg.read_json(tmp_path / "again.json")).B == expected.B


def test_switches_stay_what_they_are(call: Call, tmp_path: Path) -> None:
    assert call("convert", "examples/rectifier.json", "-o", "whole.json").exit_code == 0
    assert [one.name for one in bg.switches(bg.read_json(tmp_path / "whole.json"))] == ["d"]
