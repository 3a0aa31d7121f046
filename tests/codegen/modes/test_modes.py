"""Which ports stick and which way the others slip, at one instant."""

import numpy as np
import pytest
from oracles.chains import random_chain
from oracles.contact import efforts_at_rest
from oracles.models import block, clutches, pulled_block, stacked_blocks
from references.build import bond_graph

import bondgraph as bg
from codegen import Ramp, Simulator, simulator

BLOCKS = {"m_1": 2.0, "m_2": 1.0, "L_1": 3.0, "L_2": 1.0, "r_1": 1, "r_2": 1}


SOON = 1e-4


def _mode(run: Simulator, state: dict[str, float], inputs: dict[str, object], *slips: str) -> tuple:
    """The sign of each slip a moment after the start: 0 where it sticks."""
    result = run.run([0.0, SOON], state, inputs)
    return tuple(
        0 if abs(result[slip][-1]) < 1e-12 else int(np.sign(result[slip][-1])) for slip in slips
    )


@pytest.fixture(scope="module")
def one() -> Simulator:
    return simulator(bg.derive(block()), {"m": 2.0, "F_c": 3.0})


@pytest.mark.parametrize(
    ("v", "push", "mode"),
    [(0.5, 0.0, 1), (-0.5, 9.0, -1), (1e-2, -9.0, 1), (0.0, 2.9, 0), (0.0, -2.9, 0), (0.0, 3.1, 1),
     (0.0, -3.1, -1), (0.0, 0.0, 0), (0.0, 3.0, 0), (0.0, -3.0, 0)],
)  # fmt: skip
def test_one_port(one: Simulator, v: float, push: float, mode: int) -> None:
    assert _mode(one, {"v": v}, {"P": push}, "slip") == (mode,)


@pytest.mark.parametrize(("slope", "mode"), [(1.0, 1), (-1.0, 0), (0.0, 0)])
def test_a_tie_is_decided_by_what_comes_next(one: Simulator, slope: float, mode: int) -> None:
    assert _mode(one, {}, {"P": Ramp(-1.0, slope, 3.0 - slope)}, "slip") == (mode,)
    assert _mode(one, {}, {"P": Ramp(-1.0, -slope, slope - 3.0)}, "slip") == (-mode,)


def test_a_tie_is_decided_by_a_state_that_will_rise() -> None:
    """The spring holds just as much as friction; its end moves on, or back."""
    run = simulator(bg.derive(pulled_block()), {"m": 1.0, "k": 10.0, "F_c": 3.0})
    assert _mode(run, {"F": 3.0}, {"V": 0.9}, "slip") == (1,)
    assert _mode(run, {"F": 3.0}, {"V": -0.9}, "slip") == (0,)
    assert _mode(run, {"F": -3.0}, {"V": -0.9}, "slip") == (-1,)


@pytest.mark.parametrize("seed", range(30))
def test_two_blocks_at_rest_go_the_way_of_gauss_principle(seed: int) -> None:
    """Signs of the slip accelerations that least constraint gives, with the blocks at rest."""
    rng = np.random.default_rng(seed)
    run = simulator(bg.derive(stacked_blocks()), BLOCKS)
    p = rng.normal(size=2) * 4
    M, W, L = np.diag([2.0, 1.0]), np.array([[1.0, 0.0], [-1.0, 1.0]]), np.array([3.0, 1.0])
    f = efforts_at_rest(M, W, p, -L, L, np.zeros(2))
    slip_acceleration = W @ np.linalg.solve(M, p - W.T @ f)
    expected = np.where(np.abs(slip_acceleration) < 1e-9, 0, np.sign(slip_acceleration))
    found = _mode(run, {}, {"P_1": p[0], "P_2": p[1]}, "s_1", "s_2")
    assert found == tuple(expected.astype(int).tolist())


@pytest.mark.parametrize("seed", range(30))
def test_random_chains_at_rest_go_the_way_of_gauss_principle(seed: int) -> None:
    """Any number of ports, redundant ones among them; rates of the whole model, friction included."""
    rng = np.random.default_rng(1000 + seed)
    chain = random_chain(rng)
    run = simulator(bg.derive(chain.graph()), {})
    n, L = len(chain.masses), rng.uniform(0.1, 2, len(chain.friction))
    p = rng.normal(size=n) * 3
    f = efforts_at_rest(np.diag(chain.masses), chain.W, p, -L, L, np.zeros(len(L)))
    expected = (p - chain.W.T @ f) / chain.masses
    inputs = {f"P{i}": p[i] for i in range(n)} | {f"L{i}": level for i, level in enumerate(L)}
    rate = run.rhs(0.0, np.zeros(len(run.states)), [inputs[name] for name in run.inputs])
    found = [rate[run.states.index(f"v{i}")] for i in range(n)]
    assert found == pytest.approx(expected, abs=1e-9)


def test_a_port_below_its_breakaway_sticks_even_if_it_could_slip() -> None:
    law = bg.DryFriction("F_c", 1, 2)
    run = simulator(bg.derive(block(law)), {"m": 2.0, "F_c": 3.0})
    assert _mode(run, {}, {"P": 5.9}, "slip") == (0,)
    assert _mode(run, {}, {"P": 6.1}, "slip") == (1,)


def test_slip_within_rounding_of_large_speeds_counts_as_none() -> None:
    """1e5 - 1e5 (1 + 1e-15) is rounding; a thousandth is not."""
    run = simulator(bg.derive(clutches(bg.DryFriction("L"))), {"I_1": 0.5, "I_2": 0.25, "L": 9.0})
    for gap, mode in ((1e-10, 0), (1e-1, 1)):
        start = {"w_1": 1e5 + gap, "w_2": 1e5}
        result = run.run([0.0, SOON], start, {"T_1": 3.0, "T_2": -3.0})
        assert (abs(result["slip"][-1]) > 1e-3) == bool(mode)
        assert result["f_0"][0] == pytest.approx(9.0 if mode else 3.0, rel=1e-6)


def test_no_consistent_mode_is_an_error_with_the_numbers() -> None:
    """Held to half the level only: between the two neither rest nor slip fits."""
    nodes = {"m": 2.0, "F_c": 3.0, "ratio": 0.5}
    run = simulator(bg.derive(block(bg.DryFriction("F_c", 1, "ratio"))), nodes)
    with pytest.raises(bg.BondGraphError, match=r"ground|breakaway"):
        _mode(run, {}, {"P": 2.0}, "slip")


def test_a_model_without_friction_has_the_empty_mode() -> None:
    nodes = [bg.Se("push", "P"), bg.One("mass"), bg.I("m", "m", flow="v")]
    run = simulator(bg.derive(bond_graph(nodes, "push>mass>m")), {"m": 1.0})
    assert _mode(run, {"v": 1.0}, {"P": 1.0}) == ()
