"""Units with switches in fixed internal steps: those of exported C, and right in the limit."""

from pathlib import Path

import numpy as np
import pytest
from oracles.c_model import Pair
from oracles.called import Unit
from oracles.switched_steps import Switched, switched_steps
from oracles.units import Case

import bondgraph as bg
from codegen import simulator
from codegen.inputs.signals import Constant, Sine

pytestmark = pytest.mark.usefixtures("compiled_quickly")

CASES = dict(switched_steps())

SMOOTH = sorted(
    name
    for name, case in CASES.items()
    if all(isinstance(signal, Constant | Sine) for signal in case.inputs.values())
)
"""Without breakpoints, at which a unit ends a step and exported C does not."""

STEPPED = ("coil", "coil with diode", "junction")


def _unit(name: str, version: str, folder: Path) -> Unit:
    case = CASES[name]
    end = case.count * case.step
    made = Case(bg.derive(case.graph), case.numbers, None, case.initial, case.inputs, end)
    return Unit(made, version, folder, initially_on=case.on)


def _switches(unit: Unit) -> list[str]:
    return [str(one) for one in simulator(unit.case.equations, unit.case.parameters).switches]


def _marched(unit: Unit, h: float, every: int) -> np.ndarray:
    """States and switches at the start and after every so many steps."""
    names = [str(one) for one in unit.case.equations.states]
    places = [unit.at[switch] for switch in _switches(unit)]
    made = unit.started("CoSimulation", fixed_internal_step=h)
    get = made.getInteger if unit.version == "2.0" else made.getInt32
    count, span = round(unit.case.end / (h * every)), h * every
    rows = [[*unit.get(made, *names), *get(places)]]
    for k in range(count):
        made.doStep(currentCommunicationPoint=k * span, communicationStepSize=span)
        rows.append([*unit.get(made, *names), *get(places)])
    unit.free(made)
    return np.array(rows)


@pytest.fixture(params=list(enumerate(SMOOTH)), ids=lambda one: str(one[1]))
def smooth(request: pytest.FixtureRequest, tmp_path: Path) -> tuple[Unit, Switched]:
    at, name = request.param
    return _unit(name, ("2.0", "3.0")[at % 2], tmp_path), CASES[name]


def test_a_unit_takes_the_steps_of_exported_c(
    smooth: tuple[Unit, Switched], tmp_path: Path
) -> None:
    """From the modes that it starts in: exported C's first step looks at values alone."""
    unit, case = smooth
    equations, every = unit.case.equations, 10
    found = _marched(unit, case.step, every)
    modes = found[:, len(equations.states) :]
    on = [name for name, first in zip(_switches(unit), modes[0], strict=True) if first]
    pair = Pair(tmp_path / "c", equations, case.numbers, on=on).at(case.numbers)
    signals = [case.inputs[name.name] for name in pair.program.external]
    start = [case.initial.get(str(name), 0.0) for name in equations.states]
    times = 0.5 * case.step * np.arange(2 * (case.count + 1) + 1)
    w = np.column_stack([[signal(t) for t in times] for signal in signals])
    s = pair.c.vector(0.0, np.array(start), w[0])
    _, expected = pair.c.march(case.step, case.count, 1, s, w)
    for k, state in enumerate(equations.states):
        right = expected[str(state)][::every]
        assert found[:, k] == pytest.approx(right, abs=1e-12 * (1 + np.abs(right).max())), state
    assert np.ptp(modes, axis=0).all()


@pytest.mark.parametrize("name", STEPPED)
def test_steps_that_breakpoints_cut_are_of_the_fourth_order(name: str, tmp_path: Path) -> None:
    """Commands are breakpoints: a unit's steps end there, so that nothing is late."""
    case, unit = CASES[name], _unit(name, "3.0", tmp_path)
    ready = simulator(unit.case.equations, case.numbers)
    times = np.arange(case.count + 1) * case.step
    right = ready.run(times, case.initial, case.inputs, initially_on=case.on)
    columns = [*map(str, unit.case.equations.states), *map(str, ready.switches)]
    expected = np.column_stack([right[column] for column in columns])[::10]
    errors = []
    for parts in (1, 4):
        found = _marched(unit, case.step / parts, 10 * parts)
        errors.append((np.abs(found - expected).max(axis=0) / np.ptp(expected, axis=0)).max())
    assert errors[0] < 1e-9
    assert errors[1] < errors[0] / 100
