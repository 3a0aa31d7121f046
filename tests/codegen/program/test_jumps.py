"""Which jumps of laws become ports, and what stays a law as it was written."""

import numpy as np
import pytest
import sympy as sp
from oracles.relays import mass, two
from references.build import bond_graph

import bondgraph as bg
import codegen
from codegen import simulator

V = sp.Symbol("v_r")


def jumps(equations: bg.StateEquations, numbers=(), laws=None) -> int:
    program = simulator(equations, dict(numbers), laws).closed.program
    return sum(port.jumps for port in program.friction)


@pytest.mark.parametrize(
    ("law", "count"),
    [
        ("sign(v_r)", 1),
        ("p*sign(v_r) + v_r**2", 1),
        ("sign(v_r) + 2*sign(3*v_r)", 1),
        ("sign(v_r - 1) + sign(1 - v_r)*3", 1),
        ("sign(v_r - 1) + sign(v_r + 1)", 2),
        (sp.Piecewise((2, V > 1), (0, V > -1), (-2, True)), 2),
        (sp.Piecewise((-2, V < -1), (0, V < 1), (2, True)), 2),
        # A factor that moves, a value that does, a threshold of a time alone, no order of thresholds.
        ("v_r*sign(v_r)", 0),
        ("sqrt(Abs(v_r))*sign(v_r)", 0),
        (sp.Piecewise((V - 1, V > 1), (0, True)), 0),
        ("sign(sin(t)) + v_r", 0),
        ("Abs(v_r) + Max(v_r, 0)", 0),
        (sp.Piecewise((2, V > -1), (1, V > 1), (0, True)), 0),
    ],
)
def test_jumps_are_ports_where_they_have_constant_factors(law: object, count: int) -> None:
    assert jumps(mass(law), {"p": 2.0} if "p*" in str(law) else {}) == count


def test_laws_share_a_jump() -> None:
    assert jumps(two("-sign(x - y)", "3*sign(2*y - 2*x)")) == 1


def test_jumps_of_storages_levels_and_own_states_stay() -> None:
    nodes = [bg.Se("F", "F"), bg.One("j"), bg.I("m", 1, flow="v"), bg.C("k", law="q_k + sign(q_k)/9"),
             bg.R("r", law=bg.DryFriction("2 + sign(q_k)"), effort="f", flow="s")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "F>j>m j>k j>r"))
    assert jumps(equations) == 0
    assert simulator(equations, {}).run([0.0, 1.0], {"v": 1.0}, {"F": 0.0})["v"][-1] < 1.0


def test_names_that_a_model_has_are_passed_over() -> None:
    nodes = [bg.Se("jump_1", "jump_1"), bg.One("j"), bg.I("m", 1, flow="offset_1"),
             bg.R("r", law="sign(hangs_1)", effort="smooth_1", flow="hangs_1")]  # fmt: skip
    run = simulator(bg.derive(bond_graph(nodes, "jump_1>j>m j>r")), {})
    result = run.run([0.0, 2.0], {"offset_1": 1.0}, {"jump_1": 0.2})
    assert {"jump_1", "offset_1", "hangs_1", "smooth_1"} <= {*result}
    assert result["offset_1"].tolist() == pytest.approx([1.0, 0.0], abs=1e-12)
    assert result["smooth_1"][-1] == pytest.approx(0.2, abs=1e-12)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_measures_of_events_are_of_all_jumps_of_a_node(backend: str) -> None:
    """v' = F - 2 sign(v - 1) - 2 sign(v + 1) from v = 2: by F it slides along the one or the other."""
    law = "2*sign(v_r - 1) + 2*sign(v_r + 1)"
    family = codegen.Family(mass(law), {}, backend=backend)
    measures = {
        "first": codegen.first_event("r", "slide"), "count": codegen.event_count("r", "slide"),
        "left": codegen.first_event("r", "leave"),
    }  # fmt: skip
    found = codegen.sweep(
        family, {"F": [3.0, -3.0]}, np.array([0.0, 1.0, 4.0]), measures, {"v": 2.0}, workers=0,
        progress=False,
    )  # fmt: skip
    assert found["first"].tolist() == pytest.approx([1.0, 1 / 7 + 2 / 3], abs=1e-9)
    assert found["count"].tolist() == [1, 1]
    assert np.isnan(found["left"]).all()
