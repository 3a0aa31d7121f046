"""Runs that are streamed: the numbers of `run`, bit for bit, in files that are whole or say so."""

import csv
import signal
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bondgraph as bg
from codegen import (
    BackendWarning,
    Result,
    Sampled,
    Simulator,
    Sine,
    Square,
    ZeroOrderHold,
    simulator,
    switched_simulator,
)
from codegen.data.columns import read_columns
from codegen.engine import runs
from codegen.runs.track import BLOCK
from codegen.streaming import files
from codegen.streaming.writing import Writing
from codegen.taking import located

MANY = 2 * BLOCK + 77
WAVE = Square(1, -2, 2)

Making = Callable[[str], Simulator]


def made(path: str, *nodes: Any, **numbers: float) -> Making:
    """A simulator of such a graph."""
    graph = bg.graph([bg.Se("force", "F"), bg.One("j"), *nodes], f"force > j > m, {path}")
    return lambda backend: simulator(bg.derive(graph), numbers, backend=backend)


MASS = bg.I("m", 1, flow="v")
MODELS: dict[str, Making] = {
    "linear": made("j > k", MASS, bg.C("k", "1/40", effort="F_k")),
    "friction": made("j > k, j > r", MASS, bg.C("k", "1/40"), bg.R("r", law=bg.DryFriction(1))),
    "curved": made("j > k, j > r", MASS, bg.C("k", law="40*q_k + 10*q_k**3"),
                   bg.R("r", law=bg.DryFriction(1))),
    "corner": made("j > r", MASS, bg.R("r", law="f_r*abs(f_r)")),
    "switched": made("j > b, j > z, z > q, z > c", MASS, bg.R("b", 2), bg.Zero("z"),
                     bg.Sw("q", on="sin(9*t)"), bg.R("c", 3)),
    "sampled": made("j > b", MASS, bg.R("b", 1), bg.Controller(
        "pi", every=0.05, reads=["v"], states={"z": 0}, update={"z": "z + (1 - v)"},
        gives={"u": "z/10"})),
}  # fmt: skip


def same(found: Any, run: Result, names: Any) -> None:
    """The bytes of the values are those of the run's."""
    table = found.read()
    assert list(table) == ["t", *names]
    assert table["t"].tobytes() == run.time.tobytes()
    for name in names:
        assert table[name].tobytes() == np.ascontiguousarray(run[name]).tobytes(), name


def told_events(path: Path) -> list[tuple[float, str, str, float]]:
    """The events of a file of text."""
    with path.open(newline="", encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    assert head == ["event_time", "event_port", "event_kind", "event_impulse"]
    return [(float(t), port, kind, float(impulse)) for t, port, kind, impulse in rows]


ROUTES = [
    (name, backend, method)
    for name in MODELS
    for backend in ("numpy", "c")
    for method in ("auto", "DOP853", "Radau")
    if (name, method) not in (("curved", "Radau"), ("corner", "Radau"), ("sampled", "Radau"))
]


@pytest.mark.most(600)
@pytest.mark.parametrize(("name", "backend", "method"), ROUTES)
def test_the_numbers_are_those_of_a_run(
    name: str, backend: str, method: str, tmp_path: Path
) -> None:
    ready, times = MODELS[name](backend), np.linspace(0.0, 3.0, MANY)
    given = {"F": Sine(3, 5)} if name in ("linear", "corner") else {"F": WAVE}
    run = ready.run(times, {"v": 0.3}, given, method)
    done = ready.stream(tmp_path / "run.csv", times, {"v": 0.3}, given, method=method)
    same(done, run, run.columns)
    assert (done.backend, done.samples, done.events) == (backend, MANY, len(run.events))
    told = [(e.time, str(e.port), e.kind, e.impulse) for e in run.events]
    assert told_events(tmp_path / "run.events.csv") == told
    assert done.final == {name: run[name][-1] for name in run}
    assert sorted(one.name for one in tmp_path.iterdir()) == ["run.csv", "run.events.csv"]


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_samples_may_lie_anywhere(backend: str, tmp_path: Path) -> None:
    ready = MODELS["friction"](backend)
    times = np.sort(np.random.default_rng(1).uniform(0.0, 3.0, MANY))
    run = ready.run(times, {}, {"F": WAVE})
    same(ready.stream(tmp_path / "run.csv", times, {}, {"F": WAVE}), run, run.columns)


def test_a_table_of_text_is_that_of_a_result(tmp_path: Path) -> None:
    ready, times = MODELS["friction"]("numpy"), np.linspace(0.0, 3.0, MANY)
    ready.run(times, {}, {"F": WAVE}).write_csv(tmp_path / "run.csv")
    ready.stream(tmp_path / "streamed.csv", times, {}, {"F": WAVE})
    assert (tmp_path / "streamed.csv").read_bytes() == (tmp_path / "run.csv").read_bytes()


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_parquet_has_units_and_the_signals_that_are_asked_for(backend: str, tmp_path: Path) -> None:
    arrow = pytest.importorskip("pyarrow.parquet")
    ready, times = MODELS["friction"](backend), np.linspace(0.0, 20.0, 20 * BLOCK)
    run = ready.run(times, {}, {"F": WAVE})
    names = ("f_r", "p_m", "v")
    done = ready.stream(tmp_path / "run.parquet", times, {}, {"F": WAVE}, signals=[*names, "v"])
    same(done, run, names)
    assert done.signals == names
    assert (done.read("p_m")["p_m"] == run["p_m"]).all()
    file = arrow.ParquetFile(tmp_path / "run.parquet")
    assert file.num_row_groups == 2
    events = arrow.read_table(tmp_path / "run.events.parquet").to_pydict()
    assert events["event_time"] == [event.time for event in run.events]
    assert set(events["event_port"]) == {"r"}


def test_units_are_metadata_of_columns(tmp_path: Path) -> None:
    arrow = pytest.importorskip("pyarrow.parquet")
    graph = bg.graph([bg.One("j"), bg.I("m", 2, flow="v", unit="m/s"), bg.R("b", 1)],
                     "j > m, j > b")  # fmt: skip
    ready = simulator(bg.derive(graph), {})
    run = ready.run([0.0, 1.0], {"v": 1.0})
    done = ready.stream(tmp_path / "run.parquet", [0.0, 1.0], {"v": 1.0})
    schema = arrow.read_schema(tmp_path / "run.parquet")
    assert schema.field("t").metadata == {b"unit": b"s"}
    assert run.units["v"] == "m/s"
    for name in run:
        unit = run.units.get(name)
        assert schema.field(name).metadata == ({b"unit": unit.encode()} if unit else None)
        assert done.units.get(name) == unit


def test_without_events_there_is_no_file_of_them(tmp_path: Path) -> None:
    ready = MODELS["friction"]("numpy")
    assert ready.stream(tmp_path / "run.csv", [0.0, 2.0], {}, {"F": WAVE}).events > 0
    done = ready.stream(tmp_path / "run.csv", [0.0, 2.0], {}, {"F": WAVE}, events=False)
    assert (done.events, done.events_path) == (0, None)
    assert [one.name for one in tmp_path.iterdir()] == ["run.csv"]


def test_a_run_goes_on_from_where_one_ended(tmp_path: Path) -> None:
    ready = MODELS["linear"]("numpy")
    done = ready.stream(tmp_path / "run.csv", [0.0, 1.0], {"v": 1.0}, {"F": 0}, signals=[])
    again = ready.run([1.0, 2.0], {name: done.final[name] for name in ready.states}, {"F": 0})
    whole = ready.run([0.0, 2.0], {"v": 1.0}, {"F": 0})
    assert again["v"][-1] == pytest.approx(whole["v"][-1], abs=1e-12)
    assert [*done.read()] == ["t"]


# What ends halfway.


def falling(backend: str) -> Simulator:
    """A mass on a ground that rubs less and less: by less than nothing after a second."""
    graph = bg.graph(
        [bg.Se("force", "F"), bg.One("j"), MASS, bg.R("r", law=bg.DryFriction("h"))],
        "force > j > m, j > r",
    )
    return simulator(bg.derive(graph), {}, backend=backend)


@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize("ending", [".csv", ".parquet"])
def test_what_ends_halfway_says_so_and_keeps_what_was_there(
    backend: str, ending: str, tmp_path: Path
) -> None:
    if ending == ".parquet":
        pytest.importorskip("pyarrow")
    ready, path = falling(backend), tmp_path / f"run{ending}"
    path.write_text("what was there")
    times = np.linspace(0.0, 1.5, 3 * BLOCK)
    inputs = {"F": 2.0, "h": Sampled([0.0, 1.5], [1.0, -0.5])}
    with pytest.raises(bg.SimulationError, match=r"below zero|negative") as told:
        ready.stream(path, times, {"v": 1.0}, inputs)
    assert path.read_text() == "what was there"
    partial = tmp_path / f"run.partial{ending}"
    assert any(str(partial) in note for note in told.value.__notes__)
    found = read_columns(partial)
    # Before a second, 2 of 3 blocks are.
    assert len(found.arrays[0]) >= BLOCK
    assert (found.arrays[0] == times[: len(found.arrays[0])]).all()
    t = found.arrays[0]
    # v' = F - h = 1 + t.
    assert np.abs(found.arrays[found.names.index("v")] - (1 + t + t**2 / 2)).max() < 1e-8


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_ctrl_c_leaves_what_is_partial(
    backend: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ready, take, calls = MODELS["linear"](backend), Writing.take, []

    def interrupted(self: Writing, *arguments: Any) -> None:
        calls.append(len(calls))
        if len(calls) == 2:
            raise KeyboardInterrupt
        take(self, *arguments)

    monkeypatch.setattr(Writing, "take", interrupted)
    with pytest.raises(KeyboardInterrupt):
        ready.stream(tmp_path / "run.csv", np.linspace(0.0, 1.0, MANY), {"v": 1.0}, {"F": 0})
    names = sorted(one.name for one in tmp_path.iterdir())
    assert names == ["run.events.partial.csv", "run.partial.csv"]
    assert len(read_columns(tmp_path / "run.partial.csv").arrays[0]) == BLOCK
    monkeypatch.undo()
    # A run of the same simulator then is as any.
    done = ready.stream(tmp_path / "run.csv", np.linspace(0.0, 1.0, MANY), {"v": 1.0}, {"F": 0})
    assert done.samples == MANY
    assert sorted(one.name for one in tmp_path.iterdir()) == ["run.csv", "run.events.csv"]
    assert told_events(tmp_path / "run.events.csv") == []


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="no alarms")
@pytest.mark.parametrize("ending", [".csv", ".parquet"])
@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_what_is_interrupted_anywhere_can_be_read(
    backend: str, ending: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An alarm, as Ctrl-C is one, rings a moment after the twentieth block."""
    if ending == ".parquet":
        pytest.importorskip("pyarrow")
    ready, take, calls = MODELS["linear"](backend), Writing.take, []

    def ring(*_: object) -> None:
        raise KeyboardInterrupt

    def armed(self: Writing, *arguments: Any) -> None:
        take(self, *arguments)
        calls.append(1)
        if len(calls) == 20:
            signal.setitimer(signal.ITIMER_REAL, 0.02)

    monkeypatch.setattr(Writing, "take", armed)
    times, before = np.linspace(0.0, 1.0, 2_000_000), signal.signal(signal.SIGALRM, ring)
    try:
        with pytest.raises(KeyboardInterrupt):
            ready.stream(tmp_path / f"run{ending}", times, {"v": 1.0}, {"F": 0})
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    found = read_columns(tmp_path / f"run.partial{ending}", ["t"]).arrays[0]
    assert len(found) >= 15 * BLOCK
    assert (found == times[: len(found)]).all()


def test_of_a_run_that_ends_before_its_first_sample_nothing_is_left(tmp_path: Path) -> None:
    ready = falling("numpy")
    with pytest.raises(bg.SimulationError):
        ready.stream(tmp_path / "run.csv", [0.0, 1.0], {"v": 1.0}, {"F": 2.0, "h": -1.0})
    assert [*tmp_path.iterdir()] == []


def test_a_run_that_numpy_does_instead_is_written_once(tmp_path: Path) -> None:
    """C hands samples over before it gives up; none of them stays."""
    ready = MODELS["linear"]("c")
    pytest.importorskip("sksundae")
    with pytest.warns(BackendWarning, match="C has no method") as told:
        done = ready.stream(tmp_path / "run.csv", [0.0, 1.0], {"v": 1.0}, {"F": 0}, method="CVODE")
    assert [one.filename for one in told] == [__file__]
    assert (done.backend, done.samples) == ("numpy", 2)


# What is refused.


def test_what_cannot_be_written_is_refused_before_the_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ready, run = MODELS["linear"]("numpy"), ([0.0, 1.0], {}, {"F": 0})
    with pytest.raises(bg.SignalError, match=r"must end in \.csv or \.parquet"):
        ready.stream(tmp_path / "run.mat", *run)
    with pytest.raises(bg.SignalError, match=r"no signal 'F_l' \(did you mean 'F_k'\?\)"):
        ready.stream(tmp_path / "run.csv", *run, signals=["F_l"])
    with pytest.raises(bg.SignalError, match="signals must be a list of names, not 'v'"):
        ready.stream(tmp_path / "run.csv", *run, signals="v")
    with pytest.raises(bg.WriteError, match=r"run\.csv cannot be written: No such file"):
        ready.stream(tmp_path / "none" / "run.csv", *run)
    (tmp_path / "folder.csv").mkdir()
    with pytest.raises(bg.WriteError, match=r"folder\.csv cannot be written: it is a folder"):
        ready.stream(tmp_path / "folder.csv", *run)
    monkeypatch.setattr(files, "find_spec", lambda _: None)
    with pytest.raises(bg.MissingExtraError, match=r"pyarrow.*bondgraph-toolkit\[tables\]"):
        ready.stream(tmp_path / "run.parquet", *run)
    assert [one.name for one in tmp_path.iterdir()] == ["folder.csv"]


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_memory_does_not_grow_with_samples(backend: str, tmp_path: Path) -> None:
    """But by their times: by less than 20 bytes for each, where a run has 8 of each of seven columns."""
    ready, peaks = MODELS["linear"](backend), []
    for count in (BLOCK, 8 * BLOCK, 24 * BLOCK):
        times = np.linspace(0.0, 1.0, count)
        tracemalloc.start()
        ready.stream(tmp_path / "run.csv", times, {"v": 1.0}, {"F": 0})
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert (peaks[2] - peaks[1]) / (16 * BLOCK) < 20


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_a_model_with_a_delay_is_streamed(backend: str, tmp_path: Path) -> None:
    graph = bg.graph([bg.State("x", "-past", start=1), bg.Delay("past", "x", time="T", start=1)])
    ready = simulator(bg.derive(graph), {"T": 0.5}, backend=backend)
    times = np.linspace(0.0, 2.0, MANY)
    run = ready.run(times)
    same(ready.stream(tmp_path / "run.csv", times), run, run.columns)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_a_switch_that_rests_across_a_border_is_told(backend: str, tmp_path: Path) -> None:
    """The last sample of a block and the first of the next are the two that tell."""
    graph = bg.graph(
        [bg.Se("force", "F"), bg.One("j"), MASS, bg.Zero("z"), bg.Sw("q", on="u"), bg.R("b", 2)],
        "force > j > m, j > z, z > q, z > b",
    )
    ready = switched_simulator(graph, {}, backend=backend)
    border = float(BLOCK - 1)
    command = ZeroOrderHold([0.0, border - 0.5, border + 1.5], [1.0, 0.0, -1.0])
    times, given = np.arange(2.0 * BLOCK), {"F": 1.0, "u": command}
    with pytest.warns(bg.ModelWarning, match="'q' stays on while its command u rests") as told:
        run = ready.run(times, {}, given)
    with pytest.warns(bg.ModelWarning) as again:
        done = ready.stream(tmp_path / "run.csv", times, {}, given)
    assert [str(one.message) for one in again] == [str(one.message) for one in told]
    assert [one.filename for one in again] == [__file__]
    same(done, run, run.columns)


@pytest.mark.parametrize("method", ["exact", "DOP853"])
def test_a_run_that_begins_again_for_room_is_written_once(
    method: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Three switches turn at once where there is room for two events: C begins again with more."""
    monkeypatch.setattr(runs, "CAPACITY", 2)
    monkeypatch.setattr(located, "FEW", 2)
    switches = [bg.Sw(f"q{k}", on="sin(9*t + 1)") for k in range(3)]
    zeros = [bg.Zero(f"z{k}") for k in range(3)]
    loads = [bg.R(f"c{k}", k + 1) for k in range(3)]
    paths = [f"j > z{k} > q{k}, z{k} > c{k}" for k in range(3)]
    graph = bg.graph([bg.One("j"), MASS, *switches, *zeros, *loads], "j > m, " + ", ".join(paths))
    ready, times = simulator(bg.derive(graph), {}, backend="c"), np.linspace(0.0, 3.0, MANY)
    done = ready.stream(tmp_path / "run.csv", times, {"v": 1.0}, method=method)
    run = ready.run(times, {"v": 1.0}, method=method)
    assert (done.backend, done.samples) == ("c", MANY)
    same(done, run, run.columns)
    # The sine is zero at (k pi - 1)/9.
    turns = (np.arange(1, 10) * np.pi - 1) / 9
    turns = turns[turns < 3]
    events = told_events(tmp_path / "run.events.csv")
    assert [port for _, port, _, _ in events] == ["q0", "q1", "q2"] * len(turns)
    assert np.abs([t for t, *_ in events] - np.repeat(turns, 3)).max() < 1e-9
