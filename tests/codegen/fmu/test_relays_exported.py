"""Relays with known motions as exported C and as units: to 1e-9 of range where events are located."""

import subprocess
from pathlib import Path

import numpy as np
import pytest
from oracles.c_model import compiled, written
from oracles.relays import together
from oracles.swings import Swings
from oracles.units import Case, sampled, simulated

import codegen

CLOSE = 1e-9
"""Of a range of 1 or more."""

END, SAMPLES = 6.0, 13


def known(times: np.ndarray) -> dict[str, np.ndarray]:
    """The states: the pair turns round a square whose side is a third after each quarter."""
    warm = np.minimum(50 - 35 * np.exp(-times / 5), 20.0)
    turned = {"p": np.zeros(len(times)), "q": np.zeros(len(times))}
    return {"T": warm, "x": Swings(2.0, 1.0).at(times), **turned}


def check(found: dict[str, np.ndarray], within: float) -> None:
    """All states at samples of 0.5 s: by the second the pair is at rest."""
    times = np.linspace(0.0, END, SAMPLES)
    for name, values in known(times).items():
        late = times >= 1.0 if name in "pq" else times >= 0.0
        assert np.abs(found[name] - values)[late].max() < within * max(np.ptp(values), 1.0), name


def test_they_are_so_by_numpy() -> None:
    equations, start = together()
    run = codegen.simulator(equations, {}).run(np.linspace(0.0, END, SAMPLES), start)
    check(run, CLOSE)


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The exported C as a user compiles it."""
    equations, start = together()
    folder = tmp_path_factory.mktemp("relays")
    files = codegen.to_c(equations, {}, name="relays", main=True, initial=start)
    return compiled(folder, written(folder, files), "-O0")


def table(program: Path, *how: str) -> dict[str, np.ndarray]:
    told = subprocess.run(
        [program, f"{END!r}", f"{END / (SAMPLES - 1)!r}", *how], capture_output=True, text=True,
        check=True,
    )  # fmt: skip
    head, *rows = told.stdout.splitlines()
    columns = np.array([row.split(",") for row in rows], dtype=float).T
    return dict(zip(head.split(","), columns, strict=True))


def test_exported_c_locates_them(program: Path) -> None:
    check(table(program, "located"), CLOSE)


def test_fixed_steps_of_exported_c_rest_and_are_of_first_order(program: Path) -> None:
    """Jumps are met at ends of steps: what that leaves shrinks with them, and is gone at rest."""
    times, off = np.linspace(0.0, END, SAMPLES), []
    for step in (0.02, 0.005):
        found = table(program, f"step={step!r}")
        off.append(np.abs(found["x"] - known(times)["x"]).max())
        assert np.abs(found["x"][-2:]).max() < 1e-12
        assert np.abs(found["T"] - known(times)["T"]).max() < 10 * step
    assert off[1] < 0.5 * off[0] < 0.5 * 5 * 0.02


def test_a_unit_in_co_simulation_locates_them(tmp_path: Path) -> None:
    equations, start = together()
    case = Case(equations, {}, None, start, {}, END)
    path = case.written(tmp_path / "relays.fmu", "3.0")
    found = simulated(path, "CoSimulation", case, ["T", "x", "p", "q"], SAMPLES)
    check(sampled(found, case, SAMPLES), CLOSE)
