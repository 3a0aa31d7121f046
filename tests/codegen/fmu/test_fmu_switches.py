"""Units with switches against the toolkit's own runs: each kind of guard, impacts, friction beside them."""

import warnings
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from oracles.called import Unit
from oracles.switched_units import SWITCHED, SwitchedCase, dog, joined, passing, rectifier
from oracles.units import sampled, simulated
from soak.families import whole

import bondgraph as bg
import codegen

pytestmark = pytest.mark.usefixtures("compiled_quickly")

VERSIONS = ["2.0", "3.0"]

#: Every case has one version of FMI in turn, unless all are asked for.
PAIRS = [
    (name, version)
    for at, name in enumerate(SWITCHED)
    for version in (VERSIONS if whole("units") else [VERSIONS[at % 2]])
]


class Pair:
    """A case, its run by numpy, and its unit."""

    def __init__(self, name: str, version: str, folder: Path) -> None:
        self.case: SwitchedCase = SWITCHED[name]()
        self.expected = self.case.run(101)
        self.names = [str(e) for e in dict.fromkeys(e.port for e in self._switchings)]
        self.path = self.case.written(folder / version / f"{name}.fmu", version)

    @property
    def _switchings(self) -> list[codegen.Event]:
        return [event for event in self.expected.events if event.kind in ("on", "off")]

    @property
    def times(self) -> list[float]:
        return sorted(event.time for event in self._switchings)

    def check(self, found, samples: int, bound: float) -> None:
        """States and switches at every sample, of the largest magnitude."""
        step = 100 // (samples - 1)
        at = sampled(found, self.case, samples)
        for name in self.expected.states:
            right = self.expected[name]
            assert at[name] == pytest.approx(right[::step], abs=bound * np.abs(right).max()), name
        for name in self.names:
            assert at[name].tolist() == self.expected[name][::step].tolist(), name


@pytest.fixture(scope="module", params=PAIRS, ids=str)
def pair(
    request: pytest.FixtureRequest,
    tmp_path_factory: pytest.TempPathFactory,
    compiled_quickly: None,
) -> Iterator[Pair]:
    with warnings.catch_warnings():
        # A case is completed at its start, which is told; its own test asks for that.
        warnings.simplefilter("ignore", bg.ModelWarning)
        yield Pair(*request.param, tmp_path_factory.mktemp("switched"))


def test_model_exchange_switches_where_the_simulator_does(pair: Pair) -> None:
    output = [*pair.expected.states, *pair.names]
    found = simulated(pair.path, "ModelExchange", pair.case, output, 101)
    pair.check(found, 101, 1e-6)
    changes = [t for name in pair.names for t in found["time"][1:][np.diff(found[name]) != 0]]
    assert len(pair.times) > 0
    assert sorted(changes) == pytest.approx(pair.times, abs=1e-6)


@pytest.mark.parametrize("samples", [101, 11])
def test_co_simulation_locates_events_at_any_communication_step(pair: Pair, samples: int) -> None:
    output = [*pair.expected.states, *pair.names]
    found = simulated(pair.path, "CoSimulation", pair.case, output, samples)
    pair.check(found, samples, 1e-9)


@pytest.mark.parametrize("step", [0.5, 6.0])
def test_co_simulation_locates_what_dips_inside_a_step(step: float, tmp_path: Path) -> None:
    """Between x = 0.4 - d and 0.4 + d nothing flows."""
    unit = Unit(passing(), "3.0", tmp_path)
    made = unit.started("CoSimulation")
    for k in range(round(6.0 / step)):
        _step(made, k * step, step)
    assert unit.get(made, "q") == pytest.approx([_charge(1e-3)], abs=1e-8)
    unit.free(made)


def test_a_condition_of_time_that_dips_makes_events_of_model_exchange(tmp_path: Path) -> None:
    """The importer's own steps would pass over all of them."""
    case = passing(by_time=True)
    found = simulated(case.written(tmp_path / "unit.fmu", "3.0"), "ModelExchange", case, ["q"], 7)
    assert found["q"][-1] == pytest.approx(_charge(1e-3), abs=1e-12)


def _charge(d: float) -> float:
    """Until t = 6, where sin 3 t has passed from 0.4 - d to 0.4 + d six times, up or down."""
    return 6.0 - 6 * (np.arcsin(0.4 + d) - np.arcsin(0.4 - d)) / 3


@pytest.mark.parametrize("version", VERSIONS)
def test_an_impact_moves_the_states_at_an_event_of_the_importers(
    version: str, tmp_path: Path
) -> None:
    """w_1 = 3 and w_2 = -1 meet: J_1 w_1 + J_2 w_2 is kept, and the importer is told."""
    unit = Unit(dog(), version, tmp_path, inputs={"out": 1, "T": 0}, initial={"w1": 3, "w2": -1})
    made = unit.started("ModelExchange")
    assert unit.get(made, "w1", "w2").tolist() == [3.0, -1.0]
    made.enterEventMode()
    unit.put(made, out=-1.0)
    told = made.newDiscreteStates if version == "2.0" else made.updateDiscreteStates
    assert told()[3] == 1
    assert unit.get(made, "w1", "w2") == pytest.approx([1.0, 1.0], rel=1e-12)
    assert _integers(unit, made, "slack", "mode(br)") == [0, 1]
    made.enterContinuousTimeMode()
    assert unit.get(made, "der(w1)", "der(w2)") == pytest.approx([-0.5, -0.5], rel=1e-12)
    made.enterEventMode()
    assert told()[3] == 0
    unit.free(made)


def test_an_importer_commands_a_switch_between_steps(tmp_path: Path) -> None:
    """Joined from 1 to 2 s: the speeds of closed form, the brake of level 1 on the second shaft."""
    unit = Unit(dog(), "3.0", tmp_path, inputs={"out": 1, "T": 0}, initial={"w1": 4, "w2": 2})
    made = unit.started("CoSimulation")
    made.doStep(currentCommunicationPoint=0.0, communicationStepSize=1.0)
    assert unit.get(made, "w1", "w2") == pytest.approx([4.0, 1.0], rel=1e-12)
    unit.put(made, out=-1.0)
    made.doStep(currentCommunicationPoint=1.0, communicationStepSize=1.0)
    assert unit.get(made, "w1", "w2") == pytest.approx([2.0, 2.0], rel=1e-12)
    assert _integers(unit, made, "slack") == [0]
    unit.put(made, out=1.0)
    made.doStep(currentCommunicationPoint=2.0, communicationStepSize=3.0)
    assert unit.get(made, "w1", "w2") == pytest.approx([2.0, 0.0], abs=1e-12)
    assert _integers(unit, made, "slack", "mode(br)") == [1, 0]
    unit.free(made)


@pytest.mark.parametrize("version", VERSIONS)
def test_a_state_saved_while_a_diode_conducts_goes_on_as_the_first_time(
    version: str, tmp_path: Path
) -> None:
    unit = Unit(rectifier(), version, tmp_path)
    made, other = unit.started("CoSimulation"), unit.started("CoSimulation")
    _step(made, 0.0, 0.003)
    assert _integers(unit, made, "d") == [1]
    state = made.getFMUstate() if version == "2.0" else made.getFMUState()
    packed = (made.serializeFMUstate if version == "2.0" else made.serializeFMUState)(state)
    first = [(_step(made, 0.003 + k * 1e-3, 1e-3), unit.get(made, "v", "f_d")) for k in range(30)]
    read = other.deSerializeFMUstate if version == "2.0" else other.deserializeFMUState
    for again in (made, other):
        put = again.setFMUstate if version == "2.0" else again.setFMUState
        put(state if again is made else read(packed))
        assert _integers(unit, again, "d") == [1]
        for k in range(30):
            _step(again, 0.003 + k * 1e-3, 1e-3)
            assert unit.get(again, "v", "f_d").tolist() == first[k][1].tolist()
    unit.free(made, other)


def test_a_start_is_completed_unless_the_importer_sets_it(tmp_path: Path) -> None:
    """The gear holds w_1/3 = w_2; of two that contradict each other the momentum is shared."""
    unit = Unit(joined(), "3.0", tmp_path)
    made = unit.started("ModelExchange")
    assert unit.get(made, "w1", "w2") == pytest.approx([3.0, 1.0], rel=1e-14)
    other = unit.started("ModelExchange", w2=0.0)
    # The impulse P at the dog: 2 w_1 = 6 - P/3 and w_2 = P, where w_1 = 3 w_2.
    assert unit.get(other, "w1", "w2") == pytest.approx([54 / 19, 18 / 19], rel=1e-12)
    unit.free(made, other)


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("kind", ["ModelExchange", "CoSimulation"])
def test_a_start_that_is_completed_is_logged_once(
    version: str, kind: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """As a warning, which changes no status; nothing where the importer names what would follow."""
    unit = Unit(joined(), version, tmp_path)
    categories = [one.name for one in unit.description.logCategories or []]
    capfd.readouterr()
    made = unit.started(kind)
    told = capfd.readouterr().out
    assert told.count("states that were not set follow what switches hold: w2 = 1") == 1
    assert "warning" in told.lower()
    other = unit.started(kind, w2=0.0)
    assert "follow" not in capfd.readouterr().out
    unit.free(made, other)
    assert not categories or "logStatusWarning" in categories


def test_a_condition_of_time_alone_is_an_event_at_its_instant(tmp_path: Path) -> None:
    unit = Unit(joined(), "2.0", tmp_path)
    made = unit.started("ModelExchange")
    t = 0.0
    while t < 0.999:
        made.setTime(t)
        made.enterEventMode()
        _, _, _, _, planned, following = made.newDiscreteStates()
        assert planned == 1
        assert following > t
        t = following
    assert t == pytest.approx(1.0, abs=4e-16)
    unit.free(made)


def test_switches_that_are_not_there_are_refused(tmp_path: Path) -> None:
    with pytest.raises(bg.BondGraphError, match="nobody"):
        dog().written(tmp_path / "unit.fmu", "2.0", initially_on=["nobody"])


def _step(made, t: float, h: float) -> None:
    made.doStep(currentCommunicationPoint=t, communicationStepSize=h)


def _integers(unit: Unit, made, *names: str) -> list[int]:
    get = made.getInteger if unit.version == "2.0" else made.getInt32
    return list(get([unit.at[name] for name in names]))
