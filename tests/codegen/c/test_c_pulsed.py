"""Exported C and Python generate pulses themselves: no table of instants, and the same doubles."""

import subprocess
from pathlib import Path

import numpy as np
import pytest
from oracles.c_model import WARNED, closer, compiled, written
from oracles.exported import loaded
from oracles.pulsed import coil, half_bridge
from references.pulsed import current, switchings

from bondgraph import SignalError
from codegen import (
    PWM,
    Lag,
    Sampled,
    Sawtooth,
    Signal,
    Sine,
    Square,
    Step,
    simulator,
    to_c,
    to_python,
)
from codegen.python.script import script
from codegen.targets import Export

V, R, L = 24.0, 1.5, 1e-3

DRIVES: dict[str, Signal] = {
    "pulses": PWM(12_345.0, 0.37, 0.0, V, 0.21) + Step(1.3e-3, 2.0),
    "sawtooth": Sawtooth(1234.5, -1.0, V, 0.7, -0.3),
    "lags": Lag(Square(2e3, -1.0, 1.0, 0.2) + PWM(777.0, 0.4), 1e-3),
    "moving duty": PWM(1e4, Sine(0.6, 50.0, offset=0.5)),
    "duty in pulses": PWM(1e4, PWM(1e3, 0.25, 0.2, 0.8) + Lag(Step(5e-3, 0.2), 1e-3)),
    "duty from data": PWM(5e3, Sampled([-0.01, 0.01], [0.0, 1.0]), -1.0, 1.0),
}


def _rows(program: Path, *words: str) -> tuple[np.ndarray, list[list[str]]]:
    done = subprocess.run([program, *words], capture_output=True, text=True, check=True)
    rows = [row.split(",") for row in done.stdout.splitlines()[1:]]
    return np.array(rows, dtype=float), [row.split(",") for row in done.stderr.splitlines()]


@pytest.mark.parametrize("name", DRIVES)
def test_the_main_program_runs_on_pulses(name: str, tmp_path: Path) -> None:
    drive = DRIVES[name]
    files = closer(to_c(coil(), {"L": L, "R": R}, main=True, inputs={"u": drive}))
    assert sum(map(len, files["scenario.h"])) < 6000
    program = compiled(
        tmp_path, written(tmp_path, files), *(WARNED if name == "pulses" else ()), "-O0"
    )
    table, _ = _rows(program, "0.02", "1e-4", "located")
    run = simulator(coil(), {"L": L, "R": R}).run(
        table[:, 0], {}, {"u": drive}, rtol=1e-10, atol=1e-11
    )
    assert table[:, 1] == pytest.approx(run["i"], abs=1e-8)
    held, _ = _rows(program, "0.02", "1e-4", "located", "u=3")
    assert held[-1, 1] == pytest.approx(2.0 * -np.expm1(-0.02 * R / L), rel=1e-8)


def test_the_main_program_switches_at_the_very_instants(tmp_path: Path) -> None:
    """As many as there are, each the double that Python has."""
    f, duty, phase = 98_765.4, 0.37, 0.6
    gate = PWM(f, duty, phase=phase)
    told = (V, R, L, f, duty, phase)
    files = to_c(
        half_bridge(), {"L": L, "R": R}, main=True, initial={"i": current(0.0, *told)},
        inputs={"V": V, "gate": gate}, initially_on=["low"],
    )  # fmt: skip
    program = compiled(tmp_path, written(tmp_path, files), "-O0")
    table, events = _rows(program, "0.01", "1e-3", "located")
    assert table[-1, 1] == pytest.approx(current(0.01, *told), abs=1e-8)
    assert len(events) == 2 * switchings(0.0, 0.01, f, duty, phase)
    times = [float(time) for time, port, *_ in events if port == "high"]
    assert times == list(gate.within(0.0, 0.01))


@pytest.mark.parametrize("name", DRIVES)
def test_exported_scripts_have_the_signals(name: str, tmp_path: Path) -> None:
    """Fixed steps that divide no period see values; each is that of the signal to rounding."""
    drive, times = DRIVES[name], np.linspace(0.0, 0.001, 11)
    module = loaded(to_python(coil(), {"L": L, "R": R}))
    export = Export("coil", coil(), {"L": L, "R": R}, {}, {}, {"u": drive}, times)
    text = script("coil", export, ["u"])
    inputs: dict = {}
    body = text.split('"""', 2)[2].replace("from coil import simulate\n", "")
    exec(body[: body.index("times = ")], inputs)
    given = inputs["inputs"]["u"]
    for t in np.linspace(-0.003, 0.021, 977).tolist():
        assert given(t) == pytest.approx(drive(t), rel=1e-12, abs=1e-12)
    found = module.simulate(times, {}, inputs["inputs"], step=1e-6)
    run = simulator(coil(), {"L": L, "R": R}).run(times, {}, {"u": drive})
    assert found["i"] == pytest.approx(run["i"], abs=0.05)


def test_a_lag_of_a_moving_duty_is_refused_where_tables_are_written() -> None:
    drive = Lag(PWM(1e3, Sine(0.4, 50.0, offset=0.5)), 1e-3)
    with pytest.raises(SignalError, match="give the model the lag, or the PWM a number as duty"):
        to_c(coil(), {"L": L, "R": R}, main=True, inputs={"u": drive})
