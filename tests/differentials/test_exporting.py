"""Exports of differentials in their scenarios, run without the toolkit."""

import shutil
import subprocess
import sys
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import bondgraph as bg
import differentials
from differentials.exporting import export


def test_the_exported_python_runs_its_scenario(tmp_path: Path) -> None:
    """Fig. 11 with steps that come soon: the clutch sticks at 0.101 s, and slips again at 0.169 s."""
    soon = replace(
        differentials.scenarios["fig11"], engine_step=0.02, clutch_step=0.1, duration=0.2
    )
    paths = export("alsd", "python", soon, {"I_1": 0.009}, tmp_path)
    assert [path.name for path in paths] == ["alsd.py", "run_alsd.py"]
    subprocess.run([sys.executable, "run_alsd.py"], cwd=tmp_path, check=True, capture_output=True)
    header, *rows = (tmp_path / "alsd.csv").read_text(encoding="utf-8").splitlines()
    table = np.array([[float(entry) for entry in row.split(",")] for row in rows])
    expected = differentials.simulate("alsd", soon, {"I_1": 0.009})
    assert [event.kind for event in expected.events] == ["stick", "slip"]
    for at, name in enumerate(header.removeprefix("# ").split(",")):
        if name in expected.states:
            error = np.abs(table[:, at] - expected[name]).max()
            assert error <= 5e-4 * np.ptp(expected[name]), name


@pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")
def test_the_exported_c_builds_and_runs(tmp_path: Path) -> None:
    paths = export("alsd", "c", "fig11", None, tmp_path)
    sources = [str(path) for path in paths if path.suffix == ".c"]
    program = tmp_path / "program"
    command = ["cc", "-std=c99", "-Wall", "-Wextra", "-Werror", *sources, "-lm", "-o", str(program)]
    subprocess.run(command, check=True)
    done = subprocess.run(
        [str(program), "0.01", "0.001"], check=True, capture_output=True, text=True
    )
    assert len(done.stdout.splitlines()) == 12


@pytest.mark.parametrize("target", ["fmu2", "fmu3"])
def test_the_exported_unit_has_its_sources_inside(target: str, tmp_path: Path) -> None:
    (path,) = export("alsd", target, "fig11", None, tmp_path)
    with zipfile.ZipFile(path) as unit:
        names = unit.namelist()
        text = unit.read("modelDescription.xml").decode()
    assert any(name.startswith("binaries/") for name in names)
    assert f'fmiVersion="{target[-1]}.0"' in text
    assert 'causality="input"' not in text


def test_unknown_targets_are_refused(tmp_path: Path) -> None:
    with pytest.raises(bg.SignalError, match="there are python, c, fmu2, fmu3"):
        export("alsd", "fortran", "fig11", None, tmp_path)
