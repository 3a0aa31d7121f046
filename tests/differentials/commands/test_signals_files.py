"""Commands on files with functions, states, controllers and wires."""

import csv
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

import bondgraph as bg

Call = Callable[..., Result]


@pytest.fixture(params=["json", "graphml"])
def file(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    """A sampled speed loop by wires, with a bounded state."""
    graph = bg.graph(
        [
            bg.Se("motor"), bg.One("shaft"), bg.I("J", "J", flow="omega"), bg.R("b", "b"), bg.Df("tacho"),
            bg.State("ref", "a", high=3), bg.Function("error", "ref - y", ports=["y"]),
            bg.Controller("pi", every="1/20", ports=["e"], states={"z": 0}, update={"z": "z + e/10"},
                          gives={"tau": "2*e + z"}),
        ],
        "motor > shaft > J, shaft > b, shaft > tacho", "tacho > error > pi > motor",
    )  # fmt: skip
    name = f"loop.{request.param}"
    (bg.write_json if request.param == "json" else bg.write_graphml)(graph, tmp_path / name)
    return name


def test_every_command_reads_them(call: Call, file: str, tmp_path: Path) -> None:
    derived = call("derive", file)
    assert (derived.exit_code, derived.stderr) == (0, "")
    assert "pi: every 1/20 s z becomes" in derived.stdout
    assert call("check", file).stdout.strip() == "nothing found"
    shown = call("draw", file).stdout
    assert "Df: tacho         ┄┄→   Function: error  ω" in shown
    assert call("draw", file, "-o", "loop.svg").exit_code == 0
    assert (tmp_path / "loop.svg").read_text(encoding="utf-8").count('rx="2"') == 3
    assert "2. Signals, which carry no power" in call("explain", file).stdout


def test_simulate_runs_them(call: Call, file: str, tmp_path: Path) -> None:
    """The reference rises by 4 a second up to 3; the torque is twice the error at first, and held."""
    numbers = [word for name in ("J=0.5", "b=0.2", "a=4") for word in ("--set", name)]
    done = call("simulate", file, "--until", "1", "--sample", "0.01", "-o", "loop.csv", *numbers)
    assert (done.exit_code, done.stderr) == (0, "")
    with (tmp_path / "loop.csv").open(encoding="utf-8") as table:
        rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(table)]
    assert [round(rows[at]["ref"], 9) for at in (25, 75, 100)] == [1.0, 3.0, 3.0]
    assert {row["tau"] for row in rows[5:10]} == {rows[5]["tau"]}
    assert rows[5]["tau"] == pytest.approx(2 * 0.2)
