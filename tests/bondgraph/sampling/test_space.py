"""Sampled models against scipy's discretisation and loops of python-control."""

import control
import numpy as np
import pytest
import scipy
from references.build import bond_graph

import bondgraph as bg
from bondgraph.sampling.space import over_a_period


def _plant(rng: np.random.Generator) -> tuple["bg.BondGraph", dict[str, float]]:
    """Two inertias with a shaft, dampers, and a motor at the first; the speed of the second is measured."""
    nodes = [
        bg.Se("motor", "1*tau"), bg.One("a"), bg.I("J_1", "J_1"), bg.R("b_1", "b_1"), bg.Zero("shaft"),
        bg.C("k", "1/k"), bg.One("b"), bg.I("J_2", "J_2", flow="omega"), bg.R("b_2", "b_2"),
    ]  # fmt: skip
    names = ("J_1", "J_2", "b_1", "b_2", "k")
    numbers = dict(zip(names, rng.uniform(0.2, 2.0, 5).tolist(), strict=True))
    numbers["k"] *= 20
    return nodes, numbers


PATH = "motor>a>J_1 a>b_1 a>shaft>k shaft>b>J_2 b>b_2"


def _pid(
    rng: np.random.Generator, period: float
) -> tuple[bg.nodes.elements.Node, "control.StateSpace", dict]:
    """A PID whose derivative is filtered, as difference equations, and the same for python-control."""
    K, Ki, Kd, a = rng.uniform([0.2, 0.1, 0.01, 0.1], [1.0, 1.0, 0.05, 0.6])
    node = bg.Controller(
        "pid", every=period, reads=["ref", "omega"], states={"z": 0, "d": 0},
        update={"z": "z + T*K_i*(ref - omega)", "d": "a*d + (1 - a)*(ref - omega)"},
        gives={"tau": "K*(ref - omega) + z + K_d*(1 - a)*(ref - omega - d)/T"},
    )  # fmt: skip
    D = K + Kd * (1 - a) / period
    other = control.ss(
        [[1, 0], [0, a]], [[period * Ki], [1 - a]], [[1, -Kd * (1 - a) / period]], [[D]], period
    )
    return node, other, {"K": K, "K_i": Ki, "K_d": Kd, "a": a, "T": period}


@pytest.mark.parametrize("seed", range(50))
def test_sampled_loops_are_those_of_python_control(seed: int) -> None:
    """Poles of the closed loop, and its response to a step, which a run shows as well."""
    rng = np.random.default_rng(seed)
    period = float(rng.choice([0.01, 0.02, 0.05]))
    nodes, numbers = _plant(rng)
    node, pid, more = _pid(rng, period)
    numbers |= more
    equations = bg.derive(bond_graph([*nodes, node], PATH))
    made = bg.linearize(equations, inputs=["ref"], outputs=["omega"], period=period).numeric(
        numbers
    )

    open_plant = bg.derive(bond_graph([bg.Se("motor", "tau"), *nodes[1:]], PATH))
    continuous = bg.linearize(open_plant, outputs=["omega"]).numeric(numbers).to_control()
    loop = control.feedback(control.c2d(continuous, period) * pid, 1)
    expected = sorted(loop.poles(), key=lambda p: (round(p.real, 7), round(p.imag, 7)))
    found = [p for p in made.poles() if abs(p) > 1e-12]
    found = sorted(found, key=lambda p: (round(p.real, 7), round(p.imag, 7)))
    np.testing.assert_allclose(found, expected, atol=1e-9)

    count = 40
    times = np.arange(count) * period
    response = control.forced_response(loop, times, np.ones(count)).outputs
    scale = np.abs(response).max()
    np.testing.assert_allclose(made.step_response(count)[:, 0, 0], response, atol=1e-9 * scale)
    if seed < 5:
        from codegen import simulator

        run = simulator(equations, numbers).run(times, inputs={"ref": 1.0})
        np.testing.assert_allclose(run["omega"], response, atol=1e-9 * scale)


def test_without_controllers_it_is_a_zero_order_hold() -> None:
    nodes, numbers = _plant(np.random.default_rng(7))
    open_plant = bg.derive(bond_graph([bg.Se("motor", "tau"), *nodes[1:]], PATH))
    found = bg.linearize(open_plant, outputs=["omega"], period="1/50").numeric(numbers)
    A, B, C, D = bg.linearize(open_plant, outputs=["omega"]).numeric(numbers).proper()
    expected = scipy.signal.cont2discrete((A, B, C, D), 0.02)
    for one, other in zip((found.P, found.Q, found.F, found.D), expected[:4], strict=True):
        np.testing.assert_allclose(one, other, atol=1e-14)
    response = found.frequency_response([0.3, 2.0])[:, 0, 0]
    theirs = found.to_control().frequency_response(2 * np.pi * np.array([0.3, 2.0]))
    np.testing.assert_allclose(response, np.squeeze(theirs.frdata), rtol=1e-12)
    np.testing.assert_array_equal(found.to_scipy().A, found.P)
    assert found.to_scipy().dt == 0.02


def test_what_is_set_on_the_way_counts_from_there() -> None:
    """x' = u_1, which a task sets to 1 a quarter into the period: it has come to 3/4."""
    from bondgraph.sampling.space import Tick

    A, nothing = np.array([[0.0, 1.0], [0.0, 0.0]]), np.zeros((2, 1))
    tick = Tick(0.25, (1,), np.zeros((1, 2)), np.ones((1, 1)))
    P, Q, F, D = over_a_period(A, nothing, np.eye(2), nothing, [tick], 1.0)
    np.testing.assert_allclose(Q[:, 0], [0.75, 1.0])
    np.testing.assert_allclose(P, [[1.0, 0.25], [0.0, 0.0]])
    np.testing.assert_allclose(F, np.eye(2))
    np.testing.assert_allclose(D, 0.0)


def test_periods_that_do_not_fit_are_refused() -> None:
    nodes, _ = _plant(np.random.default_rng(1))
    node = bg.Controller("slow", every=0.02, gives={"tau": "-omega"})
    equations = bg.derive(bond_graph([*nodes, node], PATH))
    with pytest.raises(bg.SignalError, match="no multiple of 1/50, at which 'slow' works"):
        bg.linearize(equations, period=0.03)
    for period in (0, -1, "T"):
        with pytest.raises(bg.SignalError, match="must be a number above zero"):
            bg.linearize(equations, period=period)
