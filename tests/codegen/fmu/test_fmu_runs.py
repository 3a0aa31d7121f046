"""Units run by fmpy's CVODE and its co-simulation, against the toolkit's own runs."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from oracles.called import Unit
from oracles.many import chain
from oracles.units import Case, belt, divider, duffing, figure_11, ran
from references.build import bond_graph

import bondgraph as bg
from codegen import Result, simulator

#: How long two of them run: as long as there are several events of each of their kinds.
ENDS = {"duffing": 3.5, "belt": 2.0}

CASES = {"fig11": figure_11, "duffing": duffing, "belt": belt, "divider": divider}

MODES = {"fig11": ["mode(clutch)"], "duffing": ["mode(rub)"], "belt": ["mode(rub)"], "divider": []}

#: What CVODE's tolerance of 1e-9 leaves of the states, of their largest magnitude.
REACHED = {"fig11": 2e-6, "duffing": 2e-6, "belt": 5e-6, "divider": 2e-7}


@pytest.fixture(scope="module", params=CASES)
def named(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def case(named: str) -> Case:
    made = CASES[named]()
    return replace(made, end=ENDS.get(named, made.end))


@pytest.fixture(scope="module")
def expected(case: Case) -> Result:
    """The simulator's own run."""
    return case.run()


@pytest.fixture(scope="module")
def units(case: Case, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("units")
    return {v: case.written(folder / v / "unit.fmu", v) for v in ("2.0", "3.0")}


def _error(found, expected, names) -> float:
    return max(
        float(np.abs(found[name] - expected[name]).max() / np.abs(expected[name]).max())
        for name in names
    )


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_model_exchange_follows_the_simulator(
    named: str, case: Case, expected: Result, units: dict[str, Path], version: str
) -> None:
    found, changes = ran(units[version], "ModelExchange", case, expected.states, modes=MODES[named])
    assert _error(found, expected, expected.states) < REACHED[named]
    assert changes == pytest.approx([event.time for event in expected.events], abs=1e-6)


@pytest.fixture(scope="module")
def limited_slip(tmp_path_factory: pytest.TempPathFactory) -> tuple[Unit, Result]:
    """The unit of Fig. 11, and its run by the backend in C at every tenth of a millisecond."""
    case = figure_11()
    ready = simulator(case.equations, case.parameters, case.laws, "c")
    times = np.linspace(0.0, case.end, 10_001)
    right = ready.run(times, case.initial, case.inputs)
    assert right.backend == "c"
    assert len(right.events) > 1
    folder = tmp_path_factory.mktemp("limited_slip")
    return Unit(case, "3.0", folder, inputs=case.inputs), right


@pytest.mark.parametrize("step", [1e-4, 1e-3, 0.01, 0.1])
def test_co_simulation_is_the_compiled_run_at_any_communication_step(
    limited_slip: tuple[Unit, Result], step: float
) -> None:
    unit, right = limited_slip
    every = round(step / 1e-4)
    made, rows = unit.started("CoSimulation"), [[right[name][0] for name in right.states]]
    for k in range(round(1 / step)):
        made.doStep(currentCommunicationPoint=k * step, communicationStepSize=step)
        rows.append(unit.get(made, *right.states).tolist())
    unit.free(made)
    for name, found in zip(right.states, np.transpose(rows), strict=True):
        assert np.abs(found - right[name][::every]).max() < 1e-6 * np.ptp(right[name]), name


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_co_simulation_converges_with_its_internal_step(
    case: Case, expected: Result, units: dict[str, Path], version: str
) -> None:
    right = {name: expected[name][::10] for name in expected.states}
    errors = []
    for step in (1e-3, 1e-4, 2e-5):
        found, _ = ran(
            units[version], "CoSimulation", case, expected.states, 101,
            start_values={"fixed_internal_step": step},
        )  # fmt: skip
        errors.append(_error(found, right, expected.states))
    # Events are found at the end of a step: the first order, unless nothing happens.
    assert errors[1] < 0.3 * errors[0] or errors[0] < 1e-9
    assert errors[2] < 5e-4


def test_a_chain_of_nine_blocks_with_friction_runs_as_a_unit(tmp_path: Path) -> None:
    """More ports than a table of sets would take: exchanged, and by its own located steps."""
    many = chain(9)
    case = Case(bg.derive(many.graph), {}, None, {}, many.inputs, 1.0)
    path, expected = case.written(tmp_path / "chain.fmu", "3.0"), case.run(101)
    assert len(expected.events) > 8
    for kind, reached in (("CoSimulation", 1e-8), ("ModelExchange", 5e-6)):
        found, _ = ran(path, kind, case, expected.states, 101)
        for name in many.shown[:4]:
            most = np.abs(expected[name]).max()
            assert np.abs(found[name] - expected[name]).max() <= reached * most, (kind, name)


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_implicit_steps_of_a_unit_go_where_explicit_ones_may_not(
    version: str, tmp_path: Path
) -> None:
    """A mass on a spring in thick oil, whose rates are 1 and 5000 per second, in steps of 2 ms."""
    nodes = [bg.Se("push", "F"), bg.One("n"), bg.I("m", 1.0, flow="v"), bg.R("oil", law="5001*f_oil"),
             bg.C("spring", 1 / 5000.0, effort="P")]  # fmt: skip
    case = Case(
        bg.derive(bond_graph(nodes, "push>n>m n>spring n>oil")), {}, None, {}, {"F": 1000.0}, 1.0
    )
    fast, slow, step = -5000.0, -1.0, {"start_values": {"fixed_internal_step": 2e-3}}
    t = np.linspace(0.0, 1.0, 101)
    force = 1000.0 * (1 - (fast * np.exp(slow * t) - slow * np.exp(fast * t)) / (fast - slow))
    path = case.written(tmp_path / "oil.fmu", version, integrator="rosenbrock")
    found, _ = ran(path, "CoSimulation", case, ["P"], 101, **step)
    assert found["P"] == pytest.approx(force, abs=1e-3)
    path = case.written(tmp_path / "explicit.fmu", version)
    with pytest.raises(Exception, match="DoStep failed"):
        ran(path, "CoSimulation", case, ["P"], 101, **step)
