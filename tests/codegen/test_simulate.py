"""`Simulator.run` and `Result`: names, samples, files, repetition; what a run may not depend on."""

import csv

import numpy as np
import pytest
from oracles.models import block, oscillator, pulled_block, series_circuit
from references.build import bond_graph

import bondgraph as bg
from codegen import Lag, Result, Sine, Step, simulator

OSCILLATOR = simulator(bg.derive(oscillator()), {"m": 2.3, "k": 517.0, "F_c": 4.1})
CIRCUIT = simulator(
    bg.derive(series_circuit(), outputs=["resistor"]), {"R": 2.0, "L": 0.5, "C": 0.02}
)
TIMES = np.linspace(0.0, 1.0, 51)


def _run(times: np.ndarray = TIMES) -> Result:
    return OSCILLATOR.run(times, {"F": 60.0})


def test_a_simulator_names_what_it_takes_and_shows() -> None:
    nodes = [
        bg.One("n"),
        bg.I("m", "m", flow="v"),
        bg.C("s", law="k*q_s + w"),
        bg.Se("p", "P"),
        bg.R("open"),
    ]
    run = simulator(bg.derive(bond_graph(nodes, "n>m n>s p>n n>open")), {"m": 1.0, "k": 2.0})
    assert run.states == ("v", "q_s")
    assert run.inputs == ("P", "e_open", "w")
    assert run.outputs == ("f_open",)
    result = run.run(TIMES, {"v": 1.0}, {"P": 0.0, "e_open": 3.0, "w": Step(0.5, 1.0)})
    assert (result.states, result.inputs, result.outputs) == (run.states, run.inputs, run.outputs)
    for name in (*run.states, *run.inputs, *run.outputs, "e_s", "f_p"):
        assert result[name].shape == TIMES.shape
    assert set(result) >= {*run.states, *run.inputs, *run.outputs}
    assert result["f_open"] == pytest.approx(result["v"], abs=0)


def test_an_unknown_name_lists_what_there_is() -> None:
    with pytest.raises(KeyError, match=r"no signal 'omega'; there are v, F, .*slip"):
        _run()["omega"]


def test_time_is_the_given_time() -> None:
    given = [0.0, 0.1, 0.35, 1.0]
    assert (_run(given).time == given).all()


def test_a_csv_file_gives_back_every_number(tmp_path) -> None:
    result = _run()
    result.write_csv(tmp_path / "run.csv")
    with open(tmp_path / "run.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))
    assert rows[0] == ["t", *result]
    table = np.array(rows[1:], dtype=float)
    assert (table[:, 0] == result.time).all()
    for at, name in enumerate(result, start=1):
        assert (table[:, at] == result[name]).all()


def test_runs_repeat_to_the_last_bit_and_share_no_memory() -> None:
    one, other = _run(), _run()
    again = simulator(bg.derive(oscillator()), {"m": 2.3, "k": 517.0, "F_c": 4.1})
    third = again.run(TIMES, {"F": 60.0})
    assert one.events == other.events == third.events
    for name in one:
        assert (one[name] == other[name]).all()
        assert (one[name] == third[name]).all()
        assert not np.shares_memory(one[name], other[name])
    names = list(one)
    for i, name in enumerate(names):
        assert not any(np.shares_memory(one[name], one[other]) for other in names[i + 1 :])


def test_a_result_keeps_no_hold_on_the_callers_arrays() -> None:
    times = TIMES.copy()
    result = _run(times)
    times[:] = -1.0
    assert result.time[-1] == 1.0


def test_columns_cannot_be_replaced() -> None:
    with pytest.raises(TypeError, match="does not support item assignment"):
        _run().columns["v"] = np.zeros(51)


@pytest.mark.parametrize(
    "keep", [slice(None, None, 2), slice(None, None, 50), [0, 1, 2, 7, 49, 50]]
)
def test_samples_do_not_depend_on_the_other_samples(keep) -> None:
    full, part = _run(), _run(TIMES[keep])
    assert [e[1:] for e in part.events] == [e[1:] for e in full.events]
    times = [event.time for event in full.events]
    assert [event.time for event in part.events] == pytest.approx(times, rel=1e-14)
    for name in full:
        assert part[name] == pytest.approx(full[name][keep], rel=1e-13, abs=1e-13)


def test_a_run_can_be_continued_from_its_last_state() -> None:
    """At 0.337 the mass is moving; the second half has other steps, so rounding is all that differs."""
    full = _run()
    first = _run(np.linspace(0, 0.337, 5))
    start = {name: first[name][-1] for name in ("v", "F")}
    second = OSCILLATOR.run(np.linspace(0.337, 1.0, 5), start)
    for name in ("v", "F"):
        assert second[name][-1] == pytest.approx(full[name][-1], abs=1e-7)
    assert [e.time for e in first.events + second.events] == pytest.approx(
        [e.time for e in full.events], abs=1e-9
    )


@pytest.mark.parametrize("shift", [-3.0, 0.5, 1000.0])
def test_only_differences_of_time_count(shift: float) -> None:
    run = simulator(bg.derive(pulled_block()), {"m": 1.0, "k": 40.0, "F_c": 3.0})
    here = run.run(TIMES * 4, inputs={"V": Lag(Step(0.1, 0.5), 0.2)})
    there = run.run(TIMES * 4 + shift, inputs={"V": Lag(Step(0.1 + shift, 0.5), 0.2)})
    assert [(e.port, e.kind) for e in there.events] == [(e.port, e.kind) for e in here.events]
    assert [e.time - shift for e in there.events] == pytest.approx(
        [e.time for e in here.events], abs=1e-8
    )
    assert there["F"] == pytest.approx(here["F"], abs=1e-7)


def test_at_an_event_and_at_a_step_a_sample_shows_the_instant_after() -> None:
    run = simulator(bg.derive(block()), {"m": 1.0, "F_c": 2.0})
    result = run.run([0.0, 0.5, 1.0, 1.5], {"v": 1.0}, {"P": Step(1.0, 3.0)})
    assert [e[:3] for e in result.events] == [
        (pytest.approx(0.5, abs=1e-12), "ground", "stick"), (1.0, "ground", "slip"),
    ]  # fmt: skip
    assert result["P"].tolist() == [0.0, 0.0, 3.0, 3.0]
    assert result["f"] == pytest.approx([2.0, 0.0, 2.0, 2.0], abs=1e-9)
    assert result["v"] == pytest.approx([1.0, 0.0, 0.0, 0.5], abs=1e-10)


def test_events_come_in_order_and_have_time_port_and_kind() -> None:
    events = _run().events
    assert [e.time for e in events] == sorted(e.time for e in events)
    assert len(events) > 3
    time, port, kind = events[0].time, events[0].port, events[0].kind
    assert time == pytest.approx(np.pi * np.sqrt(2.3 / 517.0), rel=1e-9)
    assert (port, kind) == ("ground", "cross")


def test_tighter_tolerances_come_closer_to_the_closed_form() -> None:
    def error(rtol: float) -> float:
        result = CIRCUIT.run(TIMES, {"v": 1.0}, {"V": Sine(3.0, 5.0)}, "DOP853", rtol, rtol * 0.1)
        w, half = 10 * np.pi, 2.0
        w_d = np.sqrt(100 - half**2)
        X = -3j / (1 - 0.01 * w**2 + 1j * w * 0.04)
        v = (X * np.exp(1j * w * TIMES)).real
        a, b = 1.0 - X.real, (-(1j * w * X).real + half * (1.0 - X.real)) / w_d
        v += np.exp(-half * TIMES) * (a * np.cos(w_d * TIMES) + b * np.sin(w_d * TIMES))
        return float(np.abs(result["v"] - v).max())

    assert error(1e-12) < 1e-9
    assert error(1e-12) <= error(1e-4) < 1e-3


def test_an_open_input_that_parameters_name_is_held() -> None:
    run = simulator(bg.derive(series_circuit()), {"R": 2.0, "L": 0.5, "C": 0.02, "V": 6.0})
    assert run.inputs == ()
    assert run.run(np.linspace(0, 20, 3))["v"][-1] == pytest.approx(6.0, abs=1e-8)
