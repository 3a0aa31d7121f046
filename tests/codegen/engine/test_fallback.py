"""What compiled C cannot go on with is run by numpy, and whoever asked for C is told so."""

import re

import numpy as np
import pytest
from oracles.models import block
from oracles.units import belt

import bondgraph as bg
from codegen import BackendWarning, Family, Result, simulator, sweep
from codegen.c.runtime import runtime_file, runtime_names
from codegen.engine import runs
from codegen.engine.handing import Handing
from codegen.engine.status import Status
from codegen.taking import located

CASE = belt()
TIMES = np.linspace(0.0, 1.6, 6)
"""It sticks, slips and sticks."""


@pytest.fixture
def little_room(monkeypatch: pytest.MonkeyPatch) -> None:
    """C has room for one event, on a machine that lets no code be made by which to hand it over."""

    def dumb(self: Handing, ffi: object) -> None:
        self.call = self.failed = None

    monkeypatch.setattr(Handing, "__init__", dumb)
    monkeypatch.setattr(located, "FEW", 1)
    monkeypatch.setattr(located, "MANY", 1)


def test_a_run_with_too_many_events_is_numpy_s_and_says_so(little_room: None) -> None:
    fast = simulator(CASE.equations, CASE.parameters, CASE.laws, backend="c")
    with pytest.warns(BackendWarning, match="more events than there is room for, at 0.97") as told:
        found = fast.run(TIMES, CASE.initial, CASE.inputs)
    assert found.backend == "numpy"
    expected = simulator(CASE.equations, CASE.parameters, CASE.laws).run(
        TIMES, CASE.initial, CASE.inputs
    )
    assert found.events == expected.events
    assert len(found.events) > 2
    assert [one.filename for one in told] == [__file__]


def test_a_method_that_c_has_not() -> None:
    pytest.importorskip("sksundae")
    fast = simulator(CASE.equations, CASE.parameters, CASE.laws, backend="c")
    with pytest.warns(BackendWarning, match="C has no method 'CVODE'"):
        assert fast.run(TIMES[:2], CASE.initial, CASE.inputs, "CVODE").backend == "numpy"


def test_what_numpy_refuses_too_is_refused_without_a_warning() -> None:
    ready = simulator(bg.derive(block()), {"m": 1.0}, backend="c")
    with pytest.raises(bg.SimulationError, match=r"negative|below zero"):
        ready.run(TIMES, {"v": 1.0}, {"P": 1.0, "F_c": -1.0})


def last(result: Result) -> float:
    return float(result["v"][-1])


def test_a_sweep_says_it_once(little_room: None) -> None:
    family = Family(CASE.equations, CASE.parameters, CASE.laws, "c")
    with pytest.warns(BackendWarning) as told:
        found = sweep(
            family, {"k": [40.0, 50.0, 60.0]}, TIMES[:5], {"end": last}, CASE.initial, CASE.inputs,
            workers=0, progress=False,
        )  # fmt: skip
    assert not found.failed
    (one,) = told
    assert re.search(r"numpy did 3 of 3 runs.*3 of them: more events than", str(one.message))
    assert one.filename == __file__


def test_every_end_of_the_engine_has_a_meaning() -> None:
    names = (*runtime_names("exact"), "run_loop.c")
    named = {name for file in names for name in re.findall(r"\bBG_(\w+)", runtime_file(file))}
    # Where no mode is consistent, stops are struck without end, or resets contradict, `bg_choose` says so.
    chosen = {"UNDECIDED", "STRUCK", "SET_TWICE", "SET_HELD", "SET_ENDLESSLY"}
    ends = {status for status in Status if status.name in named | chosen}
    # The loop of all runs knows a bad level, which exact steps call a negative one.
    ends -= {Status.OK, Status.BLUNT, Status.BAD_FRICTION}
    assert set(runs.MEANINGS) == ends > runs.LIMITS
