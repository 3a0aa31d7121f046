"""Many runs in one call of C: what a sweep by the numpy backend gives, run by run."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from oracles.sweeping import LOCKING, locking, spring_mass

from codegen import (
    Family,
    Lag,
    Ramp,
    Result,
    Sine,
    Step,
    Sweep,
    Swept,
    Table,
    event_count,
    final,
    first_event,
    integral,
    largest,
    peak,
    samples,
    smallest,
    sweep,
)  # fmt: skip
from codegen.numbers.arrays import Array
from codegen.sweeps.job import Job
from codegen.sweeps.measuring import batch_of
from differentials.scenarios import prepared

CASE = prepared("alsd", "fig11")
TIMES = np.linspace(0.0, 1.0, 501)
MEASURES = {
    "peak": peak("tau_k1"), "largest": largest("omega_f"), "smallest": smallest("tau_h"),
    "final": final("omega_1"), "integral": integral("tau_f"), "samples": samples("tau_f"),
    "lock": first_event("clutch", "stick"), "slips": event_count("clutch", "slip"),
}  # fmt: skip
NAMES = [name for name in MEASURES if name != "lock"]


def _family(backend: str, **changes: object) -> Family:
    return Family(CASE.equations, {**CASE.parameters, **changes}, CASE.laws, backend=backend)


def _demand(values: Mapping[str, float]) -> dict[str, Any]:
    return {**CASE.inputs, **_only_demand(values)}


def _both(
    parameters: Any, measures: Any = MEASURES, workers: int = 2, **given: Any
) -> tuple[Sweep, Sweep]:
    given = {"initial": CASE.initial, "inputs": CASE.inputs, "progress": False, **given}
    one = sweep(_family("c"), parameters, TIMES, measures, workers=workers, **given)
    other = sweep(_family("numpy"), parameters, TIMES, measures, workers=0, **given)
    return one, other


def _agree(one: Sweep, other: Sweep) -> None:
    for name in NAMES:
        span = max(float(np.ptp(other[name])), float(np.abs(other[name]).max()), 1e-3)
        assert np.abs(one[name] - other[name]).max() <= 1e-9 * span, name
    assert one["lock"] == pytest.approx(other["lock"], abs=1e-9, nan_ok=True)
    assert one.failed == other.failed


def _batch_of(parameters: tuple[str, ...], measures: Any, inputs: Any = CASE.inputs) -> Any:
    return batch_of(Job(_family("c"), parameters, TIMES, measures, CASE.initial, inputs))


def test_stiffnesses_and_initial_speeds() -> None:
    initial = {name: value for name, value in CASE.initial.items() if name != "omega_2"}
    grid = {"k": np.linspace(3000, 20000, 4), "omega_2": [80.0, 82.0]}
    _agree(*_both(grid, initial=initial))
    # Wheels whose speeds are so far apart cross again and again.
    rows = Table(k=[3000.0, 20000.0], omega_2=[75.0, 90.0])
    one, other = _both(
        rows, {**MEASURES, "crosses": event_count("clutch", "cross")}, initial=initial
    )
    _agree(one, other)
    assert (one["crosses"] == other["crosses"]).all()
    assert (one["crosses"] > 90).all()


def test_the_loop_does_these_runs_itself() -> None:
    loop = _batch_of(("k", "demand"), MEASURES, _demand)
    _, left = loop([(8600.0, 1000.0), (8600.0, 900.0)])
    assert loop.statuses == {0: 2}
    assert not left


def test_demands_by_a_function_of_a_runs_numbers() -> None:
    grid = {"k": [4300.0, 8600.0, 17200.0], "demand": np.linspace(0.0, 1400.0, 5)}
    _agree(*_both(grid, inputs=_demand))


def test_inputs_whose_sizes_are_swept() -> None:
    """Chains of every kind: a lag, an oscillation, a polynomial; one signal beside what is held."""
    grid = {"k": [4300.0, 8600.0], "demand": [0.0, 700.0, 1400.0], "drive": [-1.0, 2.5]}
    swing = Sine(40.0, 3.0, phase=0.4, offset=10.0) + Ramp(0.2, 30.0)
    inputs = {"tau_e": Swept("drive", swing), "tau_h": Swept("demand", Lag(Step(0.5, 1.0), 0.04))}

    def by_run(values: Mapping[str, float]) -> dict[str, Any]:
        slow = Sine(values["drive"] * 40.0, 3.0, 0.4, values["drive"] * 10.0)
        return {"tau_e": slow + Ramp(0.2, values["drive"] * 30.0), **_only_demand(values)}

    one, other = _both(grid, inputs=inputs)
    _agree(one, other)
    _agree(one, sweep(_family("c"), grid, TIMES, MEASURES, CASE.initial, by_run, progress=False))
    assert len(set(one["peak"].round(6))) == 12


def _only_demand(values: Mapping[str, float]) -> dict[str, Any]:
    return {"tau_h": Lag(Step(0.5, values["demand"]), 0.04)}


def test_initial_values_by_a_function() -> None:
    def initial(values: Mapping[str, float]) -> dict[str, float]:
        return {**CASE.initial, "omega_1": 80.0 + values["more"]}

    _agree(*_both({"more": [-4.0, 0.0, 4.0]}, initial=initial))


def test_constant_inputs() -> None:
    _agree(*_both({"tau_h": [0.0, 200.0, 900.0], "k": [5000.0, 9000.0]}, inputs={"tau_e": 100.0}))


def test_runs_that_are_refused_tell_why_and_the_others_go_on() -> None:
    rows = Table(k=[8600.0, 0.0, 9000.0, 8600.0], I_w=[0.8, 0.8, 0.0, 0.9])
    one, other = _both(rows)
    assert one.failed == other.failed
    assert [failure.run for failure in one.failed] == [1, 2]
    done = [0, 3]
    assert one["peak"][done] == pytest.approx(other["peak"][done], rel=1e-9)
    negative = {"k": [8600.0], "demand": [-100.0, 100.0]}
    one, other = _both(negative, {"peak": peak("tau_k1")}, inputs=_demand)
    assert one.failed == other.failed
    assert len(one.failed) == 1


def last(result: Result) -> float:
    """A measure of the caller's own."""
    return float(result["omega_f"][-1])


def test_other_measures_are_taken_the_usual_way() -> None:
    mixed = {**MEASURES, "last": last}
    assert _batch_of(("k",), mixed) is None
    assert _batch_of(("k",), {"no": peak("no_such_signal")}) is None
    one, other = _both({"k": [8600.0, 9000.0]}, mixed, workers=1)
    _agree(one, other)
    assert one["last"] == pytest.approx(other["last"], abs=1e-9)


def test_a_driven_storage_and_a_model_without_friction() -> None:
    times = np.linspace(0.0, 0.1, 41)
    given = {"inputs": LOCKING["inputs"], "initial": LOCKING["initial"], "progress": False}
    rigid = {b: Family(f.equations, f.parameters, f.laws, b) for b in ("c", "numpy")
             for f in [locking()]}  # fmt: skip
    measures = {"stick": first_event("clutch", "stick"), "peak": peak("tau_f")}
    found = [sweep(rigid[b], {"c": [500.0, 750.0]}, times, measures, workers=0, **given)
             for b in rigid]  # fmt: skip
    for name in measures:
        assert found[0][name] == pytest.approx(found[1][name], rel=1e-9, abs=1e-9)
    plain = spring_mass()
    fast = Family(plain.equations, plain.parameters, plain.laws, "c")
    ends = {"speed": final("v"), "force": peak("F")}
    grid = {"k": [1.0, 8.0], "v": [0.0, 1.0], "P": [0.0, 2.0]}
    one, other = (sweep(f, grid, times, ends, workers=0, progress=False) for f in (fast, plain))
    for name in ends:
        assert one[name] == pytest.approx(other[name], rel=1e-9, abs=1e-12)


def test_threads_and_chunks_change_no_number() -> None:
    grid = {"k": np.linspace(4000, 16000, 40)}
    given: dict[str, Any] = {"initial": CASE.initial, "inputs": CASE.inputs, "progress": False}
    results: list[Array] = [
        sweep(_family("c"), grid, TIMES, MEASURES, workers=n, chunk=size, **given)["samples"]
        for n, size in ((0, None), (2, 3), (3, 40))
    ]
    assert (results[0] == results[1]).all()
    assert (results[0] == results[2]).all()
