"""Closed loops outside the toolkit: a unit run by FMPy and a program in C, against runs in numpy."""

import subprocess
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from fmpy import simulate_fmu

import codegen
import differentials
from differentials.exporting import export

LOOPS = [("alsd", "ice"), ("superposition_tvd", "step_steer"), ("four_wheel_drive_tvd", "ice")]

pytestmark = pytest.mark.usefixtures("compiled_quickly")


@cache
def run(name: str, manoeuvre: str) -> codegen.Result:
    return differentials.simulate(name, manoeuvre)


def check(found: codegen.Result, state: str, values: np.ndarray, within: float = 1e-9) -> None:
    """To a part of its range; what stays at rest to the same part of a unit."""
    right = found[state][: len(values)]
    off = np.abs(values - right).max()
    assert off < within * max(float(np.ptp(found[state])), 1.0), f"{state} is off by {off:.1e}"


@pytest.mark.parametrize("version", ["fmu2", "fmu3"])
@pytest.mark.parametrize(("name", "manoeuvre"), LOOPS)
def test_fmpy_runs_the_unit(name: str, manoeuvre: str, version: str, tmp_path: Path) -> None:
    (path,) = export(name, version, manoeuvre, None, tmp_path)
    right = run(name, manoeuvre)
    for kind in ("CoSimulation", "ModelExchange"):
        told = simulate_fmu(
            str(path), fmi_type=kind, stop_time=1.5, output_interval=0.001,
            relative_tolerance=1e-13, record_events=False, output=list(right.states),
        )  # fmt: skip
        assert np.abs(told["time"] - right.time).max() < 1e-12
        for state in right.states:
            # An importer's integrator is not exact: CVode of FMPy, over 0.165 kHz for 1.5 s.
            check(right, state, told[state], 1e-9 if kind == "CoSimulation" else 1e-7)


@pytest.mark.parametrize(("name", "manoeuvre"), LOOPS)
def test_the_program_in_c_runs_it(name: str, manoeuvre: str, tmp_path: Path) -> None:
    """Fixed steps of 10 us through the first half second, over 40 instants of the controller.

    They tell to a step when the ALSD's clutch breaks away as the engine pulls; the others' always slip.
    """
    paths = export(name, "c", manoeuvre, None, tmp_path)
    program = tmp_path / "program"
    sources = [str(path) for path in paths if path.suffix == ".c"]
    subprocess.run(["cc", "-std=c99", "-O1", *sources, "-lm", "-o", str(program)], check=True)
    done = subprocess.run([str(program), "0.5", "1e-5"], check=True, capture_output=True, text=True)
    header, *rows = done.stdout.splitlines()
    names = header.removeprefix("# ").split(",")
    table = np.array([[float(entry) for entry in row.split(",")] for row in rows[::100]])
    right = run(name, manoeuvre)
    for state in right.states:
        check(right, state, table[:, names.index(state)], 1e-8 if name == "alsd" else 1e-9)
