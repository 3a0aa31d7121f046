"""Graphs as pictures and as files."""

from collections.abc import Callable
from pathlib import Path

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
