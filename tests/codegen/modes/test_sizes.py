"""What cancels inside a law leaves rounding, which must not decide whether a port sticks."""

import numpy as np
import pytest
from oracles.models import block
from references.build import bond_graph

import bondgraph as bg
from codegen import Constant, Result, simulator
from codegen.modes.rounding import input_terms
from codegen.modes.trials import Sight

#: Two shafts tied by a clutch, each with its own road at its own speed.
NODES = [
    bg.One("a"), bg.One("b"), bg.I("J_a", "J", flow="w_a"), bg.I("J_b", "J", flow="w_b"),
    bg.Zero("slip"), bg.R("clutch", effort="tau", flow="dw"),
    bg.R("road_a", effort="tau_a", flow="v_a"), bg.R("road_b", effort="tau_b", flow="v_b"),
]  # fmt: skip
GRAPH = bond_graph(NODES, "a>J_a b>J_b a>slip>clutch slip>b a>road_a b>road_b")
LAWS = {"road_a": "c/w_0*(v_a - w_0)", "road_b": "c/w_0*(v_b - w_0)"}


def _run(laws: dict[str, str], level: float, speed: float) -> Result:
    ready = simulator(
        bg.derive(GRAPH), {"J": 0.8, "c": 6.1e4, "w_0": speed, "T": level},
        laws={**laws, "clutch": bg.DryFriction("T")},
    )  # fmt: skip
    return ready.run(np.linspace(0, 0.1, 11), {"w_a": speed, "w_b": speed})


@pytest.mark.parametrize("speed", [39.7, 40.0, 81.3, 0.3])
@pytest.mark.parametrize("level", [0.0, 1e-3, 100.0])
def test_shafts_that_turn_alike_stay_together_whatever_the_pressure(
    level: float, speed: float
) -> None:
    run = _run(LAWS, level, speed)
    assert abs(run["dw"]).max() < 1e-10
    assert abs(run["tau"]).max() < 1e-6


def test_a_nonlinear_road_decides_alike() -> None:
    laws = {name: f"c*sin({law}/c)" for name, law in LAWS.items()}
    run = _run(laws, 0.0, 39.7)
    assert abs(run["dw"]).max() < 1e-10


@pytest.mark.parametrize(
    "shape", ["c/w_0*(v_a - w_0)", "c/w_0*(v_a - w_0) + 0*v_a**2 + sin(0*v_a)"]
)
def test_terms_are_those_of_the_law(shape: str) -> None:
    """c w/w_0 and c, 61 kN m each at the operating point, and nothing of them left in the sum."""
    laws = {"road_a": shape, "road_b": "0*v_b", "clutch": bg.DryFriction("T")}
    ready = simulator(bg.derive(GRAPH), {"J": 0.8, "c": 6.1e4, "w_0": 39.7, "T": 0.0}, laws=laws)
    start = np.array([39.7, 39.7])
    found = input_terms(Sight(ready.closed, 0.0, start, []), (1,))
    at = [str(name) for name in ready.closed.program.inputs].index("tau_a")
    assert found[at] == pytest.approx(2 * 6.1e4, rel=0.51)


def test_external_inputs_count_as_they_are() -> None:
    ready = simulator(bg.derive(block()), {"m": 2.0, "F_c": 3.0})
    pieces = [Constant(-7.0).pieces[0]]
    here = Sight(ready.closed, 0.0, np.array([0.5]), pieces)
    assert 7.0 in input_terms(here, (1,)).tolist()
