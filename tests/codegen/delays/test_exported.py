"""Delays in exported C, exported Python and units, against the method of steps by hand."""

import subprocess
from math import factorial
from pathlib import Path

import numpy as np
import pytest
from fmpy import read_model_description, simulate_fmu
from oracles.c_model import compiled, written
from oracles.exported import loaded

import bondgraph as bg
import codegen

PAST = bg.graph([bg.State("x", "-past + u", start=1), bg.Delay("past", "x", time="T", start=1)])
EQUATIONS = bg.derive(PAST)
END, LATE = 3.0, 0.37


def exact(times: np.ndarray, late: float = LATE) -> np.ndarray:
    """x' = -x(t - T), x = 1 up to 0: sum of (-1)^k (t - (k - 1) T)^k / k!, each from t = (k - 1) T on."""
    found = np.ones_like(times)
    for k in range(1, 20):
        found += (-1) ** k * np.maximum(times - (k - 1) * late, 0.0) ** k / factorial(k)
    return found


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("past")
    files = codegen.to_c(EQUATIONS, {"T": LATE}, main=True)
    return compiled(folder, written(folder, files))


def printed(program: Path, *how: str, end: float = END) -> tuple[np.ndarray, np.ndarray]:
    told = subprocess.run(
        [program, f"{end}", "0.1", *how], capture_output=True, text=True, check=False
    )
    assert told.returncode == 0, told.stderr
    table = np.array([row.split(",") for row in told.stdout.splitlines()[1:]], dtype=float)
    return table[:, 0], table[:, 1]


@pytest.mark.parametrize("late", [LATE, 0.5, 0.0271])
def test_located_runs_of_exported_c(program: Path, late: float) -> None:
    times, x = printed(program, "located", f"T={late}", end=1.0)
    np.testing.assert_allclose(x, exact(times, late)[: len(x)], atol=1e-9)


def test_fixed_steps_are_of_fourth_order_over_breaks(program: Path) -> None:
    """At steps that no delay is a multiple of: they are cut where x's slopes jump."""
    errors = []
    for step in (0.1, 0.05):
        times, x = printed(program, f"step={step}")
        errors.append(np.abs(x - exact(times)).max())
    assert errors[0] < 1e-5
    assert errors[0] / errors[1] > 12


def test_outputs_show_what_delays_give(tmp_path: Path) -> None:
    """A source of effort that is late, and what a detector has of it, at the samples of a run."""
    graph = bg.graph(
        [bg.Se("source", "1*late"), bg.Zero("node"), bg.R("load", "R"), bg.De("volt"),
         bg.State("x", "1 - late"), bg.Delay("late", "x", time="T", start=0.25)],
        "source > node > load, node > volt")  # fmt: skip
    equations, numbers = bg.derive(graph, outputs=["volt"]), {"R": 2.0, "T": LATE}
    run = codegen.simulator(equations, numbers).run(np.linspace(0, 2, 21))
    files = codegen.to_c(equations, numbers, main=True)
    program = compiled(tmp_path, written(tmp_path, files))
    for how, within in (("located", 1e-9), ("step=0.02", 1e-7)):
        told = subprocess.run(
            [program, "2", "0.1", how], capture_output=True, text=True, check=True
        )
        head, *rows = told.stdout.splitlines()
        table = np.array([row.split(",") for row in rows], dtype=float)
        found = dict(zip(head.split(","), table.T, strict=True))
        np.testing.assert_allclose(found["e_volt"], run["late"], atol=within)
        assert np.ptp(found["e_volt"]) > 0.5
    module = loaded(codegen.to_python(equations, numbers))
    again = module.simulate(np.linspace(0, 2, 21), {}, {}, step=0.02)
    np.testing.assert_allclose(again["e_volt"], run["late"], atol=1e-7)


def test_a_step_longer_than_a_delay_is_cut(program: Path) -> None:
    times, x = printed(program, "step=0.1", "T=0.03", end=0.5)
    np.testing.assert_allclose(x, exact(times, 0.03), atol=1e-7)


def test_fixed_steps_of_exported_python() -> None:
    module = loaded(codegen.to_python(EQUATIONS, {"T": LATE}, None, "past"))
    assert module.DELAYED == ("past",)
    times = np.linspace(0, END, 31)
    errors = []
    for step in (0.1, 0.05):
        run = module.simulate(times, {}, {"u": 0.0}, step=step)
        errors.append(np.abs(run["x"] - exact(times)).max())
    assert errors[0] < 1e-5
    assert errors[0] / errors[1] > 12
    other = module.simulate(times, {}, {"u": 0.0}, {"T": 0.5}, step=0.05)
    np.testing.assert_allclose(other["x"], exact(times, 0.5), atol=1e-7)
    with pytest.raises(ValueError, match="past: a delay is above zero"):
        module.simulate(times, {}, {"u": 0.0}, {"T": 0.0})
    assert module.Model().rhs(0.0, [1.0], [0.25, 0.5]) == pytest.approx(
        [0.5 - 0.25] if module.INPUTS == ("past", "u") else [0.25 - 0.5]
    )


CALLER = """
#include <stdio.h>
#include "model_runtime.h"
int main(void)
{
    static bg_model m;
    double s[BG_SIZE], x[] = {1.0}, w[3 * BG_EXTERNAL] = {0};
    printf("%d ", bg_model_init(&m, NULL));
    bg_model_vector(&m, 0.0, x, w, s);
    for (int k = 0; k < 40; k++)
        bg_model_step(&m, 0.05 * k, 0.05, s, w);
    const double first = s[0];
    for (int k = 40; k < 50; k++)
        bg_model_step(&m, 0.05 * k, 0.05, s, w);
    const double then = s[0];
    s[0] = first; /* back to where it was: the same again */
    for (int k = 40; k < 50; k++)
        bg_model_step(&m, 0.05 * k, 0.05, s, w);
    printf("%d %.17g ", s[0] - then < 1e-9 && then - s[0] < 1e-9, s[0]);
    printf("%d ", bg_model_step(&m, 2.6, 0.05, s, w)); /* a gap */
    double p[BG_PARAMETERS] = {0.0};
    printf("%d\\n", bg_model_init(&m, p));
    return 0;
}
"""


def called(folder: Path, *flags: str) -> list[str]:
    files = codegen.to_c(EQUATIONS, {"T": LATE}) | {"caller.c": CALLER}
    program = compiled(folder, written(folder, files), *flags)
    return subprocess.run([program], capture_output=True, text=True, check=True).stdout.split()


def test_steps_go_back_and_leave_no_gap(tmp_path: Path) -> None:
    made, same, x, gap, none = called(tmp_path)
    assert (made, same) == ("0", "1")
    assert float(x) == pytest.approx(exact(np.array([2.5]))[0], abs=1e-6)
    assert (int(gap), int(none)) == (
        codegen.engine.status.Status.FORGETS,
        codegen.engine.status.Status.NOT_LATE,
    )


def test_a_memory_that_is_too_short_is_told(tmp_path: Path) -> None:
    """Seven parts of 0.05 s are less than 0.37 s."""
    folder = tmp_path
    files = codegen.to_c(EQUATIONS, {"T": LATE}, main=True)
    program = compiled(folder, written(folder, files), "-DBG_MEMORY=7")
    told = subprocess.run([program, "1", "0.05"], capture_output=True, text=True, check=False)
    assert told.returncode == 1
    assert "a delay reaches farther back than its memory does" in told.stderr
    rows = told.stdout.splitlines()[1:]
    times, x = np.array([row.split(",") for row in rows], dtype=float).T
    np.testing.assert_allclose(x, exact(times), atol=1e-6)


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_units_remember(version: str, tmp_path: Path) -> None:
    path = codegen.write_fmu(tmp_path / "past.fmu", EQUATIONS, {"T": LATE}, version=version)
    kinds = {one.name: one.causality for one in read_model_description(path).modelVariables}
    assert (kinds["past"], kinds["u"]) == ("local", "input")
    given = {"stop_time": END, "output_interval": 0.1, "output": ["x", "past"]}
    for how, more, within in (
        ("CoSimulation", {}, 1e-9),
        ("CoSimulation", {"start_values": {"fixed_internal_step": 0.05}}, 1e-6),
        ("CoSimulation", {"start_values": {"T": 0.5}}, 1e-9),
        ("ModelExchange", {"relative_tolerance": 1e-9}, 1e-7),
    ):  # fmt: skip
        run = simulate_fmu(str(path), fmi_type=how, **given, **more)
        late = more.get("start_values", {}).get("T", LATE)
        times = run["time"]
        np.testing.assert_allclose(
            run["x"], exact(times, late), atol=within, err_msg=f"{how}, {more}"
        )
        before = np.where(times < late, 1.0, exact(np.maximum(times - late, 0), late))
        np.testing.assert_allclose(run["past"], before, atol=within)


def test_a_unit_goes_back(tmp_path: Path) -> None:
    """A state that is saved has the past with it."""
    from fmpy import extract
    from fmpy.fmi2 import FMU2Slave

    path = codegen.write_fmu(tmp_path / "past.fmu", EQUATIONS, {"T": LATE})
    told = read_model_description(path)
    unit = FMU2Slave(
        guid=told.guid, unzipDirectory=extract(str(path), str(tmp_path / "unit")),
        modelIdentifier=told.coSimulation.modelIdentifier, instanceName="past",
    )  # fmt: skip
    x = next(one.valueReference for one in told.modelVariables if one.name == "x")
    unit.instantiate()
    unit.setupExperiment(startTime=0.0)
    unit.enterInitializationMode()
    unit.exitInitializationMode()
    for k in range(10):
        unit.doStep(0.1 * k, 0.1)
    kept = unit.getFMUState()
    found = []
    for _ in range(2):
        for k in range(10, 20):
            unit.doStep(0.1 * k, 0.1)
        found.append(unit.getReal([x])[0])
        unit.setFMUState(kept)
    unit.freeFMUState(kept)
    unit.terminate()
    unit.freeInstance()
    assert found[0] == found[1]
    assert found[0] == pytest.approx(exact(np.array([2.0]))[0], abs=1e-9)
