"""Sampled tasks in exported C: steps are cut at exact instants, or the caller runs the tasks."""

import subprocess
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from oracles import ticked
from oracles.c_model import WARNED, CModel, Pair, compiled, written
from oracles.ticked import END, EVERY, LATE, REF, UNIT, case, check, segments

from codegen import simulator, to_c
from codegen.c.bounded import findings
from codegen.engine.status import Status


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory) -> Pair:
    loop = case()
    return Pair(tmp_path_factory.mktemp("loop"), loop.equations, loop.parameters, level="-O1")


def _steps(model: CModel, h: float, count: int, ref: float = 2.0) -> dict[str, np.ndarray]:
    """Steps by `bg_model_step`, and what the task of the last instant set."""
    names = [*model.program.states, *model.program.law_states]
    s, rows, w = model.vector(0.0, [0.0] * len(names), [ref]), [], np.full((3, 1), ref)
    for k in range(count):
        rows.append(s)
        status, s = model.step(k * h, h, s, w)
        assert status == 0, model.message(status)
    found = dict(zip(map(str, names), np.array([*rows, s]).T, strict=True))
    return {"t": np.arange(count + 1) * h, **found}


def test_steps_that_cross_instants_are_cut_there(pair: Pair) -> None:
    """Of 0.27 ms, so that no instant but one in a hundred is at a start."""
    h = 0.00027
    run = _steps(pair.at(case().parameters).c, h, 1200)
    early = run["t"] + 1e-9 < 0.33
    right = segments(run["t"])
    for name in ("i", "omega"):
        off = np.abs(run[name] - right[name])[early].max()
        assert off < 1e-9 * np.ptp(right[name][early]), name
    # What is due at the end of a step is set by the next.
    between = (
        np.abs(np.subtract.outer(run["t"], (EVERY * np.arange(12) + LATE) / UNIT)).min(1) > 1e-9
    )
    assert np.array_equal(run["stamp"][early & between], right["stamp"][early & between])


def test_one_step_over_many_instants(pair: Pair) -> None:
    """The parts of a step of 0.2 s end at the instants: 10, 40, 70, .. ms."""
    model = pair.at(case().parameters).c
    run = _steps(model, 0.2, 1)
    assert run["stamp"].tolist() == [0.0, 0.19]
    within = np.abs(run["omega"][1] - segments([0.2])["omega"][0])
    assert within < 0.02


def test_the_caller_runs_tasks(pair: Pair) -> None:
    """Every 30 ms from 0 on: as a clock that has no offset."""
    model, loop = pair.at(case().parameters).c, case(offset=0)
    count, h = 600, 0.0005
    start = model.vector(0.0, np.zeros(model.size), [2.0])
    status, run = model.timed(h, count, 60, start, np.full((2 * count + 3, 1), 2.0))
    assert status == 0, model.message(status)
    times = np.arange(count + 1) * h
    right = simulator(loop.equations, loop.parameters).run(times, {}, {"ref": 2.0})
    for name in ("i", "omega", "V", "z"):
        assert np.abs(run[name] - right[name]).max() < 1e-9 * np.ptp(right[name]), name


@pytest.fixture(scope="module")
def counter(tmp_path_factory: pytest.TempPathFactory) -> Pair:
    made = ticked.counter()
    return Pair(tmp_path_factory.mktemp("counter"), made.equations, made.parameters)


def _count(model: CModel, s: np.ndarray) -> float:
    return s[[str(one) for one in (*model.program.states, *model.program.law_states)].index("n")]


def test_what_is_due_at_a_start_is_set_once(counter: Pair) -> None:
    """Every other start is an instant, and the end of a step before it."""
    model = counter.at({"m": 2.0}).c
    s, w, told = np.zeros(model.size), np.zeros((3, 1)), []
    for k in range(6):
        _, s = model.step(k * 0.05, 0.05, s, w)
        told.append(_count(model, s))
    assert told == [1, 1, 2, 2, 3, 3]


def test_a_step_over_too_many_is_not_taken(counter: Pair) -> None:
    """What was set at its start stays, as what ports do there, and is not set again."""
    model = counter.at({"m": 2.0}).c
    w = np.full((3, 1), 3.0)
    status, s = model.step(0.0, 400.0, np.zeros(model.size), w)
    assert status == Status.INSTANTS
    assert "more instants" in model.message(status)
    assert sorted(s) == [0, 0, 0, 1]
    status, s = model.step(0.0, 0.05, s, w)
    assert (status, _count(model, s)) == (0, 1)


def test_a_run_that_begins_again_has_its_instants(counter: Pair) -> None:
    model = counter.at({"m": 2.0}).c
    w = np.zeros((3, 1))
    for t in (0.0, 0.2):
        _, s = model.step(t, 0.05, np.zeros(model.size), w)
    _, s = model.step(0.1, 0.05, np.zeros(model.size), w)
    assert _count(model, s) == 1


@cache
def _files() -> dict[str, str]:
    loop = case()
    return to_c(loop.equations, loop.parameters, main=True, inputs={"ref": REF})


def test_steps_with_tasks_are_bounded_and_told() -> None:
    assert findings(_files()) == []
    assert "Each instant of a task inside a step costs a step more" in _files()["config.h"]
    assert '"pi"' in _files()["model.c"]


def test_nothing_is_warned_of(tmp_path: Path) -> None:
    compiled(tmp_path, written(tmp_path, _files()), *WARNED[1:], "-O1")


def test_the_main_program_keeps_the_instants(tmp_path: Path) -> None:
    program = compiled(tmp_path, written(tmp_path, _files()), "-O1")
    times = np.linspace(0, END, 121)
    for how, within in ((("located",), 1e-9), (("step=0.0001",), 2e-3)):
        told = subprocess.run(
            [program, f"{END}", "0.01", *how], capture_output=True, text=True, check=True
        ).stdout.splitlines()
        table = np.array([row.split(",") for row in told[1:]], dtype=float)
        run = dict(zip(told[0].split(","), table.T, strict=True))
        check(run, times, within)
