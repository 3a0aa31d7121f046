"""Units with pulses inside: every instant is a time event, and no table holds them."""

import zipfile
from pathlib import Path

import numpy as np
import pytest
from oracles.called import Unit
from oracles.pulsed import coil, half_bridge
from oracles.units import Case
from references.pulsed import current, switchings

from codegen import PWM, Lag, Sine, Square, simulator

pytestmark = pytest.mark.usefixtures("compiled_quickly")

V, R, L, F, DUTY, PHASE = 24.0, 1.5, 1e-3, 23_456.7, 0.37, 0.6
TOLD = (V, R, L, F, DUTY, PHASE)
NUMBERS = {"L": L, "R": R}


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_model_exchange_is_told_of_every_instant(version: str, tmp_path: Path) -> None:
    gate = PWM(F, DUTY, phase=PHASE)
    case = Case(half_bridge(), NUMBERS, None, {}, {"V": V, "gate": gate}, 1e-3)
    unit = Unit(case, version, tmp_path)
    made = unit.started("ModelExchange")
    found, time = [], 0.0
    while time <= 1e-3:
        made.enterEventMode()
        *_, planned, time = (
            made.newDiscreteStates() if version == "2.0" else made.updateDiscreteStates()
        )
        assert planned
        made.enterContinuousTimeMode()
        made.setTime(time)
        found.append(time)
    assert found[:-1] == list(gate.within(0.0, 1e-3))
    unit.free(made)


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_co_simulation_is_the_periodic_solution(version: str, tmp_path: Path) -> None:
    """In communication steps that have nothing to do with the period."""
    initial = {"i": current(0.0, *TOLD)}
    case = Case(coil(), NUMBERS, None, initial, {"u": PWM(F, DUTY, 0.0, V, PHASE)}, 0.01)
    unit = Unit(case, version, tmp_path)
    made = unit.started("CoSimulation")
    for k in range(1, 38):
        made.doStep(currentCommunicationPoint=(k - 1) * 1.7e-4, communicationStepSize=1.7e-4)
        assert unit.get(made, "i")[0] == pytest.approx(current(k * 1.7e-4, *TOLD), abs=1e-8)
    unit.free(made)


def test_lags_and_moving_duties_inside(tmp_path: Path) -> None:
    drive = Lag(Square(2e3, -1.0, V, 0.2), 2e-4) + PWM(9e3, Sine(0.6, 200.0, offset=0.5))
    unit = Unit(Case(coil(), NUMBERS, None, {}, {"u": drive}, 0.01), "3.0", tmp_path)
    made, times = unit.started("CoSimulation"), np.linspace(0.0, 0.01, 24)
    run = simulator(coil(), NUMBERS).run(times, {}, {"u": drive})
    for k, step in enumerate(np.diff(times).tolist()):
        made.doStep(currentCommunicationPoint=times[k], communicationStepSize=step)
        assert unit.get(made, "i")[0] == pytest.approx(run["i"][k + 1], abs=1e-8)
    unit.free(made)


def test_a_megahertz_takes_no_room(tmp_path: Path) -> None:
    """Its text is as long as that of a hertz, but for the digits."""
    sizes = []
    for f in (1.0, 1e6):
        case = Case(coil(), NUMBERS, None, {}, {"u": PWM(f, DUTY)}, 0.01)
        with zipfile.ZipFile(case.written(tmp_path / f"{f:g}" / "unit.fmu", "3.0")) as archive:
            sizes.append(len(archive.read("sources/fmu_model.c")))
    assert abs(sizes[0] - sizes[1]) < 20
    assert switchings(0.0, 10.0, 1e6, DUTY, 0.0) == 20_000_000
