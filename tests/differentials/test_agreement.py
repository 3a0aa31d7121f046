"""Whatever is generated says the same: simulators, exported Python and C, functional mock-up units.

Every differential in its own scenario; every scenario of the paper's figures for the simulator's backends,
and for all the rest, too, with BONDGRAPH_SOAK_AGREEMENTS=1. What takes its time in Python runs through a
scenario whose steps come soon. `make bench-agreement` prints the figures.
"""

from collections.abc import Callable, Iterator
from functools import cache

import numpy as np
import pytest
from oracles.apart import Apart, apart, order
from oracles.methods import EVERY, LOCATED, OWN, STEPPED, Made, Outcome, changes
from soak.families import whole

from codegen.fmu import binaries
from codegen.runs.track import Event
from differentials.prepared import SAMPLE

CHOSEN = EVERY if whole("agreements") else tuple(OWN.items())

SAME, ALIKE = 1e-9, 1e-6
"""Of a signal's range, and s for events: where the method is the same, and where it is another one."""

IN_PROCESS = [name for name in LOCATED if "FMI" not in name and name != "numpy exact"]

FINE = ("alsd",)
"""Where fixed steps are a third of a millisecond, no binary or decimal fraction; elsewhere a whole one."""

FUSED = ("passive_input_shaft", "alsd", "four_wheel_drive_tvd")
"""With no, one and two clutches: their C is optimised as for users, that of others compiled in no time."""


@pytest.fixture(autouse=True, scope="module")
def _compiled_quickly() -> Iterator[None]:
    """Units, which run for a moment, in no time."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(binaries, "words", lambda name: ("-O0",))
        yield


Making = Callable[[str, str], Made]


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Making:
    """A differential in a scenario, once for all tests that ask for it."""
    folder, pairs = tmp_path_factory.mktemp("made"), {}
    return cache(lambda name, scenario: Made(name, scenario, folder, pairs))


@pytest.fixture(scope="module")
def soon(tmp_path_factory: pytest.TempPathFactory, made: Making) -> Making:
    """The same with steps that come soon; the scenario itself where all is asked for."""
    if whole("agreements"):
        return made
    folder, pairs = tmp_path_factory.mktemp("soon"), {}
    return cache(lambda name, scenario: Made(name, scenario, folder, pairs, brief=True))


def _few(name: str) -> int:
    """Fixed steps for each sample."""
    return 3 if name in FINE or whole("agreements") else 1


def _fused(name: str, scenario: str) -> bool:
    """Those in their own scenario; everything where all is asked for."""
    return whole("agreements") or (name in FUSED and scenario == OWN[name])


def _check(found: Apart, limit: float) -> None:
    assert found.signals < limit, found
    assert found.events < limit, found


def _cases() -> list[tuple[str, str, str]]:
    """All backends everywhere, other methods where chosen."""
    return [
        (name, scenario, method)
        for name, scenario in EVERY
        for method in IN_PROCESS
        if method == "C backend" or (name, scenario) in CHOSEN
    ]


@pytest.mark.usefixtures("closely")
@pytest.mark.parametrize(("name", "scenario", "method"), _cases())
def test_methods_that_locate_events_agree(
    name: str,
    scenario: str,
    method: str,
    made: Making,
    soon: Making,
    request: pytest.FixtureRequest,
) -> None:
    if _fused(name, scenario):
        request.getfixturevalue("optimised")
    one = (soon if method.startswith("numpy") else made)(name, scenario)
    found = apart(LOCATED[method](one), LOCATED["numpy exact"](one))
    _check(found, SAME if method == "C backend" else ALIKE)


@pytest.mark.parametrize("version", ["2.0", "3.0"])
@pytest.mark.parametrize(("name", "scenario"), CHOSEN)
def test_units_agree(name: str, scenario: str, version: str, soon: Making) -> None:
    """With the simulator where CVODE locates events, with exported C where steps are fixed."""
    one = soon(name, scenario)
    exchanged = LOCATED[f"FMI {version} exchange"](one)
    _check(apart(exchanged, LOCATED["numpy exact"](one)), ALIKE)
    stepped = STEPPED[f"FMI {version} co-simulation"](one, _few(name))
    _check(apart(stepped, STEPPED["exported C"](one, _few(name))), SAME)


@pytest.mark.parametrize(("name", "scenario"), CHOSEN)
def test_exported_python_and_c_make_the_same_steps(name: str, scenario: str, soon: Making) -> None:
    one, few = soon(name, scenario), _few(name)
    _check(apart(STEPPED["exported Python"](one, few), STEPPED["exported C"](one, few)), SAME)


@pytest.mark.parametrize(("name", "scenario"), CHOSEN)
def test_fixed_steps_converge_to_located_events(name: str, scenario: str, soon: Making) -> None:
    """Of fourth order; of first where something sticks or slips, seen at the end of its step."""
    case = soon(name, scenario)
    expected, counts = LOCATED["numpy exact"](case), (10, 30)
    steps = [SAMPLE / count for count in counts]
    found = [
        apart(STEPPED["exported C"](case, count), expected, case.exact.states) for count in counts
    ]
    for step, one in zip(steps, found, strict=True):
        assert one.events <= step * (1 + 1e-9), one
    assert found[-1].signals < 1e-3
    if not expected.events:
        assert order(steps, [one.signals for one in found]) > 3.8


@pytest.mark.parametrize(("name", "scenario"), CHOSEN)
def test_steps_that_come_soon_bring_the_same_changes(
    name: str, scenario: str, made: Making, soon: Making
) -> None:
    """What sticks or slips at all does so there."""
    seen, expected = (
        {(event.port, event.kind) for event in making(name, scenario).exact.events}
        for making in (soon, made)
    )
    assert seen == expected


def test_what_differs_is_found() -> None:
    """A signal by a part of its range, an event by its time, and a port that did another thing."""
    expected = Outcome({"v": np.array([0.0, 2.0]), "w": np.zeros(2)}, (Event(0.1, "a", "stick"),))
    moved = Outcome({"v": np.array([0.0, 2.5]), "w": np.full(2, 0.1)}, (Event(0.3, "a", "stick"),))
    assert apart(moved, expected) == Apart(0.25, "v", pytest.approx(0.2))
    other = Outcome({"v": np.array([0.0, np.nan])}, (Event(0.1, "a", "cross"),))
    assert apart(other, expected) == Apart(np.inf, "v", np.inf)


def test_changes_of_mode_are_events_of_their_ports() -> None:
    modes = np.array([[1, 0], [0, 0], [0, -1], [-1, 1]])
    assert changes([0.0, 0.1, 0.2, 0.3], modes, ("a", "b")) == (
        Event(0.1, "a", "stick"), Event(0.2, "b", "slip"), Event(0.3, "a", "slip"),
        Event(0.3, "b", "cross"),
    )  # fmt: skip
