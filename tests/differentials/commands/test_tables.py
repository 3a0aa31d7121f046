"""`--table`: what files and laws may call."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result
from references.build import bond_graph

import bondgraph as bg
import codegen

Call = Callable[..., Result]

drag = bg.LookupTable("drag", [0, 1, 4], [0, 2, 8], method="pchip", outside="extend")


@pytest.fixture
def model(tmp_path: Path) -> Path:
    """A mass in a file that calls a table which it does not have, and the table beside it."""
    nodes = [bg.Se("push", "F"), bg.One("n"), bg.I("m", "m", flow="v"), bg.R("r", law="b*drag(v)")]
    graph = bond_graph(nodes, "push>n>m n>r")
    graph.graph["tables"] = [drag]
    text = bg.to_json(graph)
    begin = text.index('"graph"')
    path = tmp_path / "mass.json"
    path.write_text(text[:begin] + text[text.index('"nodes"') :])
    (tmp_path / "drag.csv").write_text("v,F\n0,0\n1,2\n4,8\n")
    return path


RUN = ("--set", "m=2", "--set", "b=1.5", "--input", "F=7", "--until", "1", "--sample", "0.25",
       "-o", "run.csv")  # fmt: skip
TABLE = ("--table", "drag=drag.csv,method=pchip,outside=extend")


def test_a_file_calls_the_table_that_it_is_given(call: Call, model: Path, tmp_path: Path) -> None:
    assert call("simulate", str(model), *TABLE, *RUN).exit_code == 0
    found = np.genfromtxt(tmp_path / "run.csv", delimiter=",", names=True)
    graph = bg.read_json(model, [drag])
    ready = codegen.simulator(bg.derive(graph), {"m": 2, "b": 1.5})
    right = ready.run(found["t"], inputs={"F": 7})
    assert found["v"] == pytest.approx(right["v"], rel=1e-9)


def test_laws_of_the_command_line_call_it(call: Call, model: Path, tmp_path: Path) -> None:
    columns = []
    for law in ("r=2*drag(v)", "r=friction(drag(F)/4, 1 + drag(slip))"):
        assert call("simulate", str(model), *TABLE, *RUN, "--law", law).exit_code == 0
        columns.append(np.genfromtxt(tmp_path / "run.csv", delimiter=",", names=True)["v"])
    # 2 v' = 7 - 4 v, as the table is a line; and 7 - 3.5 (1 + 2 v).
    t = np.linspace(0, 1, 5)
    assert columns[0] == pytest.approx(7 / 4 * -np.expm1(-2 * t), rel=1e-6)
    assert columns[1] == pytest.approx(3.5 / 7 * -np.expm1(-3.5 * t), rel=1e-6)


def test_files_that_are_written_have_the_table(call: Call, model: Path, tmp_path: Path) -> None:
    assert call("convert", str(model), *TABLE, "-o", "kept.graphml").exit_code == 0
    assert bg.read_graphml(tmp_path / "kept.graphml").graph["tables"] == [drag]
    assert call("export", str(model), *TABLE, "--to", "c", *RUN[:4], "--out", "c").exit_code == 0
    assert call("derive", str(model), *TABLE).exit_code == 0


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ("drag", "'drag' is not NAME=FILE"),
        ("drag=none.csv", "none.csv"),
        ("drag=drag.csv,cubic", "'cubic' is neither method=... nor outside=... there"),
        ("drag=drag.csv,method=cubic", "method='cubic'; over one axis there are linear, pchip, akima"),
        ("grad=drag.csv", "'drag' is not a function an expression may use"),
    ],
)  # fmt: skip
def test_what_is_no_table_is_refused_in_a_line(
    call: Call, model: Path, given: str, says: str
) -> None:
    done = call("simulate", str(model), "--table", given, *RUN)
    assert done.exit_code != 0
    assert says in done.stderr
    assert done.stderr.count("\n") <= 2


def test_a_malformed_file_is_refused_by_line(call: Call, model: Path, tmp_path: Path) -> None:
    (tmp_path / "drag.csv").write_text("v,F\n0,0\n1,\n")
    done = call("simulate", str(model), *TABLE, *RUN)
    assert (done.exit_code, done.stdout) == (2, "")
    assert "table 'drag', drag.csv, line 3: an empty cell" in done.stderr


def test_a_name_given_twice_is_refused(call: Call, model: Path) -> None:
    done = call("simulate", str(model), *TABLE, *TABLE, *RUN)
    assert done.exit_code == 2
    assert "drag is given twice; keep one" in done.stderr
