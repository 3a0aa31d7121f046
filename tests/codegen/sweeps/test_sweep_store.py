"""Sweeps that are interrupted and continued, and folders that hold something else."""

import json
import os
import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from oracles.sweeping import MEASURES, TIMES, Logged, Plain, spring_mass, twice

import bondgraph as bg
import codegen
from codegen import Family, Sweep, SweepInterrupted, Table, sweep
from codegen.sweeps.chunks import Outcome
from codegen.sweeps.design import Samples
from codegen.sweeps.result import Collected

TESTS = Path(__file__).parents[2]
SPEEDS = {"v": np.arange(1.0, 41.0)}
PLAIN = {"time": TIMES, "measures": {"twice": twice}, "workers": 0, "progress": False}


class _Once:
    """The end speed; interrupts the sweep at one run, as long as it is set to."""

    def __init__(self, at: float) -> None:
        self.at = at

    def __call__(self, result: codegen.Result) -> float:
        if result["v"][0] == self.at:
            raise KeyboardInterrupt
        return float(result["v"][-1])

    __module__ = __qualname__ = "once"


def _swept(store: Path, measures: object = MEASURES, parameters: object = SPEEDS, **more) -> Sweep:
    given = {"inputs": {"P": 0.0}, "workers": 0, "progress": False, "chunk": 3, **more}
    return sweep(spring_mass(), parameters, TIMES, measures, store=store, **given)


def _same(one: Sweep, other: Sweep) -> bool:
    return all(np.array_equal(one[name], other[name], equal_nan=True) for name in one.measures)


def test_an_interrupted_sweep_has_what_is_done_and_goes_on_later(tmp_path) -> None:
    measures = {"end": _Once(20.0), "log": Logged(tmp_path)}
    with pytest.raises(KeyboardInterrupt, match="18 of 40 runs are done") as caught:
        _swept(tmp_path / "store", measures)
    assert isinstance(caught.value, SweepInterrupted)
    part = caught.value.sweep
    assert not part.complete
    assert not part.failed
    assert part.done.tolist() == [True] * 18 + [False] * 22
    assert np.isnan(part["end"]).tolist() == [False] * 18 + [True] * 22
    assert measures["log"].runs() == 19
    measures["end"].at = np.nan
    whole = _swept(tmp_path / "store", measures)
    assert measures["log"].runs() == 19 + 22
    assert whole.complete
    assert _same(whole, _swept(tmp_path / "other", measures))


def test_a_finished_sweep_is_read_back_without_a_run(tmp_path) -> None:
    measures = {"log": Logged(tmp_path), "course": codegen.samples("v"), "F": codegen.peak("F")}
    rows = Table(m=[1.0, 0.0, 2.0, 4.0])
    first = _swept(tmp_path / "store", measures, rows)
    again = _swept(tmp_path / "store", measures, rows, chunk=1)
    assert measures["log"].runs() == 3
    assert _same(first, again)
    assert first["course"].shape == (4, len(TIMES))
    assert again.failed == first.failed != ()


SCRIPT = """
from oracles.sweeping import *
from codegen import sweep
from pathlib import Path
import signal

if __name__ == "__main__":
    # What starts the tests in the background may have it ignored.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    folder = Path({folder!r})
    sweep(spring_mass(), {{"v": np.arange(1.0, 41.0)}}, TIMES, {{"end": Logged(folder, 0.3)}},
          inputs={{"P": 0.0}}, workers=1, store=folder / "store", chunk=1)
"""


def test_a_script_that_is_interrupted_keeps_its_finished_runs(tmp_path) -> None:
    script = tmp_path / "script.py"
    script.write_text(SCRIPT.format(folder=str(tmp_path)))
    paths = os.pathsep.join(map(str, (TESTS.parent, TESTS, TESTS / "codegen")))
    process = subprocess.Popen(
        [sys.executable, str(script)], env={**os.environ, "PYTHONPATH": paths},
        stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip
    store = tmp_path / "store"
    while len(list(store.glob("runs-*.npz"))) < 2:
        assert process.poll() is None
        time.sleep(0.02)
    # As a terminal does: to the script and to its processes.
    os.killpg(process.pid, signal.SIGINT)
    message = process.communicate()[1]
    assert process.returncode in (-signal.SIGINT, 1), message
    assert "SweepInterrupted" in message
    kept = len(list(store.glob("runs-*.npz")))
    assert 2 <= kept < 40
    before = Logged(tmp_path).runs()
    whole = _swept(store, {"end": Logged(tmp_path)})
    assert Logged(tmp_path).runs() - before == 40 - kept
    assert whole.complete
    assert _same(whole, _swept(tmp_path / "other", {"end": Logged(tmp_path)}))


@pytest.mark.parametrize(
    ("change", "what"),
    [
        ({"parameters": {"v": [1.0, 2.0]}}, "parameters, runs"),
        ({"parameters": {"v": np.arange(2.0, 42.0)}}, "parameters"),
        ({"parameters": {"m": np.arange(1.0, 41.0)}}, "names, parameters"),
        ({"measures": {"force": codegen.final("F")}}, "measures"),
        ({"measures": {**MEASURES, "force": codegen.peak("F")}}, "measures"),
        ({"initial": {"F": 1.0}}, "initial"),
        ({"inputs": {"P": 1.0}}, "inputs"),
        ({"rtol": 1e-9}, "settings"),
    ],
)
def test_the_folder_of_another_sweep_is_refused(tmp_path, change, what: str) -> None:
    _swept(tmp_path)
    with pytest.raises(bg.StoreError, match=f"another sweep, which differs in {what};"):
        _swept(tmp_path, **change)


STEP = codegen.Step(0.1, 2.0)


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (STEP, codegen.Step(0.1, 3.0)), (STEP, 2 * STEP), (2 * STEP, 3 * STEP), (STEP, STEP + STEP),
        (codegen.Lag(STEP, 0.1), codegen.Lag(STEP, 0.2)),
        (codegen.Sampled([0, 1], [0, 1]), codegen.Sampled([0, 1], [0, 2])),
    ],
)  # fmt: skip
def test_inputs_are_told_by_all_that_they_are(tmp_path, one, other) -> None:
    _swept(tmp_path, inputs={"P": one})
    with pytest.raises(bg.StoreError, match="another sweep, which differs in inputs;"):
        _swept(tmp_path, inputs={"P": other})
    assert _swept(tmp_path, inputs={"P": one}).complete


def scaled(factor: float, result: codegen.Result) -> float:
    """A measure with a number of its own."""
    return factor * float(result["v"][-1])


def test_measures_with_arguments_are_told_by_them(tmp_path) -> None:
    _swept(tmp_path, measures={"end": partial(scaled, 2.0)})
    with pytest.raises(bg.StoreError, match="another sweep, which differs in measures;"):
        _swept(tmp_path, measures={"end": partial(scaled, 3.0)})
    assert _swept(tmp_path, measures={"end": partial(scaled, 2.0)}).complete


def longest(numbers: np.ndarray, result: codegen.Result) -> float:
    """A measure with many numbers of its own."""
    return float(numbers.max())


def test_arrays_are_told_by_every_number(tmp_path) -> None:
    one, other = np.zeros(3000), np.zeros(3000)
    other[1500] = 1e-12
    _swept(tmp_path, measures={"end": partial(longest, one)})
    with pytest.raises(bg.StoreError, match="another sweep, which differs in measures;"):
        _swept(tmp_path, measures={"end": partial(longest, other)})
    assert _swept(tmp_path, measures={"end": partial(longest, np.zeros(3000))}).complete


@pytest.mark.parametrize("events", [True, False])
def test_runs_with_events_and_without_are_kept_apart(events: bool, tmp_path) -> None:
    _swept(tmp_path, measures={"twice": twice}, events=events)
    with pytest.raises(bg.StoreError, match="another sweep, which differs in events;"):
        _swept(tmp_path, measures={"twice": twice}, events=not events)
    assert _swept(tmp_path, measures={"twice": twice}, events=events).complete


def test_the_folder_of_another_model_is_refused(tmp_path) -> None:
    _swept(tmp_path)
    other = Family(spring_mass().equations, {"m": 2.0, "k": 8.5})
    given = {"inputs": {"P": 0.0}, "workers": 0, "progress": False}
    with pytest.raises(bg.StoreError, match="differs in model;"):
        sweep(other, SPEEDS, TIMES, MEASURES, store=tmp_path, **given)


def test_folders_and_files_of_something_else_are_refused(tmp_path) -> None:
    (tmp_path / "letter.txt").write_text("dear")
    with pytest.raises(bg.StoreError, match="holds other files"):
        _swept(tmp_path)
    (tmp_path / "sweep.json").write_text("{}")
    with pytest.raises(bg.StoreError, match="does not belong to a sweep"):
        _swept(tmp_path)
    (tmp_path / "sweep.json").write_text("{")
    with pytest.raises(bg.StoreError, match="cannot be read"):
        _swept(tmp_path)


def test_a_damaged_file_is_named_and_its_runs_can_be_done_again(tmp_path) -> None:
    whole = _swept(tmp_path)
    files = sorted(tmp_path.glob("runs-*.npz"))
    files[2].write_bytes(files[2].read_bytes()[:100])
    with pytest.raises(bg.StoreError, match=f"{files[2].name} cannot be read; remove it"):
        _swept(tmp_path)
    files[2].unlink()
    assert _same(_swept(tmp_path), whole)


def test_what_a_killed_sweep_was_writing_is_passed_over(tmp_path) -> None:
    (tmp_path / "runs-000000000-abcd.npz.tmp").write_bytes(b"half")
    assert _swept(tmp_path).complete
    assert json.loads((tmp_path / "sweep.json").read_text())["names"] == ["v"]


def test_a_run_that_comes_in_twice_counts_once() -> None:
    collected = Collected(3, ["a"])
    assert collected.add(Outcome((2, 0), ((np.array(1.0),), "no"), 0.0)) == 2
    assert collected.add(Outcome((0, 1, 2), ((np.array(5.0),),) * 3, 0.0)) == 1
    found = collected.sweep(Table(k=[1.0, 2.0, 3.0]), TIMES, frozenset())
    assert np.array_equal(found["a"], [np.nan, 5.0, 1.0], equal_nan=True)
    assert [failure.run for failure in found.failed] == [0]


def test_failures_among_many_runs_keep_their_place(tmp_path) -> None:
    values = np.arange(3000.0)
    values[[7, 2500]] = 1e6
    rows = Table(a=values)
    found = sweep(Plain(), rows, store=tmp_path, **PLAIN)
    assert [failure.run for failure in found.failed] == [7, 2500]
    assert np.isnan(found["twice"]).sum() == 2
    draws = Samples(200, seed=1, a=(0.0, 1.0))
    assert (sweep(Plain(), draws, **PLAIN)["twice"] == 2 * draws.column("a")).all()
