"""Conditions at their limits: flat ones, those that come to rest at zero, those of time alone."""

import shutil

import numpy as np
import pytest
from references.build import bond_graph

import bondgraph as bg
from codegen import Constant, Sampled, Step, simulator

BACKENDS = [
    "numpy",
    pytest.param("c", marks=pytest.mark.skipif(shutil.which("cc") is None, reason="needs cc")),
]

PI = "3.14159265358979323846"


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_flat_condition_turns_on_where_it_is_zero(backend: str) -> None:
    """x = t - 1 and the condition 1e5 x^3 has a triple root."""
    nodes = [bg.One("m"), bg.I("M", 1, flow="v"), bg.Df("p", integrate="x"), bg.R("b", "d"), bg.One("j"),
             bg.Se("u", 1), bg.R("r", "1 + v**2"), bg.Sw("k", on="1e5*x**3")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "m>M m>p m>b u>j j>k j>r"))
    result = simulator(equations, {"d": 0}, backend=backend).run([0, 20], {"x": -1, "v": 1})
    ((time, port, kind, _),) = result.events
    assert (port, kind) == ("k", "on")
    assert time == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("way", ["step", "ramp"])
def test_a_condition_that_comes_to_rest_at_zero_changes_nothing(backend: str, way: str) -> None:
    """On until ``off`` = -guard rises above zero: v = (1 - exp(-2 t))/2."""
    nodes = [bg.Se("u", 1), bg.One("l"), bg.R("R", 1), bg.Sw("s", on="guard"), bg.Zero("n"),
             bg.C("C", 1, effort="v"), bg.R("Rl", 1)]  # fmt: skip
    ready = simulator(bg.derive(bond_graph(nodes, "u>l l>R l>s l>n n>C n>Rl")), {}, backend=backend)
    fall = {
        "step": Constant(1) + Step(0.75, -1),
        "ramp": Sampled([0, 0.5, 0.75, 1], [1, 1, 0, 0]),
    }
    times = np.linspace(0, 1, 5)
    told = r"switch 's' stays on while its command guard rests at zero, from t = 0.75 on.*on='guard - 1/2'"
    with pytest.warns(bg.ModelWarning, match=told):
        result = ready.run(times, inputs={"guard": fall[way]}, initially_on=["s"])
    assert result.events == ()
    assert result["s"].tolist() == [1.0] * 5
    assert result["v"] == pytest.approx((1 - np.exp(-2 * times)) / 2, abs=1e-9)


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("f", [50.0, 1234.5])
@pytest.mark.parametrize("end", [0.02, 0.05])
def test_a_switch_driven_by_time_has_its_instants_and_no_others(
    backend: str, f: float, end: float
) -> None:
    """A half wave is k/2f long; between them the circuit's exponentials."""
    nodes = [bg.Se("V", "V"), bg.One("s"), bg.Sw("S", on=f"sin(2*{PI}*f*t)"), bg.R("R", "R"), bg.Zero("n"),
             bg.C("C", "C", effort="v"), bg.R("Rl", "Rl")]  # fmt: skip
    numbers = {"V": 10.0, "R": 1e3, "C": 1e-6, "Rl": 1e3, "f": f}
    equations = bg.derive(bond_graph(nodes, "V>s>S s>R s>n n>C n>Rl"))
    result = simulator(equations, numbers, backend=backend).run([0.0, end], initially_on=["S"])
    edges = np.arange(1, int(np.floor(2 * f * end * (1 + 1e-12))) + 1) / (2 * f)
    assert [event.time for event in result.events] == pytest.approx(edges, abs=1e-9)
    assert [event.kind for event in result.events] == [
        ("off", "on")[k % 2] for k in range(len(edges))
    ]
    v, t = 0.0, 0.0
    for k, edge in enumerate([*edges.tolist(), end]):
        rest, rate = ((5.0, 2e3), (0.0, 1e3))[k % 2]
        v, t = rest + (v - rest) * np.exp(-rate * (edge - t)), edge
    assert result["v"][-1] == pytest.approx(v, abs=1e-8)


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("x_0", [1, 2, 3, 5])
def test_a_stop_on_which_a_mass_rests_lets_go(backend: str, x_0: int) -> None:
    """It falls with -1, rests at 0, and is pulled off with 1: x = (t - t_1)^2/2."""
    nodes = [bg.Se("push", "F"), bg.One("m"), bg.I("M", 1, flow="v"), bg.Df("pos", integrate="x"),
             bg.Sw("stop", on="e_stop", off="-x")]  # fmt: skip
    ready = simulator(bg.derive(bond_graph(nodes, "push>m m>M m>pos m>stop")), {}, backend=backend)
    pull = 2 * (2 * x_0) ** 0.5
    force = Constant(-1) + Step(pull, 2)
    result = ready.run([0, pull, pull + 1], {"x": x_0}, {"F": force}, initially_on=["stop"])
    assert result["x"] == pytest.approx([x_0, 0.0, 0.5], abs=1e-9)
    assert [event.kind for event in result.events] == ["off", "on"]
    landed = (2 * x_0) ** 0.5
    assert [event.time for event in result.events] == pytest.approx([landed, pull], abs=1e-9)


@pytest.mark.parametrize("backend", BACKENDS)
def test_friction_events_of_a_switching_are_told(backend: str) -> None:
    """A dog joins 4 rad/s and an inertia that a brake of 4 holds: 2 rad/s, which it stops in 1 s."""
    nodes = [bg.One("a"), bg.I("J1", 1, flow="w1"), bg.One("b"), bg.I("J2", 1, flow="w2"), bg.Zero("z"),
             bg.R("br", law=bg.DryFriction(4)), bg.Sw("dog", on="1 - t", off="t - 1")]  # fmt: skip
    ready = simulator(
        bg.derive(bond_graph(nodes, "a>J1 b>J2 b>br a>z z>dog z>b")), {}, backend=backend
    )
    result = ready.run([0, 1, 3], {"w1": 4}, initially_on=["dog"])
    told = [(event.port, event.kind) for event in result.events]
    assert told == [("dog", "off"), ("br", "slip"), ("br", "stick")]
    assert [event.time for event in result.events] == pytest.approx([1.0, 1.0, 2.0], abs=1e-9)
