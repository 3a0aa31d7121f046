"""The loop over runs in C on models with switches against single runs in numpy."""

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from oracles.switching import CASES, Case, case, equations
from soak.families import whole

from bondgraph import ModelWarning
from codegen import Family, event_count, final, first_event, samples, sweep
from codegen.sweeps.job import Job
from codegen.sweeps.measuring import batch_of

pytestmark = pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")

SLICE = ("contactor and diode", "dog clutch, by an input", "dog clutch beside a brake")
"""Looked at every time: two kinds of condition, ``initially_on``, friction."""


def _swept(name: str, initial: dict[str, float], on: tuple[Any, ...] | None = None) -> None:
    """Every column at every sample, how often and when what changes over; three values of a parameter."""
    one: Case = case(name)
    at = next(iter(one.parameters))
    table = np.array([[one.parameters[at] * factor] for factor in (1.0, 0.9, 1.2)])
    family = Family(equations(name), one.parameters, one.laws, "c")
    kinds = ("on", "off", "stick", "slip")
    ports = [port.name for port in family.program.friction]
    measures: dict[str, Any] = {f"{s}": samples(s) for s in family.states}
    measures |= {f"end of {s}": final(s) for s in family.states}
    for port in ports:
        measures |= {f"{port} {kind}": event_count(port, kind) for kind in kinds}
        measures |= {f"{port} first {kind}": first_event(port, kind) for kind in kinds}
    begun = one.initially_on if on is None else on
    job = Job(family, (at,), one.times, measures, initial, one.inputs, initially_on=begun)
    loop = batch_of(job)
    assert loop is not None
    columns, left = loop(table)
    assert left == []
    single = Family(equations(name), one.parameters, one.laws)
    for k, (value,) in enumerate(table.tolist()):
        run = single.simulator(**{at: value}).run_telling(
            pytest.fail, one.times, initial, one.inputs, initially_on=begun
        )
        for (what, measure), column in zip(measures.items(), columns, strict=True):
            expected = np.asarray(measure(run))
            span = max(float(np.ptp(run[what])), 1e-3) if what in family.states else 1.0
            assert column[k] == pytest.approx(expected, abs=1e-9 * span, nan_ok=True), (what, value)


@pytest.mark.parametrize("name", CASES if whole("switches-swept") else SLICE)
def test_sweeps_are_single_runs(name: str) -> None:
    if name in ("friction behind a moving ratio", "dog clutch behind a moving ratio"):
        pytest.skip("runs of these keep to the tolerance, not to rounding: see the located loop")
    _swept(name, dict(case(name).initial))


@pytest.mark.parametrize("on", [("dog",), ()], ids=["on", "off"])
def test_a_start_is_completed_as_in_a_run(on: tuple[str, ...]) -> None:
    """Only v_1 is named: while the dog holds, v_2 follows it from the first sample on."""
    name = "dog clutch, by an input"
    _swept(name, {"v_1": 4.0}, on)
    one = case(name)
    family = Family(equations(name), one.parameters, one.laws, "c")
    job = Job(family, ("m_2",), one.times, {"v": samples("v_2")}, {"v_1": 4.0}, one.inputs,
              initially_on=on)  # fmt: skip
    loop = batch_of(job)
    assert loop is not None
    (column,), _ = loop(np.array([[3.0]]))
    assert column[0][0] == pytest.approx(0.0 if on else 4.0, abs=1e-12)


@pytest.mark.parametrize(("backend", "method"), [("numpy", "auto"), ("c", "auto"), ("c", "DOP853")])
def test_a_sweep_tells_once_of_starts_that_were_completed(
    backend: str, method: str, tmp_path: Path
) -> None:
    """While the dog holds, v_2 is v_1, which is swept: 4 and 2 m/s; a start of 0 moves nothing."""
    name = "dog clutch, by an input"
    one = case(name)
    family = Family(equations(name), one.parameters, one.laws, backend)
    given = (one.times, {"v": final("v_2")}, None, one.inputs)
    kept = {"method": method, "workers": 0, "progress": False, "store": tmp_path / "runs"}
    for _ in range(2):  # the second time from the store
        with pytest.warns(
            ModelWarning, match="in 2 of 3 runs states .*: v_2; completed has"
        ) as told:
            found = sweep(family, {"v_1": [4.0, 0.0, 2.0]}, *given, **kept)
        assert len(told) == 1
        assert {at: dict(own) for at, own in found.completed.items()} == {
            0: pytest.approx({"v_2": 4.0}), 2: pytest.approx({"v_2": 2.0})
        }  # fmt: skip
    quiet = sweep(family, {"v_1": [4.0], "v_2": [4.0]}, *given, workers=0, progress=False)
    assert quiet.completed == {}
