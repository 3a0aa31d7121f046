"""Names of any sort come through every way out of the toolkit unchanged, and change no number."""

import ctypes
from pathlib import Path

import numpy as np
import pytest
from fmpy import read_model_description, simulate_fmu
from fmpy.validation import validate_fmu
from oracles.awkward import RUDE, SETS, model
from oracles.c_model import Pair
from oracles.exported import loaded

from codegen import simulator, to_python, write_fmu

PLAIN = model("mass spring damping level push speed force effort slip angle".split())  # noqa: SIM905
STATE, PUSH = [0.7, -0.4, 0.2], 1.5

pytestmark = pytest.mark.usefixtures("compiled_quickly")


@pytest.fixture(params=SETS)
def names(request: pytest.FixtureRequest) -> list[str]:
    return SETS[request.param].split()


def _expected() -> np.ndarray:
    """The rates under plain names."""
    return simulator(*PLAIN).rhs(0.0, STATE, [PUSH])


def test_the_simulator_and_exported_python(names: list[str]) -> None:
    equations, values = model(names)
    ready = simulator(equations, values)
    module = loaded(to_python(equations, values, name=RUDE[0]))
    assert (ready.states, ready.inputs) == ((names[5], names[6], names[9]), (names[4],))
    assert (ready.states, ready.inputs) == (module.STATES, module.INPUTS)
    assert (*module.FRICTION,) == (RUDE[2],)
    assert ready.rhs(0.0, STATE, [PUSH]) == pytest.approx(_expected(), rel=1e-14)
    assert module.Model().rhs(0.0, STATE, [PUSH]) == pytest.approx(_expected(), rel=1e-12)


def test_c(names: list[str], tmp_path: Path) -> None:
    equations, values = model(names)
    pair = Pair(tmp_path, equations, values)
    assert pair.c.rhs(0.0, STATE, [PUSH], [1.0]) == pytest.approx(_expected(), rel=1e-13)
    status, parts = pair.c.evaluate(0.0, STATE, [PUSH], [0.0], (1,))
    assert status == 0
    assert parts[5] == pytest.approx(_expected(), rel=1e-13)
    strings = ctypes.c_char_p * 3
    listed = strings.in_dll(pair.library, "bg_state_names")
    assert [one.decode() for one in listed] == [names[5], names[6], names[9]]
    assert strings.in_dll(pair.library, "bg_state_units")[0].decode() == "m/s'>"


@pytest.mark.parametrize(("version", "chosen"), [("2.0", 0), ("3.0", 4), ("2.0", 6), ("3.0", 7)])
def test_units(version: str, chosen: int, tmp_path: Path) -> None:
    names = list(SETS.values())[chosen].split()
    equations, values = model(names)
    initial = dict(zip((names[5], names[6], names[9]), STATE, strict=True))
    path = write_fmu(
        tmp_path / "unit.fmu", equations, values, version=version, initial=initial,
        inputs={names[4]: PUSH}, name=RUDE[2],
    )  # fmt: skip
    assert validate_fmu(str(path)) == []
    described = {one.name for one in read_model_description(str(path)).modelVariables}
    assert {*names} <= described
    found = simulate_fmu(
        str(path), stop_time=0.1, output_interval=0.1, fmi_type="CoSimulation", output=[*initial]
    )
    times = np.array([0.0, 0.1])
    plain = dict(zip(("speed", "force", "angle"), STATE, strict=True))
    expected = simulator(*PLAIN).run(times, plain, {"push": PUSH})
    for name, other in zip(initial, plain, strict=True):
        assert found[name][-1] == pytest.approx(expected[other][-1], abs=1e-7)
