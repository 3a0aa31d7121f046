"""A sampled controller beside its plant, as a model and as a unit, against the loop in one graph."""

from pathlib import Path

import numpy as np
import pytest
from oracles.sampled_loops import CONTROL, WIRES, controller, late_controller, off, plant, whole

import bondgraph as bg
import codegen


def _beside(other: object, **more: object) -> codegen.CoSimulation:
    parts = {"plant": plant(), "controller": other}
    return codegen.cosimulate(
        parts, WIRES, end=1, every=0.01, inputs={"controller.ref": 1.0}, **more
    )


def _unit(folder: Path, version: str) -> Path:
    """It works in the middle of each interval, so that what it reads is what the interval began with."""
    equations = bg.derive(bg.graph([controller("1/200")]))
    return codegen.write_fmu(folder / "pi.fmu", equations, CONTROL, version=version)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_a_model_with_a_controller_sees_the_plant_of_the_same_instant(backend: str) -> None:
    """What it samples is exchanged before it samples: nothing is late."""
    wanted = whole(controller())
    ready = codegen.simulator(bg.derive(bg.graph([controller()])), CONTROL, backend=backend)
    parts = {"plant": plant(backend), "controller": ready}
    run = codegen.cosimulate(parts, WIRES, end=1, every=0.01, inputs={"controller.ref": 1.0})
    assert off(run["plant.omega"], wanted["omega"]) < 1e-12
    assert off(run["controller.tau"], wanted["tau"]) < 1e-12
    assert off(run["plant.tau"], wanted["tau"]) < 1e-12


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_a_unit_that_goes_first_closes_the_loop_as_one_graph_does(
    version: str, tmp_path: Path
) -> None:
    wanted = whole(controller())
    run = _beside(_unit(tmp_path, version), order=["controller", "plant"])
    assert off(run["plant.omega"], wanted["omega"]) < 1e-9
    assert off(run["plant.tau"][:-1], wanted["tau"][:-1]) < 1e-9


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_a_unit_that_goes_on_with_all_others_is_late_by_an_interval(
    version: str, tmp_path: Path
) -> None:
    wanted = whole(late_controller())
    run = _beside(_unit(tmp_path, version))
    assert off(run["plant.omega"], wanted["omega"]) < 1e-9
    assert off(run["plant.tau"], wanted["tau"]) < 1e-9


def test_a_controller_in_python_sees_the_plant_of_the_same_instant() -> None:
    def step(now: dict[str, float]) -> dict[str, float]:
        error = now["ref"] - now["omega"]
        return {"z": now["z"] + 0.04 * error, "tau": error + now["z"]}

    node = bg.Controller(
        "pi", every=0.01, reads=["ref", "omega"], states={"z": 0}, gives=["tau"], step=step
    )
    run = _beside(codegen.simulator(bg.derive(bg.graph([node])), {}))
    assert off(run["plant.omega"], whole(controller())["omega"]) < 1e-12


def test_instants_are_those_of_controllers() -> None:
    run = _beside(codegen.simulator(bg.derive(bg.graph([controller()])), CONTROL))
    assert run.time.tolist() == [k / 100 for k in range(101)]
    assert not np.array_equal(run.time, 0.01 * np.arange(101))
