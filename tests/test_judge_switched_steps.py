"""The judge of networks that switch, confirmed to 1e-3 by steps that know neither modes nor events.

Steps of h and h/2 give the limit for h to zero (Richardson); the stepper alone is of first order.
"""

import numpy as np
import pytest
from references.switched.choice import Choice, Mode
from references.switched.mechanisms import jenkins
from references.switched.named import (
    boost,
    bridge_chain,
    buck,
    full_bridge,
    half_bridge,
    opened_inductor,
    pulses,
    six_pulse,
    vienna,
)
from references.switched.network import Network, Wave
from references.switched.oracle import Course, Oracle
from references.switched.pencil import Array
from references.switched.random_networks import SPAN, random_switched
from references.switched.stepper import Stepper, lemke
from soak.families import seeds, whole

SAMPLES = 40
ONE = pulses(1e-3, 0.5, 2e-3, 1e-4)

NAMED: dict[str, tuple[Network, float, int]] = {
    "buck": (buck(10, 1e-4, 1e-4, 1, pulses(5e-5, 0.4, 2e-4), 4, 4), 2e-4, 800),
    "buck-discontinuous": (buck(10, 1e-5, 1e-4, 50, pulses(5e-5, 0.1, 2e-4)), 2e-4, 2000),
    "boost": (boost(10, 1e-4, 1e-4, 10, pulses(5e-5, 0.4, 2e-4), 8), 2e-4, 800),
    "half-bridge": (half_bridge(10, 1e-3, 1, 1e-2, ONE, pulses(1e-3, 0.4, 2e-3, 6.5e-4)), 2e-3, 800),
    "full-bridge": (full_bridge(10, 1e-3, 1, 1e-2, ONE, pulses(1e-3, 0.5, 2e-3, 4e-4), 1e-5, 0.5), 2e-3, 800),
    "six-pulse": (six_pulse(325, 50, 0.3, 1e-2, 10), 0.02, 800),
    "six-pulse-overlap": (six_pulse(325, 50, 0.3, 1e-4, 10, 1e-3), 0.02, 1200),
    "jenkins": (jenkins([1, 1], [0.3, 0.5], Wave(amplitude=2, frequency=0.25)), 8, 400),
    "iwan": (jenkins([1, 0.5, 2], [0.3, 0.5, 0.2], Wave(amplitude=2, frequency=0.25), 1.0), 8, 800),
    "opened-inductor": (opened_inductor(10, 1, 1, 2, 1), 3, 600),
}  # fmt: skip

TURNS = [pulses(1e-3, 0.3 + 0.1 * k, 0.02, 1e-4 * k) for k in range(3)]

LARGE: dict[str, tuple[Network, float, int]] = {
    "vienna": (
        vienna(325, 50, 0.2, 1e-3, 1e-3, 50, TURNS, 300, 500),
        0.02, 6_000,
    ),
    "24-diodes": (bridge_chain(6, 10, 50, 0.5, 0.02, 1e-2, 5), 0.02, 1200),
}  # fmt: skip


def _confirm(network: Network, span: float, steps: int) -> Course:
    """Each voltage and current to 1e-3 of the largest of its kind."""
    course = Oracle(network).run(np.linspace(0.0, span, SAMPLES + 1))
    rough = Stepper(network, span / steps).run(steps)
    fine = Stepper(network, span / (2 * steps)).run(2 * steps)
    every = steps // SAMPLES
    for kind in "ui":
        names = [name for name in rough if name[0] == kind]
        size = max((np.abs(course.columns[name]).max() for name in names), default=0.0)
        for name in names:
            limit = 2 * fine[name][2 * every - 1 :: 2 * every] - rough[name][every - 1 :: every]
            assert np.abs(limit - course.columns[name][1:]).max() <= 1e-3 * size, name
    return course


@pytest.mark.parametrize("name", NAMED | LARGE if whole("large-circuits") else NAMED)
def test_named_circuits(name: str) -> None:
    course = _confirm(*(NAMED | LARGE)[name])
    assert course.events
    assert not course.loose


@pytest.mark.parametrize("seed", seeds("judge-steps"))
def test_random_networks(seed: int) -> None:
    """Every fifth has more ports than are enumerated."""
    network = random_switched(np.random.default_rng(seed), 12 if seed % 5 == 4 else None)
    assert not _confirm(network, SPAN, 3000).loose


@pytest.mark.parametrize("seed", seeds("judge-modes"))
def test_no_second_mode_is_consistent(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """At every instant all modes are tried: with nothing shared or at rest for ever, one can begin."""
    network, begin = random_switched(np.random.default_rng(seed), 3), Choice.begin

    def checked(choice: Choice, old: Mode, y: Array) -> tuple[Mode, Array]:
        new, after = begin(choice, old, y)
        assert [m for m in choice._all(new) if choice._against(m, after) is None] == [new]
        return new, after

    monkeypatch.setattr(Choice, "begin", checked)
    assert Oracle(network).run(np.array([0.0, SPAN])).columns


def test_many_diodes_keep_their_signs() -> None:
    """A chain of 24 diodes in bridges: at every sample each conducts forwards or blocks backwards."""
    network = bridge_chain(6, 10.0, 50.0, 0.5, 0.02, 1e-2, 5.0)
    course = Oracle(network).run(np.linspace(0.0, 3e-3, 31))
    assert course.events
    for b in network.of("D"):
        u, i = course.columns[f"u_{b.name}"], course.columns[f"i_{b.name}"]
        assert i.min() >= -1e-9
        assert (u - b.more * i).max() <= 1e-9
        assert np.abs(i * (u - b.more * i)).max() < 1e-9


def test_lemke_finds_what_a_small_problem_has() -> None:
    """Cottle, Pang, Stone: for a P-matrix one solution, here (4/3, 7/3)."""
    M, q = np.array([[2.0, 1.0], [1.0, 2.0]]), np.array([-5.0, -6.0])
    assert lemke(M, q) == pytest.approx([4 / 3, 7 / 3])
    assert lemke(M, -q) == pytest.approx([0, 0])
    with pytest.raises(ArithmeticError, match="a ray"):
        lemke(np.array([[-1.0]]), np.array([-1.0]))
