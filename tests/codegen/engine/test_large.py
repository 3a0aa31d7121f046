"""A model with two hundred states leaves the toolkit every way there is, and runs as it does inside."""

from pathlib import Path

import numpy as np
import pytest
from fmpy import simulate_fmu
from oracles.c_model import Pair
from oracles.chains import long_chain
from oracles.exported import loaded

import bondgraph as bg
from codegen import Result, simulator, to_python, write_fmu

TIMES, PUSH = np.linspace(0.0, 0.2, 3), 5.0

Model = tuple[bg.StateEquations, dict[str, float]]


@pytest.fixture(scope="module")
def chain() -> Model:
    return long_chain(100)


@pytest.fixture(scope="module")
def expected(chain: Model) -> Result:
    """The run of the simulator in numpy."""
    result = simulator(*chain).run(TIMES, {}, {"P": PUSH})
    assert len(result.states) == 200
    return result


def test_c_evaluates_and_steps(chain: Model, expected: Result, tmp_path: Path) -> None:
    pair = Pair(tmp_path, *chain)
    s = np.random.default_rng(1).uniform(-1, 1, 200)
    now = pair.closed.evaluate(0.0, s, np.array([2.0]), np.zeros(1), (1,))
    status, parts = pair.c.evaluate(0.0, s, [2.0], [0.0], (1,))
    assert status == 0
    assert parts[5] == pytest.approx(now.rate, rel=1e-12, abs=1e-9)
    assert pair.c.rhs(0.0, s, [2.0], [1.0]) == pytest.approx(now.rate, rel=1e-12, abs=1e-9)
    s = np.zeros(200)
    for k in range(100):
        status, s = pair.c.step(k * 2e-3, 2e-3, s, [[PUSH]] * 3)
        assert status == 0, pair.c.message(status)
    assert s == pytest.approx([expected[name][-1] for name in expected.states], abs=1e-7)


def test_python_runs(chain: Model, expected: Result) -> None:
    module = loaded(to_python(*chain))
    run = module.simulate(TIMES, {}, {"P": PUSH}, step=2e-3)
    for state in expected.states:
        assert run[state] == pytest.approx(expected[state], abs=1e-7)


def test_the_backend_in_c_runs(chain: Model, expected: Result) -> None:
    run = simulator(*chain, backend="c").run(TIMES, {}, {"P": PUSH})
    for state in expected.states:
        assert run[state] == pytest.approx(expected[state], abs=1e-10)


@pytest.mark.usefixtures("compiled_quickly")
@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_a_unit_runs(chain: Model, expected: Result, version: str, tmp_path: Path) -> None:
    path = write_fmu(tmp_path / "unit.fmu", *chain, version=version, inputs={"P": PUSH})
    run = simulate_fmu(
        str(path), stop_time=TIMES[-1], output_interval=TIMES[1], fmi_type="CoSimulation",
        output=list(expected.states),
    )  # fmt: skip
    for state in expected.states:
        assert run[state] == pytest.approx(expected[state], abs=1e-7)
