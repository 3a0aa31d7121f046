"""Units called by hand: saved states, several instances, tuning, refusals, sources."""

import ctypes
from pathlib import Path

import numpy as np
import pytest
from oracles.called import Unit
from oracles.units import divider

import codegen

VERSIONS = ["2.0", "3.0"]
ERROR = 3


pytestmark = pytest.mark.usefixtures("compiled_quickly")


def _stepped(unit: Unit, made, begin: int, count: int) -> np.ndarray:
    rows = []
    for k in range(begin, begin + count):
        made.doStep(currentCommunicationPoint=k * 0.01, communicationStepSize=0.01)
        rows.append(unit.get(made, "v", "F_s", "e_rub"))
    return np.array(rows)


def _saved(unit: Unit, made):
    return made.getFMUstate() if unit.version == "2.0" else made.getFMUState()


def _restored(unit: Unit, made, state) -> None:
    if unit.version == "2.0":
        made.setFMUstate(state)
    else:
        made.setFMUState(state)


def test_a_saved_state_goes_on_as_the_first_time(slider: Unit) -> None:
    made = slider.started("CoSimulation")
    _stepped(slider, made, 0, 90)
    state = _saved(slider, made)
    first = _stepped(slider, made, 90, 60)
    _restored(slider, made, state)
    assert np.array_equal(_stepped(slider, made, 90, 60), first)
    packed = (made.serializeFMUstate if slider.version == "2.0" else made.serializeFMUState)(state)
    other = slider.started("CoSimulation")
    read = other.deSerializeFMUstate if slider.version == "2.0" else other.deserializeFMUState
    _restored(slider, other, read(packed))
    assert np.array_equal(_stepped(slider, other, 90, 60), first)
    slider.free(made, other)


def test_instances_side_by_side_know_nothing_of_each_other(slider: Unit) -> None:
    alone = slider.started("CoSimulation", N=2.0)
    expected = _stepped(slider, alone, 0, 120)
    one, other = slider.started("CoSimulation", N=2.0), slider.started("CoSimulation")
    mixed = []
    for k in range(120):
        mixed.append(_stepped(slider, one, k, 1)[0])
        _stepped(slider, other, k, 1)
    assert np.array_equal(np.array(mixed), expected)
    slider.free(alone, one, other)


def test_a_parameter_may_be_tuned_between_steps(slider: Unit) -> None:
    made = slider.started("CoSimulation")
    _stepped(slider, made, 0, 50)
    slider.put(made, N=0.0, k=80.0)
    after = _stepped(slider, made, 50, 50)
    assert after[:, 2] == pytest.approx(0.0, abs=1e-12)
    energy = after[:, 0] ** 2 / 2 + after[:, 1] ** 2 / 160
    assert energy == pytest.approx(np.full(50, energy[0]), rel=1e-9)
    slider.free(made)


def test_what_a_unit_refuses_is_an_error_with_a_reason(slider: Unit) -> None:
    made = slider.started("CoSimulation")
    for values in ({"v": 1.0}, {"fixed_internal_step": 0.1}, {"e_rub": 1.0}, {"k": float("nan")}):
        with pytest.raises(Exception, match=r"(?i)set(Real|Float64)"):
            slider.put(made, **values)
    assert slider.get(made, "k") == pytest.approx([50.0])
    slider.free(made)


def test_calls_out_of_turn_are_refused(slider: Unit) -> None:
    """Initialization ends once; no events in co-simulation; steps and events in their modes alone."""
    made = slider.started("CoSimulation")
    for name in ("ExitInitializationMode", "EnterEventMode", "EnterContinuousTimeMode"):
        assert _status(slider, made, name) == ERROR, name
    _begin_again_is_refused(slider, made)
    made.doStep(currentCommunicationPoint=0.0, communicationStepSize=0.01)
    other = slider.started("ModelExchange")
    update = other.newDiscreteStates if slider.version == "2.0" else other.updateDiscreteStates
    with pytest.raises(Exception, match="DiscreteStates"):
        update()
    assert _status(slider, other, "EnterEventMode") == 0
    update()
    other.terminate()
    assert _status(slider, other, "EnterEventMode") == ERROR
    slider.free(made, other)


def _begin_again_is_refused(unit: Unit, made) -> None:
    time = {} if unit.version == "2.0" else {"startTime": 7.0}
    with pytest.raises(Exception, match="EnterInitializationMode"):
        made.enterInitializationMode(**time)


def _status(unit: Unit, made, name: str) -> int:
    """What a function without arguments returns, also one that belongs to the other kind of unit."""
    return int(made.dll[f"fmi{unit.version[0]}{name}"](ctypes.c_void_p(made.component)))


@pytest.mark.parametrize("version", VERSIONS)
def test_inputs_drive_a_state_by_their_rates(version: str, tmp_path: Path) -> None:
    """V = V_0 + r t through der(V): v_2' (C_1 + C_2) = C_1 r - v_2/R, from rest."""
    unit = Unit(divider(), version, tmp_path, inputs={}, initial={})
    made = unit.started("CoSimulation")
    unit.put(made, **{"der(V)": 2.0})
    for k in range(20):
        made.doStep(currentCommunicationPoint=k * 0.05, communicationStepSize=0.05)
    time_constant, final = 1.4 * 0.5, 1.4 * 0.3 * 2.0
    expected = [final * (1 - np.exp(-1.0 / time_constant)), 2.0]
    assert unit.get(made, "v_2", "V") == pytest.approx(expected, rel=1e-9)
    unit.free(made)


def test_a_source_ends_its_pieces_at_breakpoints(tmp_path: Path) -> None:
    """Model exchange is told of every breakpoint; steps of co-simulation end at them."""
    unit = Unit(divider(), "3.0", tmp_path, inputs={"V": codegen.Step(0.0123, 3.0)}, initial={})
    made = unit.started("ModelExchange")
    made.enterEventMode()
    _, _, _, _, planned, time = made.updateDiscreteStates()
    assert (planned, time) == (True, 0.0123)
    other = unit.started("CoSimulation")
    other.doStep(currentCommunicationPoint=0.0, communicationStepSize=0.1)
    expected = 3.0 * 0.6 * np.exp(-(0.1 - 0.0123) / 0.7)
    assert unit.get(other, "v_2") == pytest.approx([expected], rel=1e-9)
    unit.free(made, other)


def test_what_rises_from_zero_is_not_below_it_a_rounding_before(tmp_path: Path) -> None:
    """A friction level below zero is refused; a master's times are sums that may fall short."""
    rising = codegen.Lag(codegen.Step(0.4, 300.0), 0.04)
    unit = Unit(divider(), "3.0", tmp_path, inputs={"V": rising}, initial={})
    made = unit.started("ModelExchange")
    made.setTime(float(np.nextafter(0.4, 0.0)))
    made.enterEventMode()
    made.updateDiscreteStates()
    assert unit.get(made, "V").tolist() == [0.0]
    unit.free(made)
