"""A dog that comes to hold a mass against what a law of its speed gives: the impulse and what follows."""

import numpy as np
import pytest
from oracles.exported import loaded
from references.build import bond_graph
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import bondgraph as bg
from codegen import Step, simulator, to_python

T = np.linspace(0.0, 1.0, 41)
NODES = [bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"), bg.Zero("z"),
         bg.R("belt", law="sin(2*v)/3 + sin(3*t)/4", gives="flow", flow="w"),
         bg.Sw("dog", on="0.5 - gate", flow="slip", effort="f")]  # fmt: skip
EQUATIONS = bg.derive(bond_graph(NODES, "push>n>m n>z z>belt z>dog"))
NUMBERS = {"m": 0.5}
JOINS = 0.31
INPUTS = {"P": 0.4, "gate": Step(JOINS, 1.0, 0.0)}


def _by_hand() -> np.ndarray:
    """v' = P/m until it joins; there v jumps to what solves v = w(v, t), and follows that."""
    free = 1.0 + 0.8 * T
    before = 1.0 + 0.8 * JOINS
    after = brentq(lambda v: v - np.sin(2 * v) / 3 - np.sin(3 * JOINS) / 4, -before, before)

    def rate(t: float, v: np.ndarray) -> np.ndarray:
        return 0.75 * np.cos(3 * t) / (1 - 2 * np.cos(2 * v) / 3)

    late = T[JOINS < T]
    run = solve_ivp(rate, (JOINS, 1.0), [after], "DOP853", late, rtol=1e-12, atol=1e-13)
    return np.concatenate([free[JOINS >= T], run.y[0]])


KNOWN = _by_hand()


@pytest.mark.parametrize(("backend", "method"), [("numpy", "auto"), ("c", "auto"), ("c", "DOP853")])
def test_the_mass_jumps_to_the_laws_own_speed(backend: str, method: str) -> None:
    """Not along the law's tangent, which would leave a hundredth of it."""
    run = simulator(EQUATIONS, NUMBERS, backend=backend).run(
        T, {"v": 1.0}, INPUTS, method, 1e-11, 1e-13
    )
    assert run["v"] == pytest.approx(KNOWN, abs=1e-9)
    held = T > JOINS
    assert run["v"][held] == pytest.approx(run["w"][held], abs=1e-10)


def test_exported_python_jumps_there_at_the_step_after() -> None:
    run = loaded(to_python(EQUATIONS, NUMBERS)).simulate(T, {"v": 1.0}, INPUTS, step=1e-3)
    assert run["v"] == pytest.approx(KNOWN, abs=1e-5)
