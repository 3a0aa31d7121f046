"""Redundant ports share as linear programs in turn would have them, in numpy and in C, however many."""

from collections.abc import Callable

import numpy as np
import pytest
from oracles.shares import SharesInC
from references.sharing import by_linear_programs

from codegen.standalone.sharing import fair_share

Share = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]

LARGEST = 24, 12
"""Ports, and directions."""


@pytest.fixture(scope="module", params=["numpy", "C"])
def shared(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Share:
    if request.param == "numpy":
        return fair_share
    return SharesInC(tmp_path_factory.mktemp("shares"), LARGEST[0])


def _case(seed: int, ports: int, free: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Efforts, directions and caps: at random; of integers; of ports like others; of ports without a
    cap; of equal caps and integer loads, where many references have the same load."""
    rng, kind = np.random.default_rng(seed), seed % 5
    share = (
        rng.normal(size=(free, ports)) if kind == 0 else rng.integers(-1, 2, (free, ports)) * 1.0
    )
    for _ in range(ports // 3 if kind > 1 else 0):
        share[:, rng.integers(ports)] = share[:, rng.integers(ports)] * rng.choice([1, -1])
    share[np.arange(free), np.arange(free)] = 1.0
    if np.linalg.matrix_rank(share) < free:
        share[:, :free] = np.eye(free)
    efforts = rng.normal(size=ports) * 10 if kind < 3 else rng.integers(-2, 3, ports) * 1.0
    caps = [rng.uniform(0.5, 20, ports)] * 3 + [rng.integers(0, 3, ports) * 1.0, np.ones(ports)]
    return efforts, share, caps[kind]


def _sizes(seed: int) -> tuple[int, int]:
    rng = np.random.default_rng(seed)
    ports = int(rng.integers(2, LARGEST[0] + 1))
    return ports, int(rng.integers(1, min(ports, LARGEST[1] + 1)))


@pytest.mark.parametrize("seed", range(60))
def test_shares_are_those_of_linear_programs(shared: Share, seed: int) -> None:
    efforts, share, caps = _case(seed, *_sizes(seed))
    size = max(1.0, np.abs(efforts).max())
    expected = by_linear_programs(efforts, share, caps)
    assert shared(efforts, share, caps) == pytest.approx(expected, rel=0, abs=1e-9 * size)


@pytest.mark.parametrize("seed", range(10))
def test_many_ports_share_along_many_directions(shared: Share, seed: int) -> None:
    """Of 24 ports along twelve, of which there are 2.5 million choices of thirteen."""
    efforts, share, caps = _case(seed, *LARGEST)
    size = max(1.0, np.abs(efforts).max())
    expected = by_linear_programs(efforts, share, caps)
    assert shared(efforts, share, caps) == pytest.approx(expected, rel=0, abs=1e-9 * size)


@pytest.mark.parametrize("seed", [3, 4, 9, 14])
def test_references_of_one_load_end(seed: int) -> None:
    """Sixty ports, many alike, where most exchanges leave the load as it was."""
    efforts, share, caps = _case(seed, 60, 30)
    found = fair_share(efforts, share, caps)
    assert found == pytest.approx(by_linear_programs(efforts, share, caps), rel=0, abs=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_another_order_of_ports_or_directions_is_the_same_share(shared: Share, seed: int) -> None:
    efforts, share, caps = _case(seed, 16, 8)
    rng = np.random.default_rng(seed)
    order, mixed = rng.permutation(16), np.linalg.qr(rng.normal(size=(8, 8)))[0] @ share
    found = shared(efforts, share, caps)
    again = shared(efforts[order], mixed[:, order], caps[order])
    assert again == pytest.approx(found[order], rel=0, abs=1e-11 * max(1.0, np.abs(efforts).max()))


def test_ports_that_nothing_moves_keep_what_they_carry(shared: Share) -> None:
    share = np.array([[0.0, 1.0, 0.0, -2.0], [0.0, 0.0, 0.0, 0.0]])[:1]
    found = shared(np.array([50.0, 9.0, -7.0, 0.0]), share, np.array([1.0, 2.0, 0.0, 1.0]))
    assert found == pytest.approx([50.0, 7.2, -7.0, 3.6], abs=1e-13)
