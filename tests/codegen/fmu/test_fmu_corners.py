"""Corners of laws in units: located in co-simulation as in runs in C, indicators in model exchange."""

from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from fmpy import read_model_description, simulate_fmu
from references.build import bond_graph

import bondgraph as bg
import codegen

q = sp.Symbol("q_s")
PERIOD = 1.5 * np.pi


@pytest.fixture(scope="module")
def unit(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A mass of 1 on a spring of 4 above zero and of 1 below."""
    spring = q + 3 * sp.Max(0, q)
    nodes = [bg.One("n"), bg.I("m", 1, flow="v"), bg.C("s", law=spring)]
    equations = bg.derive(bond_graph(nodes, "n>m n>s"))
    path = tmp_path_factory.mktemp("units") / "corner.fmu"
    return codegen.write_fmu(path, equations, {}, initial={"v": 1.0})


def _error(unit: Path, kind: str, interval: float, **more: object) -> float:
    given = {"stop_time": 18.6, "output": ["v"], "output_interval": interval, **more}
    found = simulate_fmu(str(unit), fmi_type=kind, record_events=False, **given)
    u = np.mod(found["time"], PERIOD)
    speed = np.where(u < np.pi / 2, np.cos(2 * u), -np.cos(u - np.pi / 2))
    return float(np.abs(found["v"] - speed).max())


def test_co_simulation_stops_at_corners(unit: Path) -> None:
    """Inside communication steps of any length; over them its error would be 6e-9 in either case."""
    assert _error(unit, "CoSimulation", 0.11) < 1e-11
    assert _error(unit, "CoSimulation", 3.1) < 5e-9


def test_in_model_exchange_each_corner_is_an_indicator(unit: Path) -> None:
    assert read_model_description(str(unit)).numberOfEventIndicators == 1
    assert _error(unit, "ModelExchange", 0.11, relative_tolerance=1e-8) < 1e-5


def test_what_steps_without_a_look_at_corners_knows_none_of_them() -> None:
    nodes = [bg.One("n"), bg.I("m", 1, flow="v"), bg.C("s", law=sp.Abs(q) + q)]
    equations = bg.derive(bond_graph(nodes, "n>m n>s"))
    assert "side_" not in codegen.to_python(equations, {})
    assert "BG_CORNERS 1" in codegen.to_c(equations, {})["config.h"]
    plain = bg.derive(bond_graph([bg.One("n"), bg.I("m", 1), bg.C("s", 1)], "n>m n>s"))
    assert "BG_CORNERS 0" in codegen.to_c(plain, {})["config.h"]
