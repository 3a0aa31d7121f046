"""Exported C of models with stops: events located, and fixed steps."""

import subprocess
from pathlib import Path

import numpy as np
import pytest
from oracles.c_model import WARNED, compiled, written
from oracles.exported import loaded
from oracles.stops import Stopped, bounces, dropped, flight, rotor, struck

from codegen import to_c, to_python


def _program(case: Stopped, folder: Path, *flags: str) -> Path:
    """The main program."""
    text = to_c(case.equations, case.numbers, main=True, initial=case.initial, inputs=case.inputs)
    return compiled(folder, written(folder, text), *(flags or ("-O0",)))


def _called(program: Path, *words: object) -> tuple[dict[str, np.ndarray], list[list[str]]]:
    """The columns it prints, and the events."""
    done = subprocess.run([program, *map(str, words)], capture_output=True, text=True, check=True)
    head, *rows = (line.split(",") for line in done.stdout.splitlines())
    table = np.array(rows, dtype=float)
    return dict(zip(head, table.T, strict=True)), [
        line.split(",") for line in done.stderr.splitlines()
    ]


@pytest.fixture(scope="module")
def falling(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return _program(dropped(0.8), tmp_path_factory.mktemp("falling"), *WARNED, "-O1")


def test_located_runs_print_impacts_where_the_closed_form_has_them(falling: Path) -> None:
    found, events = _called(falling, 3, 0.1, "located")
    right = bounces(0.8, 1.0, 100)
    right = right[right < 3]
    assert [(port, kind) for _, port, kind, _ in events] == [("floor", "hit")] * len(right)
    assert [float(time) for time, *_ in events] == pytest.approx(right, abs=1e-12)
    pushed = -3.6 * np.sqrt(2 * 9.81) * 0.8 ** np.arange(len(right))
    assert [float(impulse) for *_, impulse in events] == pytest.approx(pushed, rel=1e-9)
    assert found["q_floor"] == pytest.approx(flight(0.8, 1.0, found["t"]), abs=1e-11)
    assert set(found["floor"]) == {1.0}


def test_what_comes_to_rest_touches(falling: Path) -> None:
    found, events = _called(falling, 6, 0.1, "located", "e=0.5")
    assert events[-1][2] == "touch"
    assert float(events[-1][0]) == pytest.approx(bounces(0.5, 1.0, 200)[-1], abs=1e-5)
    assert (found["q_floor"][-1], found["v"][-1], found["floor"][-1]) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize("restitution", [0.0, 0.8, 1.0])
def test_fixed_steps_come_to_the_closed_form(falling: Path, restitution: float) -> None:
    """With ever shorter steps; never below the floor, where all of it is rest in the end."""
    errors = []
    for step in (0.01, 0.001, 0.0001):
        found, _ = _called(falling, 3, 0.01, f"step={step}", f"e={restitution}")
        right = np.zeros(len(found["t"]))
        before = found["t"] < (4.0 if restitution else bounces(0.0, 1.0, 1)[0])
        right[before] = flight(restitution or 1.0, 1.0, found["t"][before])
        errors.append(np.abs(found["q_floor"] - right).max())
        assert found["q_floor"].min() >= 0.0
    assert errors[2] < 2e-3
    assert errors[2] <= max(errors[1] / 2, 1e-9)
    resting, _ = _called(falling, 6, 0.01, "step=0.001", "e=0.5")
    later = resting["t"] > 3
    assert not resting["q_floor"][later].any()
    assert not resting["v"][later].any()
    assert not resting["floor"][later].any()


def test_fixed_steps_pass_a_row_of_balls_on_in_one(tmp_path: Path) -> None:
    found, _ = _called(_program(struck(5, 2), tmp_path), 1, 0.01)
    assert [found[f"v{i}"][-1] for i in range(5)] == [0.0, 0.0, 0.0, 1.0, 1.0]


def test_fixed_steps_beside_dry_friction(tmp_path: Path) -> None:
    case = rotor()
    expected = case.run("numpy")
    found, _ = _called(_program(case, tmp_path), 3, case.times[1], "step=1e-4")
    for name in expected.states:
        assert found[name][:32] == pytest.approx(expected[name], abs=2e-3), name


STEPPED = {
    "plastic": (lambda: dropped(0.0), 3.0), "bouncing": (lambda: dropped(0.8), 3.0),
    "elastic": (lambda: dropped(1.0), 3.0), "a row": (lambda: struck(4, 2, "1/2"), 1.0),
    "friction": (rotor, 2.0),
}  # fmt: skip


@pytest.mark.parametrize("name", STEPPED)
def test_fixed_steps_are_those_of_exported_python(name: str, tmp_path: Path) -> None:
    """Each step meets the same stops: every sample to rounding."""
    make, end = STEPPED[name]
    case = make()
    found, _ = _called(_program(case, tmp_path), end, end / 50, f"step={end / 500!r}")
    module = loaded(to_python(case.equations, case.numbers, name="stepped"))
    other = module.simulate(np.linspace(0, end, 51), case.initial, case.inputs, step=end / 500)
    for state in map(str, case.equations.states):
        assert found[state] == pytest.approx(other[state], abs=1e-9), state


@pytest.mark.parametrize("words", [["located"], []])
def test_a_start_beyond_a_bound_is_refused_by_name(falling: Path, words: list[str]) -> None:
    done = subprocess.run([falling, "1", "0.1", *words, "q_floor=-0.1"],
                          capture_output=True, text=True, check=False)  # fmt: skip
    assert done.returncode == 1
    assert (
        done.stderr
        == "model: stop floor: a stop begins beyond its bound; start its displacement within\n"
    )
