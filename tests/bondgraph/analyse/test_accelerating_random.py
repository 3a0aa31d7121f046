"""Linear models of random mechanisms in motion, against differences of the rates that a simulator has."""

import random
from collections.abc import Callable

import numpy as np
import pytest
import sympy as sp
from references.random_mechanisms import NUMBERS, random_mechanism
from soak.families import seeds

import bondgraph as bg
from codegen import Simulator, simulator
from codegen.numbers.arrays import Array

Rows = Callable[[Array, Array], Array]
"""Of states and inputs."""

STEP = 1e-5


def _slips(equations: bg.StateEquations, ready: Simulator, nodes: list[str]) -> Rows:
    """What the nodes receive."""
    numbers = {sp.Symbol(name): value for name, value in NUMBERS.items()}
    names = [sp.Symbol(name) for name in (*ready.states, *ready.inputs)]
    found = []
    for port in equations.ports:
        if port.element.name in nodes:
            row = equations.readings[port.received]
            assert not row.H
            terms = [e * equations.states[j] for j, e in row.F.items()]
            terms += [e * equations.inputs[j] for j, e in row.D.items()]
            found.append(sp.lambdify(names, sp.Add(*terms).subs(numbers)))
    return lambda x, u: np.array([slip(*x, *u) for slip in found])


def _onto(slips: Rows, gone: list[int]) -> Rows:
    """States with those that are ``gone`` such that nothing slips; slips are linear in these."""

    def onto(x: Array, u: Array) -> Array:
        x, now = x.copy(), slips(x, u)
        unit = np.eye(len(x))
        x[gone] -= (
            np.linalg.solve(np.array([slips(x + unit[j], u) - now for j in gone]).T, now)
            if gone
            else 0.0
        )
        return x

    return onto


@pytest.mark.parametrize("seed", seeds("accelerating-mechanisms"))
def test_it_is_the_slope_of_the_rates_in_motion(seed: int) -> None:
    rng = random.Random(seed)
    graph, holding = random_mechanism(rng)
    equations = bg.derive(graph, outputs=[])
    ready = simulator(equations, NUMBERS)
    x = np.array([rng.uniform(0.4, 1.4) for _ in ready.states])
    u = np.array([rng.uniform(1.0, 2.0) for _ in ready.inputs])
    stick = dict.fromkeys(holding, "stick")
    # Which states are left does not depend on the point.
    here = dict(zip((*ready.states, *ready.inputs), map(float, [*x, *u]), strict=True))
    first = bg.linearize(equations, here, mode=stick)
    kept = [ready.states.index(str(name)) for name in first.states]
    onto = _onto(_slips(equations, ready, holding), [j for j in range(len(x)) if j not in kept])
    x = onto(x, u)
    at = dict(zip((*ready.states, *ready.inputs), map(float, [*x, *u]), strict=True))
    model = (first if at == here else bg.linearize(equations, at, mode=stick)).numeric(NUMBERS)
    assert [ready.states[j] for j in kept] == list(model.states)

    def rates(x: Array, u: Array) -> Array:
        return np.asarray(ready.rhs(0.0, onto(x, u), u))[kept]

    assert np.abs(ready.rhs(0.0, x, u)).max() > 1e-3
    by_states = [rates(x + h, u) - rates(x - h, u) for h in STEP * np.eye(len(x))[kept]]
    columns = [ready.inputs.index(name) for name in model.inputs]
    by_inputs = [rates(x, u + h) - rates(x, u - h) for h in STEP * np.eye(len(u))[columns]]
    slopes = np.array(by_states + by_inputs).T / (2 * STEP)
    found = np.hstack([model.P, model.Q])
    assert found == pytest.approx(slopes, abs=1e-7 * (1 + np.abs(slopes).max()))
