"""Loops of a PID controller and a random linear plant, against python-control's loops of the same."""

import control
import numpy as np
import pytest
from soak.families import seeds

import bondgraph as bg
import codegen
from codegen import Step

Plant = tuple[list[object], tuple[str, ...], control.StateSpace]
"""Nodes and paths of a plant from u to y, and the same for python-control."""


def _by_matrices(draw: np.random.Generator) -> Plant:
    n = int(draw.integers(1, 5))
    A = draw.normal(size=(n, n)).round(3)
    B, C = draw.normal(size=(n, 1)).round(3), draw.normal(size=(1, n)).round(3)
    D = draw.choice([0.0, 0.5]) * np.ones((1, 1))
    return [bg.StateSpace("y", "u", A, B, C, D)], (), control.ss(A, B, C, D)


def _by_polynomials(draw: np.random.Generator) -> Plant:
    n = int(draw.integers(1, 5))
    den = np.poly(-draw.uniform(0.2, 5, size=n)).round(3)
    num = draw.normal(size=int(draw.integers(1, n + 2))).round(3)
    return [bg.TransferFunction("y", "u", num, list(den))], (), control.ss(control.tf(num, den))


def _by_bonds(draw: np.random.Generator) -> Plant:
    """Masses in a row with springs and dampers between, the first one pushed, the last one's speed told."""
    n = int(draw.integers(1, 4))
    m, b = draw.uniform(0.5, 2, size=(2, n)).round(3)
    k = draw.uniform(1, 9, size=n - 1).round(3)
    nodes: list[object] = [bg.Se("push", "1*u"), bg.Function("y", f"1*v_{n - 1}")]
    paths = ["push > j_0"]
    A = np.zeros((2 * n - 1, 2 * n - 1))
    for i in range(n):
        nodes += [bg.One(f"j_{i}"), bg.I(f"m_{i}", m[i], flow=f"v_{i}"), bg.R(f"b_{i}", b[i])]
        paths += [f"j_{i} > m_{i}", f"j_{i} > b_{i}"]
        A[i, i] = -b[i] / m[i]
    for i in range(n - 1):
        nodes += [bg.Zero(f"z_{i}"), bg.C(f"c_{i}", f"1/{k[i]}")]
        paths += [f"j_{i} > z_{i} > j_{i + 1}", f"z_{i} > c_{i}"]
        A[n + i, [i, i + 1]] = k[i], -k[i]
        A[i, n + i], A[i + 1, n + i] = -1 / m[i], 1 / m[i + 1]
    B, C = np.eye(2 * n - 1, 1) / m[0], np.eye(1, 2 * n - 1, n - 1)
    return nodes, tuple(paths), control.ss(A, B, C, 0)


PLANTS = (_by_matrices, _by_polynomials, _by_bonds)


@pytest.mark.parametrize("seed", seeds("pid-loops"))
def test_poles_and_steps_are_those_of_python_control(seed: int) -> None:
    draw = np.random.default_rng(seed)
    nodes, paths, plant = PLANTS[seed % len(PLANTS)](draw)
    kp, kd = draw.uniform(0.1, 3), draw.choice([0, draw.uniform(0.1, 1)])
    ki, tau = draw.choice([0, draw.uniform(0.1, 5)]), draw.uniform(0.02, 0.5)
    pid = bg.PID("u", "ref - y", "kp", "ki" if ki else 0, "kd" if kd else 0, "tau_d")
    equations = bg.derive(bg.graph([*nodes, pid], *paths), outputs=["y"])
    numbers = {"kp": kp, "ki": ki, "kd": kd, "tau_d": tau}
    numbers = {name: numbers[name] for name in numbers if numbers[name] and (name != "tau_d" or kd)}

    own = control.ss([], [], [], [[kp]])
    if ki:
        own = control.parallel(own, control.ss([[0]], [[ki]], [[1]], [[0]]))
    if kd:
        own = control.parallel(
            own, control.ss([[-1 / tau]], [[1 / tau]], [[-kd / tau]], [[kd / tau]])
        )
    loop = control.feedback(control.series(own, plant), 1)

    ours = bg.linearize(equations, inputs=["ref"]).numeric(numbers)
    poles = np.sort_complex(np.linalg.eigvals(ours.P))
    wanted = np.sort_complex(loop.poles())
    fastest = np.abs(wanted).max()
    assert np.abs(np.poly(poles) - np.poly(wanted)).max() <= 1e-9 * np.abs(np.poly(wanted)).max()
    times = np.linspace(0, min(5.0, 40 / fastest), 201)
    run = codegen.simulator(equations, numbers).run(times, inputs={"ref": Step(0.0, 1.0)})
    known = control.step_response(loop, times).outputs
    assert np.abs(run["y"] - known).max() <= 1e-9 * max(np.ptp(known), np.abs(known).max())
