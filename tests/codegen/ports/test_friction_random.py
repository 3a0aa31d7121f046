"""Random chains with friction: always a motion, always consistent, and the one that small steps find."""

import numpy as np
import pytest
from oracles.chains import Chain, random_chain
from oracles.contact import time_stepped
from oracles.energy import misfit
from soak.families import seeds

import bondgraph as bg
from codegen import Result, simulator

TIMES = np.linspace(0, 2, 101)


def _inputs(chain: Chain) -> dict[str, object]:
    inputs: dict[str, object] = {f"P{i}": push for i, push in enumerate(chain.pushes)}
    return inputs | {f"L{i}": level for i, level in enumerate(chain.levels)}


def _run(chain: Chain, times: np.ndarray = TIMES) -> Result:
    start = {f"v{i}": v for i, v in enumerate(chain.start.tolist())}
    return simulator(bg.derive(chain.graph()), {}).run(times, start, _inputs(chain))


def _check_consistent(chain: Chain, result: Result) -> None:
    """At every sample: effort at its level where it slips, within its breakaway where it does not."""
    speeds = np.abs([result[f"v{i}"] for i in range(len(chain.masses))]).max() + 1.0
    for i, ratio in enumerate(chain.ratios):
        f, s, L = result[f"f{i}"], result[f"s{i}"], result[f"L{i}"]
        moving = np.abs(s) > 1e-7 * speeds
        assert f[moving] == pytest.approx((L * np.sign(s))[moving], rel=1e-9, abs=1e-9)
        assert (np.abs(f) <= ratio * L * (1 + 1e-9) + 1e-9).all()
        held = np.abs(f) > L * (1 + 1e-6) + 1e-9
        assert np.abs(s[held]).max(initial=0.0) < 1e-9
        inside = np.abs(f) < L * (1 - 1e-6) - 1e-9
        assert np.abs(s[inside]).max(initial=0.0) < 1e-9


@pytest.mark.parametrize("seed", seeds("friction-chains"))
def test_every_sample_is_consistent(seed: int) -> None:
    chain = random_chain(np.random.default_rng(seed))
    result = _run(chain)
    _check_consistent(chain, result)
    assert len(result.events) < 100


@pytest.mark.parametrize("seed", seeds("breakaway-chains"))
def test_every_sample_is_consistent_with_breakaway(seed: int) -> None:
    chain = random_chain(np.random.default_rng(seed), breakaway=True)
    result = _run(chain)
    _check_consistent(chain, result)
    assert len(result.events) < 100


@pytest.mark.parametrize("seed", seeds("implicit-steps"))
def test_velocities_are_those_of_small_implicit_steps(seed: int) -> None:
    """Breakaway at the level makes the motion unique. Steps of half the length halve the error:
    the difference of both is the error of the finer one, and extrapolation leaves much less."""
    chain = random_chain(np.random.default_rng(200 + seed))
    times = np.linspace(0, 2, 21)
    result = _run(chain, times)
    found = np.column_stack([result[f"v{i}"] for i in range(len(chain.masses))])
    system = (np.diag(chain.masses), chain.quadratic(chain.springs), chain.quadratic(chain.dampers),
              chain.W, chain.level, chain.push)  # fmt: skip
    start = (np.zeros(len(chain.masses)), chain.start)
    coarse, fine = (time_stepped(*system, start, times, steps) for steps in (40, 80))
    error = np.abs(fine - coarse).max()
    assert np.abs(found - fine).max() < 2 * error + 1e-9
    assert error < 0.1 * (np.abs(fine).max() + 0.1)


@pytest.mark.parametrize("seed", seeds("chain-power"))
def test_power_is_balanced(seed: int) -> None:
    chain = random_chain(np.random.default_rng(300 + seed), breakaway=bool(seed % 2))
    n = len(chain.masses)
    springs = [chain.places.index(place) for place in chain.springs]
    stiffness = list(chain.springs.values())

    def stored(r: Result) -> np.ndarray:
        kinetic = sum(m * r[f"v{i}"] ** 2 / 2 for i, m in enumerate(chain.masses.tolist()))
        return kinetic + sum(
            r[f"F{at}"] ** 2 / k / 2 for at, k in zip(springs, stiffness, strict=True)
        )

    def power(r: Result) -> np.ndarray:
        v = np.array([r[f"v{i}"] for i in range(n)])
        total = sum(r[f"P{i}"] * v[i] for i in range(n))
        total = total - np.einsum("it,ij,jt->t", v, chain.quadratic(chain.dampers), v)
        return total - sum(r[f"f{i}"] * r[f"s{i}"] for i in range(len(chain.friction)))

    signals = [*chain.pushes, *chain.levels]
    breaks = {b for signal in signals for b in signal.breakpoints if 0 < b < 2}
    assert misfit(lambda times: _run(chain, times), [0.0, *breaks, 2.0], stored, power) < 1e-9
