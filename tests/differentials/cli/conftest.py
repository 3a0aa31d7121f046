"""How tests of the command line call it, and what they share."""

import json
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from click.testing import CliRunner, Result

import bondgraph as bg
import codegen
from differentials.cli.app import app

EXAMPLES = Path(__file__).parents[3] / "examples"

Call = Callable[..., Result]


@pytest.fixture(autouse=True)
def _stand_ins(monkeypatch: pytest.MonkeyPatch) -> None:
    """STAND-INS for drawings, explanations, panels and netCDF where the packages lack them.

    Each does the least that the commands rely on; where the real one exists, it is what is tested.
    """

    def file(path: Path) -> None:
        Path(path).write_bytes(b"<svg" if str(path).endswith("svg") else b"\x89PNG CDF %PDF")

    def text(graph: Any) -> str:
        return "\n".join(map(str, graph.graph if isinstance(graph, bg.CausalGraph) else graph))

    if not hasattr(bg, "drawing"):
        make = lambda graph, **_: SimpleNamespace(save=file, text=lambda: text(graph))  # noqa: E731
        monkeypatch.setattr(bg, "drawing", make, raising=False)
    if not hasattr(bg, "explain"):
        told = lambda graph: SimpleNamespace(text=lambda: text(graph), latex=lambda: "\\frac")  # noqa: E731
        monkeypatch.setattr(bg, "explain", told, raising=False)
    if not hasattr(codegen, "panels"):
        drawn = lambda *_, **__: SimpleNamespace(savefig=lambda path, **_: file(path))  # noqa: E731
        monkeypatch.setattr(codegen, "panels", drawn, raising=False)
    if not hasattr(codegen.Result, "write_netcdf"):
        monkeypatch.setattr(codegen.Result, "write_netcdf", lambda _, to: file(to), raising=False)


@pytest.fixture
def call(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Call:
    """Runs a command in an empty folder that has the example graphs beside it."""
    (tmp_path / "examples").symlink_to(EXAMPLES)
    monkeypatch.chdir(tmp_path)

    def called(*arguments: str) -> Result:
        return CliRunner().invoke(app, arguments, catch_exceptions=False)

    return called


@pytest.fixture
def data(call: Call) -> Callable[..., Any]:
    """Runs a command with ``--json`` that must succeed, and gives what it printed."""

    def read(*arguments: str) -> Any:
        done = call(*arguments, "--json")
        assert (done.exit_code, done.stderr) == (0, ""), done.output
        return json.loads(done.stdout)

    return read
