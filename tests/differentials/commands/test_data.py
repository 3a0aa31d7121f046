"""Data on the command line: columns of files as inputs wherever inputs are taken, and runs as files."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import Result
from scipy.interpolate import PchipInterpolator
from scipy.io import loadmat

import bondgraph as bg
from codegen import Sampled
from differentials.commands.signals import signal

Call = Callable[..., Result]
OSCILLATOR = ("examples/oscillator.json", "--set", "m=2", "--set", "b=4")


@pytest.fixture
def cycle(tmp_path: Path) -> Path:
    """A force in a file: 0 N, from 0.5 s on 10 N."""
    path = tmp_path / "cycle.csv"
    path.write_text("t,F\n0,0\n0.5,10\n2,10\n")
    return path


@pytest.mark.parametrize("kind", ["linear", "held", "pchip"])
def test_two_columns_of_a_file_are_a_signal(kind: str, cycle: Path) -> None:
    expected = Sampled([0, 0.5, 2], [0, 10, 10], kind)
    assert signal(f"@{cycle}:t,F:{kind}") == expected
    assert signal(f" @{cycle} : 1, 2 : {kind} ".strip()) == expected
    assert signal(f"@{cycle}:t,F") == Sampled([0, 0.5, 2], [0, 10, 10])


def test_simulate_runs_under_them(call: Call, cycle: Path, tmp_path: Path) -> None:
    """Held from 0.5 s on they are a step, which a signal says as well."""
    arguments = ("simulate", *OSCILLATOR, "--set", "k=800", "--until", "2")
    assert call(*arguments, "--input", "F=@cycle.csv:t,F:held", "-o", "a.csv").exit_code == 0
    assert call(*arguments, "--input", "F=step(0.5, 10)", "-o", "b.csv").exit_code == 0
    found, expected = (
        np.genfromtxt(tmp_path / name, delimiter=",", names=True) for name in ("a.csv", "b.csv")
    )
    assert found["v"] == pytest.approx(expected["v"], abs=1e-12)
    assert abs(expected["v"]).max() > 0.1


def test_the_catalogs_differentials_take_them(call: Call, tmp_path: Path) -> None:
    (tmp_path / "torque.csv").write_text("0,0\n0.1,350\n1,350\n")
    done = call("simulate", "alsd", "--input", "tau_e=@torque.csv:1,2", "-o", "run.csv")
    assert (done.exit_code, done.stderr) == (0, "")
    found = np.genfromtxt(tmp_path / "run.csv", delimiter=",", names=True)
    assert found["tau_e"] == pytest.approx(np.interp(found["t"], [0, 0.1, 1], [0, 350, 350]))


def test_sweeps_take_them(data: Callable[..., Any], cycle: Path) -> None:
    arguments = (
        *OSCILLATOR,
        "--grid",
        "k=200,800",
        "--final",
        "v",
        "--until",
        "2",
        "--workers",
        "0",
    )
    found = data("sweep", *arguments, "--input", "F=@cycle.csv:t,F:held")
    expected = data("sweep", *arguments, "--input", "F=step(0.5, 10)")
    ends = [[run["final_v"] for run in one["runs"]] for one in (found, expected)]
    assert ends[0] == pytest.approx(ends[1], abs=1e-12)


@pytest.mark.parametrize("target", ["python", "c"])
def test_exports_take_them(target: str, call: Call, cycle: Path, tmp_path: Path) -> None:
    cycle.write_text("t,F\n0,0\n0.5,10\n2,13\n")
    arguments = ("export", *OSCILLATOR, "--set", "k=800", "--to", target)
    done = call(*arguments, "--input", "F=@cycle.csv:t,F:pchip")
    assert (done.exit_code, done.stderr) == (0, "")
    files = [path for path in (tmp_path / "out").rglob("*.*") if path.is_file()]
    text = "".join(path.read_text("utf-8") for path in files)
    for factor in PchipInterpolator([0, 0.5, 2], [0, 10, 13]).c.ravel().tolist():
        assert repr(factor) in text


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("@cycle.csv", r"'@cycle.csv' is not @FILE:TIME,VALUE\[:linear\|held\|pchip\], as in"),
        ("@cycle.csv:t", r"is not @FILE:TIME,VALUE"),
        ("@cycle.csv:t,F + step(0, 1)", r"has no column 'F \+ step\(0'|is not @FILE"),
        ("@cycle.csv:t,F:hold", r"kind='hold' \(did you mean 'held'\?\)"),
        ("@cycle.csv:t,G", r"cycle\.csv has no column 'G'"),
        ("@none.csv:t,F", r"none\.csv cannot be read: No such file"),
        ("@cycle.xls:t,F", r"must end in \.csv"),
    ],
)
def test_what_is_no_data_is_refused(
    text: str, told: str, cycle: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(cycle.parent)
    with pytest.raises(bg.SignalError, match=told):
        signal(text)


def test_a_refusal_is_one_line_with_file_line_and_column(call: Call, cycle: Path) -> None:
    cycle.write_text("t,F\n0,0\n1,x\n")
    done = call("simulate", *OSCILLATOR, "--set", "k=800", "--input", "F=@cycle.csv:t,F")
    assert done.exit_code == 2
    assert "F: cycle.csv, line 3, column 'F': 'x' is not a number" in done.stderr
    assert len(done.stderr.splitlines()) == 1


@pytest.mark.parametrize("ending", ["mat", "parquet"])
def test_runs_and_sweeps_are_written_as_other_files(
    ending: str, call: Call, tmp_path: Path
) -> None:
    if ending == "parquet":
        pytest.importorskip("pyarrow")
    run = ("simulate", *OSCILLATOR, "--set", "k=800", "--initial", "v=1", "--input", "F=0")
    assert call(*run, "-o", f"run.{ending}").exit_code == 0
    assert call(*run, "-o", "run.csv").exit_code == 0
    expected = np.genfromtxt(tmp_path / "run.csv", delimiter=",", names=True)
    found = _read(tmp_path / f"run.{ending}")
    assert np.array_equal(found["v"], expected["v"])
    many = ("sweep", *OSCILLATOR, "--grid", "k=200,800", "--initial", "v=1", "--input", "F=0",
            "--peak", "F_k", "--workers", "0")  # fmt: skip
    assert call(*many, "-o", f"sweep.{ending}").exit_code == 0
    table = _read(tmp_path / f"sweep.{ending}")
    assert [*table["k"]] == [200.0, 800.0]


def _read(path: Path) -> Any:
    if path.suffix == ".mat":
        return loadmat(path, squeeze_me=True)
    return pytest.importorskip("pyarrow.parquet").read_table(path).to_pydict()
