"""Sweeps in processes: the same numbers, and no finished run lost when one dies."""

import os
import subprocess
import sys
from concurrent.futures import BrokenExecutor, Executor
from pathlib import Path

import numpy as np
import pytest
from oracles.sweeping import LOCKING, TIMES, Killer, Logged, locking, spring_mass

import bondgraph as bg
import codegen
from codegen import Sweep, sweep
from codegen.sweeps.chunks import Chunk
from codegen.sweeps.crews import THREADS, Processes
from codegen.sweeps.drive import ENDED, Pace, Work, drive
from codegen.sweeps.job import Job
from codegen.sweeps.measuring import sent

TESTS = Path(__file__).parents[2]
SPEEDS = np.arange(1.0, 13.0)


def _swept(measures: object, **more: object) -> Sweep:
    given = {"inputs": {"P": 0.0}, "progress": False, **more}
    return sweep(spring_mass(), {"v": SPEEDS}, TIMES, measures, **given)


def test_numbers_do_not_depend_on_how_many_processes_there_are() -> None:
    draws = codegen.Samples(30, seed=2, c=(300.0, 900.0), omega_2=(80.5, 90.0))
    given = {**LOCKING, "initial": {"omega_1": 80.0}, "progress": False}
    alone = sweep(locking(), draws, **given, workers=0)
    beside = sweep(locking(), draws, **given, workers=2)
    assert not alone.failed
    for name in ("stick", "peak"):
        assert (alone[name] == beside[name]).all()
    assert len(set(alone["stick"])) == 30


def test_a_run_that_ends_its_process_fails_alone() -> None:
    found = _swept({"F": Killer(at=3.0)}, workers=1, chunk=5)
    assert [(f.run, dict(f.values), f.message) for f in found.failed] == [(2, {"v": 3.0}, ENDED)]
    assert np.isnan(found["F"]).tolist() == [v == 3.0 for v in SPEEDS]
    assert found.complete


def test_runs_whose_process_is_killed_are_done_again(tmp_path) -> None:
    killed = _swept({"log": Logged(tmp_path), "F": Killer(4.0, tmp_path)}, workers=2, chunk=6,
                    store=tmp_path / "store")  # fmt: skip
    assert (tmp_path / "killed").exists()
    assert not killed.failed
    assert (killed["F"] == _swept({"F": codegen.final("F")}, workers=0)["F"]).all()
    # Six runs of the other process, four until the end of this one, its six again.
    assert Logged(tmp_path).runs() == 6 + 4 + 6


class _Threads:
    """How many threads linear algebra may use."""

    def __call__(self, result: codegen.Result) -> list[float]:
        return [float(os.environ.get(name, "0")) for name in THREADS]


def test_processes_use_one_thread_each_and_this_one_is_left_alone(monkeypatch) -> None:
    for name in THREADS:
        monkeypatch.setenv(name, "5")
    monkeypatch.delenv(THREADS[0])
    job = Job(spring_mass(), ("v",), TIMES, {"threads": codegen.final("v")}, None, {"P": 0.0})
    seen: list[dict[str, str]] = []
    monkeypatch.setattr(
        "codegen.sweeps.crews.ProcessPoolExecutor.submit", lambda *_: seen.append({**os.environ})
    )
    Processes(sent(job), 1)
    assert [seen[0][name] for name in THREADS] == ["1"] * len(THREADS)
    assert [os.environ.get(name) for name in THREADS] == [None, "5", "5"]


def test_a_script_without_a_guard_is_told_what_to_do(tmp_path) -> None:
    script = tmp_path / "script.py"
    script.write_text(
        "from oracles.sweeping import *\nfrom codegen import sweep\n"
        "sweep(spring_mass(), {'v': [1.0]}, TIMES, MEASURES2, inputs={'P': 0.0}, workers=1)\n"
        .replace("MEASURES2", "{'end': final('v')}")
    )  # fmt: skip
    paths = os.pathsep.join(map(str, (TESTS.parent, TESTS, TESTS / "codegen")))
    run = subprocess.run([sys.executable, str(script)], env={**os.environ, "PYTHONPATH": paths},
                         capture_output=True, text=True, check=False)  # fmt: skip
    assert run.returncode == 1
    assert run.stderr.count("the processes of the sweep do not start") == 1
    assert "__main__" in run.stderr


class _Fake:
    """Does chunks at once, and loses those that are given, blamed or not."""

    def __init__(self, shared: bool, killers: set[int], unblamed: int = 0) -> None:
        self.shared, self.killers, self.unblamed = shared, killers, unblamed
        self.begun: list[Chunk] = []
        self.most_beside_a_suspect = 0

    def slots(self) -> int:
        return 3

    def start(self, chunk: Chunk) -> None:
        self.begun.append(chunk)

    def finished(self) -> list:
        from codegen.sweeps.chunks import Outcome
        from codegen.sweeps.crew import Lost

        begun, self.begun = self.begun, []
        if self.unblamed:
            self.unblamed -= 1
            return [(chunk, Lost(blamed=False)) for chunk in begun]
        ends = any(self.killers & set(chunk.indices) for chunk in begun)
        found = []
        for chunk in begun:
            blamed = ends if self.shared else bool(self.killers & set(chunk.indices))
            done = Outcome(chunk.indices, ((np.array(1.0),),) * len(chunk.indices), 1.0)
            found.append((chunk, Lost(blamed=True) if blamed else done))
        return found

    def close(self, now: bool) -> None:
        pass


@pytest.mark.parametrize("shared", [False, True])
@pytest.mark.parametrize("length", [1, 4, None])
def test_only_runs_that_end_their_process_alone_are_blamed(shared: bool, length) -> None:
    kept: dict[int, object] = {}
    work = Work(codegen.Table(a=np.arange(20.0)), np.arange(20), Pace(length))

    def keep(outcome) -> None:
        for index, result in zip(outcome.indices, outcome.results, strict=True):
            assert index not in kept
            kept[index] = result

    drive(_Fake(shared, {3, 4, 19}, unblamed=2), work, keep)
    assert sorted(kept) == list(range(20))
    assert {index for index, result in kept.items() if result == ENDED} == {3, 4, 19}


def test_chunks_take_half_a_second_or_more_once_runs_are_timed() -> None:
    assert Pace(None).size(10**6, 4) == 1
    assert Pace(None, runs=1, seconds=1e-5).size(10**6, 4) == 4
    assert Pace(None, runs=10**5, seconds=100.0).size(10**4, 4) == 625
    assert Pace(None, runs=10**5, seconds=100.0).size(10**3, 4) == 500
    assert Pace(None, runs=10**5, seconds=100.0).size(10**6, 4) == 10**4
    assert Pace(None, runs=10, seconds=100.0).size(10**6, 4) == 1
    assert Pace(7, runs=10, seconds=100.0).size(10**6, 4) == 7


def _submit_for_ever(executor: Executor) -> None:
    while True:
        executor.submit(os.getpid)


def test_an_idle_process_that_was_killed_is_replaced() -> None:
    job = Job(spring_mass(), ("v",), TIMES, {"F": codegen.final("F")}, None, {"P": 0.0})
    crew = Processes(sent(job), 1)
    try:
        crew.start(Chunk((0,), ((1.0,),)))
        assert crew.finished()[0][1].results[0]
        lane = crew._lanes[0]
        lane._processes[0].kill()
        lane._processes[0].join()
        # The crew notices at its own pace.
        with pytest.raises(BrokenExecutor, match="terminated abruptly"):
            _submit_for_ever(lane._executor)
        crew.start(Chunk((1,), ((2.0,),)))
        assert crew.finished()[0][1].results[0]
    finally:
        crew.close(now=True)


def test_a_process_that_cannot_start_is_no_end_of_the_sweep_at_once(monkeypatch) -> None:
    job = Job(spring_mass(), ("v",), TIMES, {"F": codegen.final("F")}, None, {"P": 0.0})
    crew = Processes(sent(job)[:-20], 1)
    try:
        crew.start(Chunk((0,), ((1.0,),)))
        with pytest.raises(bg.SimulationError, match="do not start"):
            crew.finished()
    finally:
        crew.close(now=True)
