"""Files with switches go through the same commands as all others."""

import json
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import networkx as nx
import numpy as np
import pytest
from click.testing import Result

import bondgraph as bg

Call = Callable[..., Result]
Data = Callable[..., Any]

needs_compiler = pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")
RECTIFIER = ("--set", "R_s=1", "--set", "C=1e-3", "--set", "R_l=100", "--input", "u=sine(10, 50)")
WINDOW = ("--until", "0.03", "--sample", "1e-4")


@pytest.fixture
def dog(call: Call) -> str:
    """Two inertias of 1 and 3 that a dog joins while the input ``gate`` is positive."""
    g: nx.DiGraph[Any] = nx.DiGraph()
    g.add_nodes_from(
        [bg.One("a"), bg.I("m_1", 1, flow="v_1"), bg.Zero("gap"), bg.Sw("dog", on="-gate"),
         bg.One("b"), bg.I("m_2", 3, flow="v_2"), bg.R("air", "d")]
    )  # fmt: skip
    nx.add_path(g, ["a", "gap", "b", "m_2"])
    g.add_edges_from([("a", "m_1"), ("gap", "dog"), ("b", "air")])
    bg.write_json(g, "dog.json")
    return "dog.json"


@needs_compiler
def test_c_runs_switches_as_numpy_does(data: Data) -> None:
    found = {
        backend: data("simulate", "examples/rectifier.json", *RECTIFIER, *WINDOW, "-o", "run.csv",
                      "--backend", backend)
        for backend in ("numpy", "c")
    }  # fmt: skip
    events = [(e["port"], e["kind"]) for e in found["c"]["events"]]
    assert events == [("d", "off"), ("d", "on"), ("d", "off")]
    times = [[e["time"] for e in found[backend]["events"]] for backend in ("numpy", "c")]
    assert times[1] == pytest.approx(times[0], abs=1e-9)
    assert found["c"]["final"] == pytest.approx(found["numpy"]["final"], abs=1e-8)


@pytest.mark.parametrize(
    ("on", "kinds", "speeds"), [(("--on", "dog"), ["off"], [4.0, 0.0]), ((), [], [1.0, 1.0])]
)
def test_a_run_begins_with_the_switches_that_are_on(
    dog: str, call: Call, tmp_path: Path, on: tuple[str, ...], kinds: list[str], speeds: list[float]
) -> None:
    """A gate of zero leaves the dog as it is: open until 1 s, or closed, and 4 rad/s shared by 1 and 3.

    That it stays open is told, as a gate of 0 and 1 would not be meant so.
    """
    gate = ("--set", "d=0", "--input", "gate=step(1, 1)", "--until", "2", "-o", "run.csv", "--json")
    done = call("simulate", dog, *gate, *on, "--initial", "v_1=4", "--initial", "v_2=0")
    told = "warning: switch 'dog' stays on while its command -gate rests at zero, from t = 0 on"
    assert (told in done.stderr) == bool(on)
    found = json.loads(done.stdout)
    assert [(e["port"], e["kind"]) for e in found["events"]] == [("dog", kind) for kind in kinds]
    assert [found["final"][v] for v in ("v_1", "v_2")] == pytest.approx([1.0, 1.0], abs=1e-9)
    run = np.genfromtxt(tmp_path / "run.csv", delimiter=",", names=True)
    assert [run[v][0] for v in ("v_1", "v_2")] == pytest.approx(speeds, abs=1e-9)
    assert run["dog"][[0, -1]].tolist() == [float(bool(on)), 0.0]


def test_a_file_is_swept_over_numbers_and_a_switch_measured(dog: str, data: Data) -> None:
    """Joined from 1 s on, both slow down with d/4: v = 1 exp(-d (t - 1)/4)."""
    found = data(
        "sweep", dog, "--grid", "d=0.5,1", "--on", "dog", "--initial", "v_1=4", "--initial", "v_2=0",
        "--input", "gate=step(1, 1, -1)", "--until", "2", "--final", "v_2", "--final", "dog",
        "--first", "dog:off", "--workers", "0",
    )  # fmt: skip
    for run in found["runs"]:
        assert run["final_v_2"] == pytest.approx(np.exp(-run["d"] / 4), abs=1e-9)
        assert run["first_dog_off"] == pytest.approx(1.0, abs=1e-9)
        assert run["final_dog"] == 0


def test_events_are_those_that_the_port_has(dog: str, call: Call) -> None:
    asked = ("sweep", dog, "--grid", "d=1,2", "--input", "gate=1", "--workers", "0")
    done = call(*asked, "--first", "dog:stick")
    assert done.exit_code == 2
    assert "no kind of event is called 'stick'; there is on, off" in done.stderr
    done = call(*asked, "--first", "cat:on")
    assert "no friction port or switch is called 'cat'" in done.stderr


def test_a_switch_that_there_is_not_is_refused(dog: str, call: Call) -> None:
    for command in (("simulate", dog), ("export", dog, "--to", "c"), ("simulate", "alsd")):
        done = call(*command, "--on", "cat")
        assert done.exit_code == 2
        there = (
            "alsd has no switches"
            if "alsd" in command
            else "no switch is called 'cat'; there is dog"
        )
        assert there in done.stderr


STAYS = ("--set", "d=0", "--input", "gate=step(1, 1)", "--initial", "v_1=4", "--initial", "v_2=0")
"""A gate of zero up to 1 s leaves the dog as it begins."""


@pytest.mark.parametrize(
    ("on", "speeds"), [(("--on", "dog"), (4.0, 0.0)), ((), (1.0, 1.0))], ids=["on", "off"]
)
def test_exports_begin_with_the_switches_that_are_on(
    dog: str, call: Call, tmp_path: Path, on: tuple[str, ...], speeds: tuple[float, float]
) -> None:
    """The exported script, and the exported C if there is a compiler, from its first line to its last."""
    window = ("--until", "0.05", "--sample", "0.01")
    assert call("export", dog, "--to", "python", *STAYS, *window, *on).exit_code == 0
    script = [sys.executable, "run_dog.py"]
    subprocess.run(script, cwd=tmp_path / "out", check=True, capture_output=True)
    found = np.genfromtxt(tmp_path / "out" / "dog.csv", delimiter=",", names=True)
    assert [found[v][-1] for v in ("v_1", "v_2")] == pytest.approx(speeds, abs=1e-9)
    if shutil.which("cc") is None:
        return
    assert call("export", dog, "--to", "c", *STAYS, *on).exit_code == 0
    sources = [str(path) for path in (tmp_path / "out" / "dog").glob("*.c")]
    program = str(tmp_path / "program")
    subprocess.run(["cc", "-std=c99", *sources, "-lm", "-o", program], check=True)
    done = subprocess.run([program, "0.05", "0.01"], check=True, capture_output=True, text=True)
    header, *rows = done.stdout.splitlines()
    last = dict(zip(header.removeprefix("# ").split(","), rows[-1].split(","), strict=True))
    assert [float(last[v]) for v in ("v_1", "v_2")] == pytest.approx(speeds, abs=1e-9)


@needs_compiler
@pytest.mark.slow
def test_a_unit_begins_with_the_switches_that_are_on(dog: str, call: Call, tmp_path: Path) -> None:
    assert call("export", dog, "--to", "fmu3", *STAYS, "--on", "dog").exit_code == 0
    assert (tmp_path / "out" / "dog.fmu").stat().st_size > 0


def test_a_start_that_was_completed_is_told_in_one_line_and_once(dog: str, call: Call) -> None:
    """Closed from the start, the dog carries the second mass along, whose speed nobody named."""
    given = (
        "--set",
        "d=0",
        "--input",
        "gate=1",
        "--until",
        "1",
        "--initial",
        "v_1=4",
        "--on",
        "dog",
    )
    done = call("simulate", dog, *given, "-o", "run.csv")
    assert done.exit_code == 0
    [line] = done.stderr.splitlines()
    assert line.startswith(
        "bondgraph simulate: warning: states that initial does not name follow what "
    )
    assert "v_2 = 4;" in line
    silent = subprocess.run(
        [sys.executable, "-W", "ignore", "-m", "differentials", "simulate", dog, *given, "-o", "run.csv"],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert silent.stderr == ""


@pytest.mark.parametrize(
    "words",
    [
        ("export", "dog.json", "--to", "python"),
        ("export", "dog.json", "--to", "c"),
        (
            "sweep",
            "dog.json",
            "--grid",
            "d=0:1:2",
            "--final",
            "v_1",
            "--workers",
            "0",
            "-o",
            "out.csv",
        ),
    ],
    ids=["python", "c", "sweep"],
)
def test_a_command_that_rests_at_zero_is_told_in_one_line_and_once(
    words: tuple[str, ...], dog: str, call: Call
) -> None:
    """A gate of -1 turns the dog on at once, and from 1 s on it is zero."""
    free = () if words[0] == "sweep" else ("--set", "d=0")
    done = call(
        *words, *free, "--input", "gate=step(1, 0, -1)", "--until", "2", "--initial", "v_1=4"
    )
    assert done.exit_code == 0, done.stderr
    lines = [line for line in done.stderr.splitlines() if "warning" in line]
    told = [line for line in lines if "switch 'dog' stays on while its command -gate rests" in line]
    assert len(told) == 1
    assert "from t = 1 on" in told[0]
