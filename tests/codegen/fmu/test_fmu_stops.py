"""Units with stops: located by an importer, by co-simulation itself, and in fixed internal steps."""

from pathlib import Path

import numpy as np
import pytest
from oracles.called import Unit
from oracles.stops import Stopped, dropped, flight, rotor, struck
from oracles.units import Case, sampled, simulated

pytestmark = pytest.mark.usefixtures("compiled_quickly")


def _case(stopped: Stopped) -> Case:
    end = float(stopped.times[-1])
    return Case(stopped.equations, stopped.numbers, None, stopped.initial, stopped.inputs, end)


CASES = {
    "plastic": dropped(0.0, end=3.0), "bouncing": dropped(0.8, end=3.0),
    "elastic": dropped(1.0, end=3.0), "row": struck(5, 2), "clutch": rotor(),
}  # fmt: skip

VERSIONS = {"plastic": "2.0", "bouncing": "3.0", "elastic": "2.0", "row": "3.0", "clutch": "2.0"}
"""Each case has one version of FMI."""


@pytest.fixture(scope="module", params=CASES)
def named(request: pytest.FixtureRequest, tmp_path_factory, compiled_quickly):
    """A unit, and the run of its model by numpy."""
    stopped, version = CASES[request.param], VERSIONS[request.param]
    case = _case(stopped)
    path = tmp_path_factory.mktemp("stops") / version / f"{request.param}.fmu"
    return request.param, case, case.written(path, version), stopped.run("numpy")


@pytest.mark.parametrize(("kind", "bound"), [("ModelExchange", 2e-6), ("CoSimulation", 1e-10)])
def test_units_bounce_as_the_simulator(named, kind: str, bound: float) -> None:
    """States at every sample, of the largest magnitude."""
    name, case, path, expected = named
    samples = len(CASES[name].times)
    found = sampled(simulated(path, kind, case, expected.states, samples), case, samples)
    for state in expected.states:
        right = expected[state]
        size = max(np.abs(right).max(), 1e-3)
        assert found[state] == pytest.approx(right, abs=bound * size), state


def test_long_communication_steps_pass_no_stop(tmp_path: Path) -> None:
    """Two steps of 1.5 s over bounces whose closed form is known."""
    unit = Unit(_case(dropped(0.8, end=3.0)), "3.0", tmp_path)
    made = unit.started("CoSimulation")
    for k in range(2):
        made.doStep(1.5 * k, 1.5)
    assert unit.get(made, "q_floor")[0] == pytest.approx(flight(0.8, 1.0, np.array([3.0]))[0])
    unit.free(made)


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_fixed_internal_steps_neither_pass_nor_hover(version: str, tmp_path: Path) -> None:
    """The error falls with the step; nothing is ever below the floor; an elastic ball keeps its energy."""
    errors = []
    for at, h in enumerate((4e-3, 2e-3, 1e-3)):
        (tmp_path / f"steps_{at}").mkdir()
        unit = Unit(_case(dropped(1.0, end=3.0)), version, tmp_path / f"steps_{at}")
        made = unit.started("CoSimulation", fixed_internal_step=h)
        rows = [unit.get(made, "q_floor", "v")]
        for k in range(300):
            made.doStep(0.01 * k, 0.01)
            rows.append(unit.get(made, "q_floor", "v"))
        unit.free(made)
        q, v = np.array(rows).T
        errors.append(np.abs(q - flight(1.0, 1.0, np.linspace(0.0, 3.0, 301))).max())
        assert q.min() >= 0.0
        assert v**2 / 2 + 9.81 * q == pytest.approx(9.81, rel=1e-9)
    assert errors[-1] < 0.01
    assert errors[-1] < errors[0] / 2


def test_what_does_not_bounce_rests_in_fixed_steps(tmp_path: Path) -> None:
    unit = Unit(_case(dropped(0.5, end=3.0)), "3.0", tmp_path)
    made = unit.started("CoSimulation", fixed_internal_step=1e-3)
    for k in range(30):
        made.doStep(0.1 * k, 0.1)
    place, speed, effort = unit.get(made, "q_floor", "v", "e_floor_low")
    assert (place, speed) == (0.0, 0.0)
    assert effort == pytest.approx(-2 * 9.81)
    unit.free(made)


@pytest.mark.parametrize("kind", ["ModelExchange", "CoSimulation"])
def test_a_start_beyond_a_bound_is_refused(kind: str, tmp_path: Path) -> None:
    unit = Unit(_case(dropped(0.5, end=3.0)), "3.0", tmp_path)
    with pytest.raises(Exception, match="fmi3"):
        unit.started(kind, q_floor=-0.5)
