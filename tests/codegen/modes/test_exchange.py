"""Impulses among storages whose laws bend: what these hold stays, whatever way is run; by hand and scipy."""

import random
from collections.abc import Callable

import numpy as np
import pytest
from oracles.exported import loaded
from references.build import bond_graph
from scipy.integrate import quad
from scipy.optimize import brentq
from soak.families import seeds

import bondgraph as bg
from codegen import simulator, to_python

pytestmark = pytest.mark.usefixtures("compiled_quickly")

BACKENDS = ("numpy", "c")


def rising(law: Callable[[float], float], speed: float) -> float:
    """The momentum at a speed of a law that rises by half of it at the least."""
    most = 2 * abs(speed) + 1
    return brentq(lambda p: law(p) - speed, -most, most, xtol=1e-15)


CUBIC, SOFTER = "{0}/2 + {0}**3", "{0} + tanh({0})/2"
LAWS: dict[str, tuple[Callable[[float], float], Callable[[float], float]]] = {
    "sinh({})": (np.sinh, np.arcsinh), "exp({}) - 1": (np.expm1, np.log1p),
    "{}/3": (lambda p: p / 3, lambda v: 3 * v),
    "3*tan({})": (lambda p: 3 * np.tan(p), lambda v: np.arctan(v / 3)),
    CUBIC: (lambda p: p / 2 + p**3, lambda v: rising(LAWS[CUBIC][0], v)),
    SOFTER: (lambda p: p + np.tanh(p) / 2, lambda v: rising(LAWS[SOFTER][0], v)),
}  # fmt: skip
"""Speeds by momenta and back: some harden, one never comes below -1, one holds no more than so much."""


def held(law: str, speed: float) -> float:
    """The momentum at a speed."""
    return LAWS[law][1](speed)


def moving(law: str, speed: float) -> float:
    """The energy at a speed, of the integral over the momentum."""
    return quad(LAWS[law][0], 0, held(law, speed), epsabs=0, epsrel=1e-13)[0]


def chain(laws: list[str], ratios: list[float]) -> bg.StateEquations:
    """Shafts in a row, each with a dog onto a gear onto the next; all dogs close at 1 s."""
    nodes, bonds = [], []
    for k, law in enumerate(laws):
        nodes += [bg.One(f"s{k}"), bg.I(f"m{k}", law=law.format(f"p_m{k}"), flow=f"v{k}")
                  if law != "{}/3" else bg.I(f"m{k}", 3, flow=f"v{k}")]  # fmt: skip
        bonds.append(f"s{k}>m{k}")
    for k, ratio in enumerate(ratios):
        nodes += [
            bg.Zero(f"z{k}"),
            bg.TF(f"g{k}", ratio),
            bg.Sw(f"dog{k}", on="1 - t", off="t - 1"),
        ]
        bonds += [f"s{k}>z{k}>g{k}>s{k + 1}", f"z{k}>dog{k}"]
    return bg.derive(bond_graph(nodes, " ".join(bonds)))


@pytest.mark.parametrize("seed", seeds("exchanged"))
def test_momenta_of_all_that_is_joined_stay(seed: int) -> None:
    """The one that all have together, that is; speeds follow gears, and energy is what the dogs take."""
    rng = random.Random(seed)
    count = rng.randint(2, 5)
    laws = [rng.choice(["sinh({})", CUBIC]), *(rng.choice([*LAWS]) for _ in range(count - 1))]
    ratios = [rng.choice([-1, 1]) * rng.uniform(0.4, 2.5) for _ in laws[1:]]
    start = {f"v{k}": rng.uniform(-0.9, 6.0) for k in range(count)}
    factors = np.cumprod([1.0, *ratios])
    dogs = [f"dog{k}" for k in range(count - 1)]
    total = sum(f * held(law, v) for f, law, v in zip(factors, laws, start.values(), strict=True))
    # exp(p) - 1 never comes to -1.
    ends = [-1 / f for f, law in zip(factors, laws, strict=True) if "exp" in law]
    low = max([-200.0, *(one * (1 - 1e-14) for one in ends if one < 0)])
    high = min([200.0, *(one * (1 - 1e-14) for one in ends if one > 0)])

    def left(v: float) -> float:
        return sum(f * held(law, f * v) for f, law in zip(factors, laws, strict=True)) - total

    assert left(low) < 0 < left(high)
    v = brentq(left, low, high, xtol=1e-14)
    equations = chain(laws, ratios)
    for backend in BACKENDS:
        run = simulator(equations, {}, backend=backend).run([0, 0.5, 1.5], start, initially_on=dogs)
        for k, f in enumerate(factors):
            assert run[f"v{k}"][-1] == pytest.approx(f * v, rel=1e-9, abs=1e-9)
        energies = [
            sum(moving(law, x) for law, x in zip(laws, speeds, strict=True))
            for speeds in (start.values(), factors * v)
        ]
        audit = run.audit()
        assert audit.impacts == pytest.approx(energies[0] - energies[1], rel=1e-8, abs=1e-8)
        for k, law in enumerate(laws):
            gained = moving(law, factors[k] * v) - moving(law, start[f"v{k}"])
            assert run.work(f"m{k}")[-1] == pytest.approx(gained, rel=1e-8, abs=1e-8)


def test_far_beyond_where_newton_by_itself_would_go_astray() -> None:
    """From a speed of 1e6 asinh(v) is flat: whole steps would leap farther and farther."""
    right = brentq(lambda v: 2 * np.arcsinh(v) - np.arcsinh(1e6), 0, 1e6, xtol=1e-12)
    for backend in BACKENDS:
        run = simulator(chain(["sinh({})", "sinh({})"], [1.0]), {}, backend=backend).run(
            [0, 2], {"v0": 1e6}, initially_on=["dog0"]
        )
        assert run["v1"][-1] == pytest.approx(right, rel=1e-11)


@pytest.mark.parametrize("e", [0.0, 0.4, 1.0])
def test_nonlinear_masses_collide(e: float) -> None:
    """Momentum stays, and the relative speed comes back e times: two that approach along one line."""
    nodes = [bg.One("a"), bg.I("m0", law="sinh(p_m0)", flow="v0"), bg.Zero("gap"),
             bg.Stop("wall", restitution=e, start=1), bg.One("b"),
             bg.I("m1", law="p_m1/2 + p_m1**3", flow="v1")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "a>m0 b>gap>a b>m1 gap>wall"))
    total = np.arcsinh(3.0) + held(CUBIC, 1.0)
    slower = brentq(lambda v: np.arcsinh(v) + held(CUBIC, v + 2 * e) - total, -9, 9, xtol=1e-14)
    for backend in BACKENDS:
        run = simulator(equations, {}, backend=backend).run(
            [0, 0.4, 0.6], {"v0": 3.0, "v1": 1.0}, initially_on=["wall"]
        )
        assert run["v0"][-1] == pytest.approx(slower, rel=1e-10)
        assert run["v1"][-1] == pytest.approx(slower + 2 * e, rel=1e-10)


def test_what_a_meter_counts_of_an_impulse_is_what_went_through() -> None:
    """Of three capacitors, one on another's node behind the meter, the charge that leaves that one."""
    nodes = [bg.Zero("n"), bg.C("a", law="sinh(q_a)", effort="e_a"), bg.One("way"),
             bg.Df("meter", integrate="Q"), bg.C("b", law="q_b/2 + q_b**3"), bg.One("j"),
             bg.Sw("s", on="t - 1", off="-1"), bg.Zero("m"), bg.C("c", "1/2", effort="e_c")]  # fmt: skip
    graph = bond_graph(nodes, "n>a n>way way>meter way>b n>j j>s j>m m>c")
    e0 = 5.0

    def charge(e: float) -> float:
        return np.arcsinh(e) + held(CUBIC, e)

    e1 = brentq(lambda e: charge(e) + e / 2 - charge(e0), 0, 5, xtol=1e-15)
    equations = bg.derive(graph)
    for backend in BACKENDS:
        run = simulator(equations, {}, backend=backend).run([0, 2], {"e_a": e0})
        assert run["e_a"][-1] == pytest.approx(e1, rel=1e-12)
        assert run["e_c"][-1] == pytest.approx(e1, rel=1e-12)
        assert run["Q"][-1] == pytest.approx(held(CUBIC, e1) - held(CUBIC, e0), rel=1e-12)
    module = loaded(to_python(equations, {}))
    told = module.simulate(np.array([0.0, 2.0]), {"e_a": e0}, {}, step=0.01)
    assert told["e_a"][-1] == pytest.approx(e1, rel=1e-9)
    assert told["Q"][-1] == pytest.approx(held(CUBIC, e1) - held(CUBIC, e0), rel=1e-9)


@pytest.mark.parametrize("backend", BACKENDS)
def test_laws_that_have_no_value_in_common_are_refused_by_name(backend: str) -> None:
    """A speed between -1 and 1 and one between 2 and 4 are never the same."""
    nodes = [bg.One("a"), bg.I("m0", law="tanh(p_m0)", flow="v0"), bg.Zero("z"), bg.One("b"),
             bg.I("m1", law="3 + tanh(p_m1)", flow="v1"), bg.Sw("dog", on="1 - t", off="t - 1")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "a>m0 a>z>b b>m1 z>dog"))
    ready = simulator(equations, {}, backend=backend)
    with pytest.raises(
        bg.SimulationError, match="no impulse is found that keeps what nonlinear storages"
    ):
        ready.run([0, 2], {"v0": 0.5, "v1": 2.5}, initially_on=["dog"])
