"""What holds sticking ports: efforts, sharing, and the impulse that removes remaining slip."""

import numpy as np
import pytest
from oracles.chains import random_chain, way
from oracles.models import block, clutches, stacked_blocks

import bondgraph as bg
from codegen import Constant, simulator
from codegen.standalone.sharing import fair_share


def _fraction(efforts: np.ndarray, caps: np.ndarray) -> float:
    return float((np.abs(efforts) / caps).max())


@pytest.mark.parametrize("seed", range(30))
def test_no_other_way_of_sharing_has_a_smaller_largest_fraction(seed: int) -> None:
    """Tried in every direction and to every length around the answer: the problem is convex."""
    rng = np.random.default_rng(seed)
    ports, free = int(rng.integers(2, 6)), 1 + seed % 2
    share = rng.normal(size=(min(free, ports - 1), ports))
    efforts, caps = rng.normal(size=ports) * 10, rng.uniform(0.1, 20, ports)
    found = fair_share(efforts, share, caps)
    moved = np.linalg.lstsq(share.T, found - efforts, rcond=None)[0]
    assert share.T @ moved == pytest.approx(found - efforts, abs=1e-9)
    best = _fraction(found, caps)
    for _ in range(300):
        way = rng.normal(size=len(share)) * 10 ** rng.uniform(-6, 1)
        assert _fraction(found + share.T @ way, caps) >= best * (1 - 1e-9) - 1e-12


@pytest.mark.parametrize("caps", [[10.0, 30.0], [1.0, 1.0], [5.0, 0.0], [0.0, 2.0]])
def test_two_ports_share_in_proportion(caps: list[float]) -> None:
    caps_ = np.array(caps)
    found = fair_share(np.array([0.0, 8.0]), np.array([[1.0, -1.0]]), caps_)
    assert found == pytest.approx(8.0 * caps_ / caps_.sum(), abs=1e-12)


@pytest.mark.parametrize("directions", [1, 2])
def test_without_any_cap_or_any_load_nothing_breaks(directions: int) -> None:
    share = np.array([[1.0, -1.0, 0.0], [0.0, 1.0, -1.0]])[:directions]
    assert fair_share(np.zeros(3), share, np.array([1.0, 2.0, 3.0])) == pytest.approx(np.zeros(3))
    found = fair_share(np.array([1.0, 2.0, 3.0]), share, np.zeros(3))
    assert np.isfinite(found).all()
    assert found.sum() == pytest.approx(6.0)


def _snapshot(run, state: list[float], inputs: dict[str, float], mode: tuple[int, ...]):
    pieces = [Constant(inputs[name]).pieces[0] for name in run.inputs]
    return run.closed.at(0.0, np.array(state, dtype=float), pieces, mode)


def test_the_effort_that_holds_a_clutch_is_what_makes_both_accelerations_equal() -> None:
    """f = (T_1/I_1 - T_2/I_2)/(1/I_1 + 1/I_2)."""
    run = simulator(bg.derive(clutches(bg.DryFriction(99))), {"I_1": 0.5, "I_2": 0.25})
    now = _snapshot(run, [7.0, 7.0], {"T_1": 3.0, "T_2": -2.0}, (0,))
    assert now.u[run.closed.friction_inputs] == pytest.approx([(6 + 8) / 6.0])
    assert now.rate == pytest.approx([1 / 0.75] * 2)


@pytest.mark.parametrize("seed", range(20))
def test_held_ports_of_random_chains_do_not_accelerate(seed: int) -> None:
    """M v' = p - C v - K q - W^T f with W v' = 0 at the ports that stick: a linear system by hand."""
    rng = np.random.default_rng(seed)
    chain = random_chain(rng)
    run = simulator(bg.derive(chain.graph()), {})
    hold = run.closed.hold(tuple([0] * len(chain.friction)), run.closed.constant)
    W, n = chain.W, len(chain.masses)
    assert len(hold.share) == len(W) - np.linalg.matrix_rank(W)
    forces = {f"P{i}": float(rng.normal()) for i in range(n)}
    levels = {f"L{i}": 50.0 for i in range(len(W))}
    names, q_forces = list(run.states), np.zeros(n)
    state = np.where([name.startswith("F") for name in names], rng.normal(size=len(names)), 0.0)
    for place in chain.springs:
        q_forces += way(place, n) * state[names.index(f"F{chain.places.index(place)}")]
    order = [names.index(f"v{i}") for i in range(n)]
    now = _snapshot(run, state.tolist(), forces | levels, tuple([0] * len(W)))
    inverse = np.diag(1 / chain.masses)
    p = np.array([forces[f"P{i}"] for i in range(n)]) - q_forces
    multipliers = np.linalg.pinv(W @ inverse @ W.T) @ W @ inverse @ p
    expected = inverse @ (p - W.T @ multipliers)
    assert now.rate[order] == pytest.approx(expected, abs=1e-10)
    f = now.u[run.closed.friction_inputs]
    assert W.T @ f == pytest.approx(W.T @ multipliers, abs=1e-9)


@pytest.mark.parametrize("mode", [(0, 1), (1, 0), (0, 0)])
def test_remaining_slip_is_removed_by_an_impulse_at_the_held_ports(mode: tuple[int, ...]) -> None:
    """What is added to M v lies in the rows of W: all other momentum, and so least energy, is kept."""
    numbers = {"m_1": 2.0, "m_2": 1.0, "L_1": 3.0, "L_2": 1.0, "r_1": 1, "r_2": 1}
    run = simulator(bg.derive(stacked_blocks()), numbers)
    hold = run.closed.hold(mode, run.closed.constant)
    M, W = np.diag([2.0, 1.0]), np.array([[1.0, 0.0], [-1.0, 1.0]])
    held = W[[i for i, sign in enumerate(mode) if sign == 0]]
    v = np.array([0.3, -0.8])
    after = v + hold.take_away @ (hold.slip_x @ v)
    assert held @ after == pytest.approx(np.zeros(len(held)), abs=1e-14)
    impulse = M @ (after - v)
    multipliers = np.linalg.lstsq(held.T, impulse, rcond=None)[0]
    assert held.T @ multipliers == pytest.approx(impulse, abs=1e-13)


@pytest.mark.parametrize("begin", [0.0, 1e6])
def test_slip_left_by_rounding_is_removed_when_a_port_locks(begin: float) -> None:
    """On top of a speed of 1e4, and late: a time near 1e6 s is known to 1e-10 s, a slip to 1e-7 rad/s."""
    run = simulator(bg.derive(clutches(bg.DryFriction("L"))), {"I_1": 0.5, "I_2": 0.31, "L": 40.0})
    times = begin + np.linspace(0, 20, 201)
    result = run.run(times, {"w_1": 1e4, "w_2": 1e4 - 91.7}, {"T_1": 11.3, "T_2": -7.7})
    locked = result.time > result.events[0].time + 1e-9
    assert [e.kind for e in result.events] == ["stick"]
    assert np.abs(result["slip"][locked]).max() < 1e-10


def test_block_at_rest_is_held_by_exactly_its_load() -> None:
    run = simulator(bg.derive(block()), {"m": 2.0, "F_c": 5.0})
    now = _snapshot(run, [0.0], {"P": -4.25}, (0,))
    assert now.u[run.closed.friction_inputs] == pytest.approx([-4.25], rel=1e-15)
    assert now.caps == pytest.approx([5.0])
