"""Sampled tasks in units: instants are time events, or parts of a communication step; each is set once."""

from pathlib import Path

import numpy as np
import pytest
from oracles.called import Unit
from oracles.ticked import END, case, check, counter
from oracles.units import sampled, simulated

VERSIONS = ("2.0", "3.0")

pytestmark = pytest.mark.usefixtures("compiled_quickly")


@pytest.fixture(scope="module", params=VERSIONS)
def unit(
    request: pytest.FixtureRequest,
    tmp_path_factory: pytest.TempPathFactory,
    compiled_quickly: None,
) -> Unit:
    return Unit(counter(), str(request.param), tmp_path_factory.mktemp("counter"))


@pytest.mark.parametrize("version", VERSIONS)
def test_importers_run_a_loop_as_its_segments_are(version: str, tmp_path: Path) -> None:
    """Of model exchange and co-simulation, with samples between instants and on each of them."""
    loop = case()
    path = loop.written(tmp_path / "loop.fmu", version)
    for kind in ("ModelExchange", "CoSimulation"):
        for samples in (36, 121):
            told = simulated(path, kind, loop, ["i", "omega", "V", "z", "stamp"], samples, 1e-12)
            check(sampled(told, loop, samples), np.linspace(0, END, samples))


def _update(unit: Unit, made) -> tuple[bool, float]:
    """An event; whether another is planned, and when."""
    made.enterEventMode()
    if unit.version == "2.0":
        _, _, _, _, planned, time = made.newDiscreteStates()
    else:
        _, _, _, _, planned, time = made.updateDiscreteStates()
    made.enterContinuousTimeMode()
    return bool(planned), time


def test_instants_are_time_events(unit: Unit) -> None:
    made = unit.started("ModelExchange")
    # The start is one, and a second update there is not.
    assert unit.get(made, "n", "seen").tolist() == [1, 3]
    times = []
    for k in range(2, 12):
        planned, time = _update(unit, made)
        assert planned
        times.append(time)
        made.setTime(time / 2)
        assert unit.get(made, "n") == k - 1
        made.setTime(time)
        _update(unit, made)
        assert unit.get(made, "n", "stamp").tolist() == [k, time]
    assert times == [k / 10 for k in range(1, 11)]
    unit.free(made)


def test_an_event_a_rounding_early_is_the_instant(unit: Unit) -> None:
    """As of an importer whose own times are sums; one that is late has what it missed done once."""
    made = unit.started("ModelExchange")
    made.setTime(float(np.nextafter(0.1, 0)))
    assert _update(unit, made) == (True, 0.2)
    made.setTime(0.1)
    assert _update(unit, made) == (True, 0.2)
    assert unit.get(made, "n") == 2
    made.setTime(0.45)
    assert _update(unit, made) == (True, 0.5)
    assert unit.get(made, "n", "stamp").tolist() == [3, 0.45]
    unit.free(made)


def _state(unit: Unit, made):
    return made.getFMUstate() if unit.version == "2.0" else made.getFMUState()


def _back(unit: Unit, made, state, packed: bool) -> None:
    if unit.version == "2.0":
        made.setFMUstate(
            made.deSerializeFMUstate(made.serializeFMUstate(state)) if packed else state
        )
    else:
        made.setFMUState(
            made.deserializeFMUState(made.serializeFMUState(state)) if packed else state
        )


STEPS = {
    "ends at each instant": (0.1, 10),
    "ends at each, by sums": (0.025, 40),
    "ends at some": (0.15, 6),
    "passes several": (0.4, 2),
}
"""Lengths of communication steps, and how many."""


@pytest.mark.parametrize("fixed", [0.0, 0.02], ids=["located", "fixed steps"])
@pytest.mark.parametrize(("step", "count"), STEPS.values(), ids=STEPS)
def test_steps_set_each_once(unit: Unit, step: float, count: int, fixed: float) -> None:
    made = unit.started("CoSimulation", fixed_internal_step=fixed)
    assert unit.get(made, "n") == 1
    time, told, right = 0.0, [], []
    for _ in range(count):
        made.doStep(currentCommunicationPoint=time, communicationStepSize=step)
        time += step
        told.append(unit.get(made, "n")[0])
        right.append(np.floor(time / 0.1 + 1e-9) + 1)
    assert told == right
    unit.free(made)


@pytest.mark.parametrize("fixed", [0.0, 0.02], ids=["located", "fixed steps"])
@pytest.mark.parametrize("packed", [False, True], ids=["kept", "packed"])
def test_a_state_gone_back_to_knows_what_was_set(unit: Unit, fixed: float, packed: bool) -> None:
    """At an instant that was set, and just before one that was not."""
    made = unit.started("CoSimulation", fixed_internal_step=fixed)
    for begin, step, before, after in ((0.0, 0.1, 2, 3), (0.1, 0.09, 2, 3)):
        made.doStep(currentCommunicationPoint=begin, communicationStepSize=step)
        state, end = _state(unit, made), begin + step
        for _ in range(2):
            assert unit.get(made, "n") == before
            made.doStep(currentCommunicationPoint=end, communicationStepSize=0.2 - end)
            assert unit.get(made, "n") == after
            _back(unit, made, state, packed)
    unit.free(made)


def test_a_parameter_that_is_tuned_sets_nothing_again(unit: Unit) -> None:
    made = unit.started("CoSimulation")
    made.doStep(currentCommunicationPoint=0.0, communicationStepSize=0.1)
    unit.put(made, m=4.0)
    assert unit.get(made, "n") == 2
    made.doStep(currentCommunicationPoint=0.1, communicationStepSize=0.05)
    assert unit.get(made, "n") == 2
    unit.free(made)


def test_a_unit_that_is_reset_begins_again(unit: Unit) -> None:
    made = unit.started("CoSimulation")
    made.doStep(currentCommunicationPoint=0.0, communicationStepSize=0.3)
    assert unit.get(made, "n") == 4
    made.reset()
    if unit.version == "2.0":
        made.setupExperiment(startTime=0.2)
        made.enterInitializationMode()
    else:
        made.enterInitializationMode(startTime=0.2)
    made.exitInitializationMode()
    assert unit.get(made, "n", "stamp").tolist() == [1, 0.2]
    made.doStep(currentCommunicationPoint=0.2, communicationStepSize=0.15)
    assert unit.get(made, "n", "stamp").tolist() == [2, 0.3]
    unit.free(made)


@pytest.mark.parametrize("version", VERSIONS)
def test_fixed_steps_keep_the_instants(version: str, tmp_path: Path) -> None:
    loop = Unit(case(), version, tmp_path)
    names = ("i", "omega", "V", "z", "stamp")
    for samples in (25, 36):
        made, rows = loop.started("CoSimulation", fixed_internal_step=2e-4), []
        times = np.linspace(0, END, samples)
        for begin, end in zip(times, [*times[1:], 0], strict=True):
            rows.append(loop.get(made, *names))
            if end:
                made.doStep(currentCommunicationPoint=begin, communicationStepSize=end - begin)
        check(dict(zip(names, np.array(rows).T, strict=True)), times)
        loop.free(made)
