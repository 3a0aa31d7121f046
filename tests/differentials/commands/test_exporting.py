"""Exports of catalog and file that run as the toolkit runs them."""

import os
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result

Call = Callable[..., Result]

OSCILLATOR = (
    "export",
    "examples/oscillator.json",
    "--set",
    "m=2",
    "--set",
    "k=800",
    "--set",
    "b=0",
)


def test_the_command_says_how_to_go_on(call: Call, tmp_path: Path) -> None:
    done = call("export", "alsd", "--to", "python", "--scenario", "fig11", "--set", "I_1=0.008")
    assert done.exit_code == 0
    assert done.stdout.splitlines()[:2] == ["out/alsd.py", "out/run_alsd.py"]
    assert done.stdout.endswith("Next: cd out && python run_alsd.py\n")
    assert "0.008" in (tmp_path / "out" / "alsd.py").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    "signal", ["lag(step(0.1, 10), 0.05)", "ramp(0.1, 5)", "2 + sine(3, 1)", "step(0.1, 3, 1)", "4"]
)
def test_the_exported_script_runs_under_any_signal(signal: str, call: Call, tmp_path: Path) -> None:
    arguments = [
        "--initial",
        "v=1",
        "--input",
        f"F={signal}",
        "--until",
        "0.15",
        "--sample",
        "0.001",
    ]
    assert call(*OSCILLATOR, "--to", "python", *arguments).exit_code == 0
    script = [sys.executable, "run_oscillator.py"]
    subprocess.run(script, cwd=tmp_path / "out", check=True, capture_output=True)
    found = np.genfromtxt(tmp_path / "out" / "oscillator.csv", delimiter=",", names=True)
    run = ["simulate", *OSCILLATOR[1:], *arguments, "-o", "run.csv"]
    assert call(*run).exit_code == 0
    expected = np.genfromtxt(tmp_path / "run.csv", delimiter=",", names=True)
    assert found["t"] == pytest.approx(expected["t"], abs=1e-12)
    # A step inside a fixed step of 1e-4 s is seen up to one step late.
    assert found["F_k"] == pytest.approx(expected["F_k"], abs=5e-3 * np.ptp(expected["F_k"]))


@pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")
def test_the_exported_c_of_a_file_swings_as_the_textbook_says(call: Call, tmp_path: Path) -> None:
    assert call(*OSCILLATOR, "--to", "c", "--initial", "v=1").exit_code == 0
    sources = [str(path) for path in (tmp_path / "out" / "oscillator").glob("*.c")]
    program = str(tmp_path / "program")
    subprocess.run(["cc", "-std=c99", *sources, "-lm", "-o", program], check=True)
    done = subprocess.run([program, "0.5", "0.001"], check=True, capture_output=True, text=True)
    header, *rows = done.stdout.splitlines()
    found = np.array([[float(entry) for entry in row.split(",")] for row in rows])
    at = header.removeprefix("# ").split(",").index("v")
    assert found[:, at] == pytest.approx(np.cos(20 * found[:, 0]), abs=1e-5)


def test_a_unit_of_a_file_has_its_inputs_inside(call: Call, tmp_path: Path) -> None:
    done = call(*OSCILLATOR, "--to", "fmu3", "--input", "F=sine(1, 2)")
    assert done.exit_code == 0, done.output
    with zipfile.ZipFile(tmp_path / "out" / "oscillator.fmu") as unit:
        assert 'fmiVersion="3.0"' in unit.read("modelDescription.xml").decode()


HARD = (
    "class",
    "numpy",
    "Numpy",
    "math",
    "simulate",
    "random",
    "print",
    "１ﬁ τ",
    "a b",
    "2nd",
    "_",
)
"""Names that Python knows, that hide what numpy imports, or that are no identifiers."""


def _copied(name: str, folder: Path) -> str:
    path = folder / f"{name}.json"
    shutil.copy("examples/oscillator.json", path)
    return str(path)


@pytest.mark.parametrize("name", HARD)
def test_the_next_line_runs_under_any_name(name: str, call: Call, tmp_path: Path) -> None:
    """Without an input on the command line, which is then zero in the script."""
    path = _copied(name, tmp_path)
    out = tmp_path / "the folder"
    done = call(
        "export", path, *OSCILLATOR[2:], "--initial", "v=1", "--to", "python", "--out", str(out),
        "--until", "0.02", "--sample", "0.001",
    )  # fmt: skip
    assert done.exit_code == 0, done.output
    following = done.stdout.rpartition("Next: ")[2].strip()
    text = next(out.glob("run_*.py")).read_text(encoding="utf-8")
    assert (
        '    "F": 0.0,  # nothing was given: a constant, or a function of time, to change' in text
    )
    folder = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
    ran = subprocess.run(
        following, shell=True, cwd=tmp_path, env={**os.environ, "PATH": folder},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert ran.returncode == 0, ran.stderr
    (table,) = out.glob("*.csv")
    found = np.genfromtxt(table, delimiter=",", names=True)
    assert found["v"] == pytest.approx(np.cos(20 * found["t"]), abs=1e-6)


@pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")
@pytest.mark.parametrize("name", ["class", "a b"])
def test_the_next_line_of_c_compiles_under_any_name(name: str, call: Call, tmp_path: Path) -> None:
    path = _copied(name, tmp_path)
    done = call("export", path, *OSCILLATOR[2:], "--to", "c", "--out", str(tmp_path / "the folder"))
    assert done.exit_code == 0, done.output
    following = done.stdout.rpartition("Next: ")[2].strip()
    subprocess.run(following.replace("-O2", "-O0"), shell=True, cwd=tmp_path, check=True)
    assert next(tmp_path.glob("run_*")).is_file()


@pytest.mark.parametrize(
    ("target", "file"), [("python", "oscillator.py"), ("c", "oscillator/config.h")]
)
def test_steps_are_implicit_where_they_are_asked_for(
    target: str, file: str, call: Call, tmp_path: Path
) -> None:
    texts = []
    for more in ((), ("--integrator", "rosenbrock")):
        assert call(*OSCILLATOR, "--to", target, *more).exit_code == 0
        texts.append((tmp_path / "out" / file).read_text(encoding="utf-8").lower())
    assert texts[0] != texts[1]
    assert "rosenbrock" in texts[1]
    done = call(*OSCILLATOR, "--to", target, "--integrator", "rosenbrok")
    assert done.exit_code == 2
    assert "did you mean 'rosenbrock'?" in done.stderr
