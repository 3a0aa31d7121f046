"""Units with known sources, run by an importer whose steps are long beside what the sources do."""

import math
from pathlib import Path

import numpy as np
import pytest
from fmpy import simulate_fmu
from references.build import bond_graph

import bondgraph as bg
import codegen

NUMBERS = {"A": 0.0, "w": 6.28, "P": 0.0, "b": 3.3, "d": 1e-5, "level": 1.0}


@pytest.fixture(scope="module", params=["2.0", "3.0"])
def unit(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A mass of 1 on friction under pulses that come and go, and one bell of width d at b."""
    nodes = [
        bg.Se("F", "A*sin(w*t)**3 + P*exp(-((t - b)/d)**2)"), bg.One("m"),
        bg.I("M", 1, flow="v"), bg.R("brake", law=bg.DryFriction("level")),
    ]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "F>m>M m>brake"))
    path = tmp_path_factory.mktemp("known") / "unit.fmu"
    return codegen.write_fmu(path, equations, NUMBERS, version=request.param)


def _run(unit: Path, kind: str, end: float, **numbers: float) -> np.ndarray:
    return simulate_fmu(
        str(unit), fmi_type=kind, start_time=0.0, stop_time=end, output_interval=1.0,
        relative_tolerance=1e-9, output=["v", "mode(brake)"], start_values=numbers,
    )  # fmt: skip


def test_an_importer_with_long_steps_sees_each_release(unit: Path) -> None:
    """A half period of 0.5 s has a release of 26 ms; the importer asks for a row a second."""
    found = _run(unit, "ModelExchange", 4.9, A=1.01)
    changes = found["time"][1:][np.diff(found["mode(brake)"]) != 0]
    half = math.pi / 6.28
    release = math.asin(1.01 ** (-1 / 3)) / 6.28
    assert changes[::2] == pytest.approx([release + k * half for k in range(10)], abs=1e-6)
    assert len(changes) == 20


@pytest.mark.parametrize("kind", ["ModelExchange", "CoSimulation"])
def test_a_bell_of_microseconds_is_not_stepped_over(unit: Path, kind: str) -> None:
    """Its momentum is ``P d sqrt(pi)``; no friction takes any of it."""
    found = _run(unit, kind, 5.0, P=1e5, level=0.0)
    expected = 1e5 * 1e-5 * math.sqrt(math.pi)
    tolerance = 1e-5 if kind == "ModelExchange" else 1e-3
    assert found["v"][-1] == pytest.approx(expected, rel=tolerance)


def test_parameters_that_are_set_tell_how_fine_a_source_is(unit: Path) -> None:
    found = _run(unit, "ModelExchange", 5.0, P=1e3, d=1e-3, b=1.7, level=0.0)
    assert found["v"][-1] == pytest.approx(math.sqrt(math.pi), rel=1e-5)
