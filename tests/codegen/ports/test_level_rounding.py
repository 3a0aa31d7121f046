"""A friction level that only rounding leaves below zero is zero, on every route; others are refused."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from oracles.c_model import Pair
from oracles.exported import loaded
from oracles.units import Case, sampled, simulated
from references.build import bond_graph

import bondgraph as bg
import codegen
from codegen import Ramp, Sampled, Step, simulator
from codegen.runs.arguments import signals_for
from codegen.sweeps.job import Job
from codegen.sweeps.measuring import batch_of

TIMES = np.linspace(0.0, 1.0, 11)
LINE = Ramp(0.3, -13, 1.3, 0.4)
"""In doubles 1.3 - 13 (0.4 - 0.3) is -4e-16."""
RISE = Ramp(0.3, 10, 0, 0.4)
"""In doubles 10 (0.4 - 0.3) is 1 + 4e-16."""

DRAINED = Sampled([0.3, 0.35, 0.4], [0, -26, 0])
"""Takes 1.3, as much before the middle as after it."""

LEVELS: Mapping[str, tuple[dict[str, object], codegen.Signal]] = {
    "a signal": ({"brake": bg.DryFriction("n")}, LINE),
    "a difference": ({"brake": bg.DryFriction("13*(1 - n)/10")}, RISE),
    "a state": ({}, DRAINED),
    "what a law gives": (
        {"brake": bg.DryFriction("N", "1 + exp(-40*slip)", 2), "pad": "13*(1 - n)/20"},
        RISE,
    ),
}  # fmt: skip
"""Brakes that come down from 1.3 to zero between 0.3 and 0.4 s."""


@cache
def _equations(level: str) -> bg.StateEquations:
    """A mass with a brake, which is pushed; what presses the pad brakes, too."""
    nodes = [
        bg.Se("push", "P"), bg.One("m"), bg.I("J", "J", flow="w"), bg.R("brake", effort="f"),
        bg.R("pad", effort="N"),
    ]  # fmt: skip
    bonds = "push>m>J m>brake m>pad"
    if level == "a state":
        nodes[3] = bg.R("brake", effort="f", law=bg.DryFriction("p"))
        nodes += [bg.Sf("pump", "n"), bg.Zero("tank"), bg.C("oil", 1, effort="p")]
        bonds = f"{bonds} pump>tank>oil"
    return bg.derive(bond_graph(nodes, bonds))


def _case(level: str, speed: float) -> Case:
    """It is pushed by 2 from 0.7 s on."""
    start = {"w": speed} | ({"p": 1.3} if level == "a state" else {})
    laws, signal = LEVELS[level]
    inputs: dict[str, object] = {"P": Step(0.7, 2.0), "n": signal}
    if "pad" not in laws:
        laws = laws | {"pad": 0}
    return Case(_equations(level), {"J": 1.0}, laws, start, inputs, 1.0)


@cache
def _ready(level: str, backend: str) -> codegen.Simulator:
    case = _case(level, 0.0)
    return simulator(case.equations, case.parameters, case.laws, backend)


@cache
def _module(level: str) -> ModuleType:
    case = _case(level, 0.0)
    return loaded(codegen.to_python(case.equations, case.parameters, case.laws))


def _right(speed: float) -> np.ndarray:
    """A mass of 1: the brake takes 1.3 a second, and 0.065 while it lets go; at rest it holds."""
    braked = 1.3 * np.minimum(TIMES, 0.3) + 0.065 * (TIMES > 0.35)
    return (speed - braked if speed else np.zeros(11)) + 2 * np.maximum(TIMES - 0.7, 0)


Way = Callable[[str, Case, Path], np.ndarray]
"""The speed by one route, of a case of a level; a folder for what it makes."""


def _located(backend: str, method: str) -> Way:
    def run(level: str, case: Case, folder: Path) -> np.ndarray:
        result = _ready(level, backend).run(TIMES, case.initial, case.inputs, method)
        assert result.backend == backend
        return result["w"]

    return run


def _in_python(level: str, case: Case, folder: Path) -> np.ndarray:
    return np.array(_module(level).simulate(TIMES, case.initial, case.inputs, step=0.01)["w"])


def _in_c(level: str, case: Case, folder: Path) -> np.ndarray:
    pair = Pair(folder, case.equations, case.parameters, case.laws)
    signals = signals_for(case.inputs, [name.name for name in pair.program.external])
    w = np.array([[signal(k * 0.005) for signal in signals] for k in range(203)])
    start = [case.initial.get(name.name, 0.0) for name in pair.program.states]
    return pair.c.march(0.01, 100, 10, pair.c.vector(0.0, start, w[0]), w)[1]["w"]


def _unit(kind: str, version: str) -> Way:
    def run(level: str, case: Case, folder: Path) -> np.ndarray:
        unit = case.written(folder / "unit.fmu", version)
        return sampled(simulated(unit, kind, case, ["w"], 11), case, 11)["w"]

    return run


Told = tuple[type[Exception], str]
NEGATIVE = r"negative|below zero"

ROUTES: Mapping[str, tuple[Way, float, Told]] = {
    "numpy": (_located("numpy", "auto"), 1e-9, (bg.SimulationError, NEGATIVE)),
    "numpy, DOP853": (_located("numpy", "DOP853"), 1e-9, (bg.SimulationError, NEGATIVE)),
    "C": (_located("c", "auto"), 1e-9, (bg.SimulationError, NEGATIVE)),
    "C, DOP853": (_located("c", "DOP853"), 1e-9, (bg.SimulationError, NEGATIVE)),
    "exported Python": (_in_python, 4e-3, (ArithmeticError, NEGATIVE)),
    "exported C": (_in_c, 4e-3, (AssertionError, NEGATIVE)),
    "model exchange": (
        _unit("ModelExchange", "2.0"),
        1e-6,
        (Exception, "right-hand side|fmi2"),
    ),
    "co-simulation": (_unit("CoSimulation", "3.0"), 1e-6, (Exception, r"(?i)dostep")),
}


# In model exchange a state is as near to zero as the importer's integrator brings it.
PAIRS = [(r, n) for r in ROUTES for n in LEVELS if (r, n) != ("model exchange", "a state")]


@pytest.mark.parametrize("speed", [10.0, 0.0])
@pytest.mark.parametrize(("route", "level"), PAIRS)
def test_a_level_that_rounds_below_zero_is_zero(
    route: str, level: str, speed: float, tmp_path: Path
) -> None:
    run, near, _ = ROUTES[route]
    assert run(level, _case(level, speed), tmp_path) == pytest.approx(_right(speed), abs=near)


@pytest.mark.parametrize("method", ["DOP853", "Radau"])
@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_no_step_is_tried_beyond_where_a_level_ends(backend: str, method: str) -> None:
    """A brake let go within 1e-5 s, far less than a step of what moves beside it: w' = 2 from then on."""
    nodes = [
        bg.Se("push", "P"), bg.One("m"), bg.I("J", "J", flow="w"), bg.R("brake"),
        bg.Se("pull", "P"), bg.One("free"), bg.I("J_2", "J", flow="w_2"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "push>m>J m>brake pull>free>J_2")
    run = simulator(bg.derive(graph), {"J": 1.0}, {"brake": bg.DryFriction("n")}, backend)
    inputs = {"P": 2.0, "n": Ramp(0.3, -3e5, 3.0, 0.30001)}
    result = run.run([0, 0.3, 0.4, 1], {"w_2": 3.0}, inputs, method)
    left = 1e-5 * 2 / 3
    assert result["w"][-1] == pytest.approx(2 * (0.7 - 1e-5) + left, abs=1e-9)


@pytest.mark.parametrize("level", LEVELS)
def test_sweeps_in_c_run_through_it(level: str) -> None:
    """Both ways of a batch of runs: exact steps, and located where the level's curve is not affine."""
    case = _case(level, 10.0)
    family = codegen.Family(case.equations, case.parameters, case.laws, backend="c")
    measures = {"w": codegen.final("w")}
    loop = batch_of(Job(family, ("J",), TIMES, measures, case.initial, case.inputs))
    assert loop is not None
    (found,), left = loop(np.array([[1.0], [2.0]]))
    assert not left
    assert loop.statuses == {0: 2}
    assert found == pytest.approx([10 - 0.455 + 0.6, 10 - (0.455 - 0.6) / 2], abs=1e-9)


@pytest.mark.parametrize(("route", "level"), PAIRS)
def test_a_level_that_is_below_zero_is_refused(route: str, level: str, tmp_path: Path) -> None:
    """By 1e-8 of its terms."""
    case = _case(level, 10.0)
    if level == "a state":
        further = (1 + 1e-8) * DRAINED
        case = replace(case, inputs={**case.inputs, "n": further})
    else:
        end = -1.3e-8 if level == "a signal" else 1 + 1e-8
        case = replace(case, inputs={**case.inputs, "n": Step(0.4, end, 1.3 if end < 0 else 0.0)})
    run, _, (error, message) = ROUTES[route]
    with pytest.raises(error, match=message):
        run(level, case, tmp_path)
