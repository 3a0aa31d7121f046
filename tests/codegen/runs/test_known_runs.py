"""Runs under known sources: no release that is short beside the run is missed, on any route."""

import math

import networkx as nx
import numpy as np
import pytest
import sympy as sp
from scipy.integrate import quad
from scipy.optimize import brentq
from soak.families import seeds

import bondgraph as bg
from codegen import Family, Sampled, Simulator, simulator, sweep
from codegen.record.measures import event_count, final, first_event

CURVED = bg.DryFriction("level*(1 + s**2/10**9)")
"""A level that reads a signal: steps with control instead of exponentials."""


def pushed(force: object, law: object = None) -> bg.StateEquations:
    """A mass of 1 on friction, pushed by a known source; x is how far it has come."""
    g = nx.DiGraph()
    g.add_nodes_from([
        bg.Se("F", force), bg.One("m"), bg.I("M", 1, flow="v"),
        bg.R("brake", effort="F_b", flow="s", law=law), bg.Df("p", integrate="x"),
    ])  # fmt: skip
    g.add_edges_from([("F", "m"), ("m", "M"), ("m", "brake"), ("m", "p")])
    return bg.derive(g)


def _ready(force: str, law: object, backend: str, **numbers: float) -> Simulator:
    return simulator(pushed(force), {"level": 1, **numbers}, {"brake": law}, backend=backend)


ROUTES = [
    (backend, law)
    for backend in ("numpy", "c")
    for law in (bg.DryFriction("level"), CURVED)
]  # fmt: skip


def _third(amplitude: float, w: float) -> tuple[float, float, float]:
    """Release, stick and way under ``amplitude*sin(w t)**3`` against 1, from the integrals by hand."""
    release = math.asin(amplitude ** (-1 / 3)) / w

    def speed(t: float) -> float:
        rise = [-math.cos(w * at) + math.cos(w * at) ** 3 / 3 for at in (release, t)]
        return amplitude / w * (rise[1] - rise[0]) - (t - release)

    stick = brentq(speed, math.pi / w - release, math.pi / w)
    return release, stick, quad(speed, release, stick, epsabs=1e-15)[0]


@pytest.mark.parametrize(("backend", "law"), ROUTES)
def test_each_half_period_releases_a_body_once(backend: str, law: bg.DryFriction) -> None:
    """Four events a period, each where the closed form has it; back and forth, as sin**3 is odd."""
    release, stick, way = _third(1.05, 6.28)
    half = math.pi / 6.28
    result = _ready("1.05*sin(6.28*t)**3", law, backend).run([0, 10.2 * half])
    assert result.backend == backend
    expected = [at + k * half for k in range(10) for at in (release, stick)]
    assert [e.time for e in result.events] == pytest.approx(expected, abs=1e-8)
    assert [e.kind for e in result.events] == ["slip", "stick"] * 10
    result = _ready("1.05*sin(6.28*t)**3", law, backend).run([0, 0.9 * half])
    assert result["x"][-1] == pytest.approx(way, abs=1e-9)


@pytest.mark.parametrize("end", [100.0, 1000.0, 10000.0])
def test_there_are_as_many_events_a_second_however_long_a_run_is(end: float) -> None:
    release, stick, way = _third(1.05, 6.28)
    half = math.pi / 6.28
    result = _ready("1.05*sin(6.28*t)**3", bg.DryFriction(1), "c").run(np.linspace(0, end, 9001))
    assert result.backend == "c"
    expected = sum(
        at + k * half < end for k in range(int(end / half) + 1) for at in (release, stick)
    )
    assert len(result.events) == expected
    assert np.abs(result["x"]).max() == pytest.approx(way, rel=1e-6)


@pytest.mark.parametrize("law", [bg.DryFriction("level"), CURVED])
def test_as_many_in_numpy(law: bg.DryFriction) -> None:
    """Half periods; steps with control take their time, so a third of them."""
    half, count = math.pi / 6.28, 60 if law is not CURVED else 20
    result = _ready("1.05*sin(6.28*t)**3", law, "numpy").run([0, (count + 0.1) * half])
    assert len(result.events) == 2 * count


P, T, B, D = sp.symbols("P t b d")

SHAPES = {
    "step": (sp.Piecewise((P, (T > B) & (T < B + D)), (0, True)), lambda u: 1.0 if 0 < u < 1 else 0.0),
    "sine": (sp.Piecewise((P * sp.sin(sp.pi * (T - B) / D), (T > B) & (T < B + D)), (0, True)),
             lambda u: math.sin(math.pi * u) if 0 < u < 1 else 0.0),
    "bell": ("P*exp(-16*((t - b)/d - 0.5)**2)", lambda u: math.exp(-16 * (u - 0.5) ** 2)),
    "root": ("P*sqrt(Max(0, 1 - 4*((t - b)/d - 1/2)**2))",
             lambda u: math.sqrt(max(0.0, 1 - 4 * (u - 0.5) ** 2))),
}  # fmt: skip
"""Pulses from b to b + d of height P, and their shape over the pulse."""


@pytest.mark.parametrize("seed", seeds("pulses"))
@pytest.mark.parametrize("shape", SHAPES)
def test_pulses_a_ten_thousandth_of_the_run_wide_are_seen(shape: str, seed: int) -> None:
    """Release and stick from the integral of the shape; v = 0 again where it equals the level's."""
    force, of = SHAPES[shape]
    random = np.random.default_rng([11, seed])
    equations = pushed(force)
    end = 10 ** random.uniform(-1, 4)
    width, level = 1e-4 * end, random.uniform(0.5, 2)
    begin, height = random.uniform(0.1, 0.9) * end, level * random.uniform(1.2, 5)
    numbers = {"P": height, "b": begin, "d": width, "level": level}
    law = bg.DryFriction("level") if seed % 2 else CURVED
    ready = simulator(equations, numbers, {"brake": law}, backend="c" if seed % 3 else "numpy")
    events = ready.run([0.0, end], rtol=1e-12, atol=1e-16).events
    starts = 1e-9 if of(1e-9) * height > level else brentq(
        lambda u, h=height / level: of(u) * h - 1, 1e-12, 0.5)  # fmt: skip

    def speed(u: float, h: float = height / level, u_0: float = starts) -> float:
        parts = [quad(of, a, b, epsabs=1e-12)[0] for a, b in ((u_0, 0.5), (0.5, min(u, 1.0)))]
        tail = quad(of, 1.0, u, epsabs=1e-12)[0] if u > 1 else 0.0
        return h * (sum(parts) + tail) - (u - u_0)

    stops = brentq(speed, 0.5, 10.0, xtol=1e-13)
    expected = [begin + starts * width, begin + stops * width]
    assert [e.kind for e in events] == ["slip", "stick"], (shape, seed, events)
    assert [e.time for e in events] == pytest.approx(expected, abs=2e-6 * width + 1e-12 * end)


@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize("end", [10.0, 3600.0, 1e6])
def test_a_level_that_dips_is_the_same_in_a_run_of_any_length(backend: str, end: float) -> None:
    """Force 0.5; the level falls by 99.6 t to 0.4 at 1 and rises again by 9.6 t."""
    level = Sampled([0, 1, 2], [100, 0.4, 10])
    for law in (bg.DryFriction("p"), bg.DryFriction("p*(1 + s**2/10**9)")):
        run = simulator(pushed("F"), {}, {"brake": law}, backend=backend)
        events = run.run([0, end], inputs={"F": 0.5, "p": level}).events
        release = 1 - 0.1 / 99.6
        speed = 0.5 * 0.1 * (1 - release)
        # v = speed + 0.1 u - 4.8 u^2 after the turn.
        stick = 1 + (0.1 + math.sqrt(0.01 + 4 * 4.8 * speed)) / 9.6
        assert [e.time for e in events] == pytest.approx([release, stick], abs=1e-9)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_levels_that_are_expressions_of_time_release_where_they_dip(backend: str) -> None:
    """A force of 0.5 against a level 1 - 0.6 exp(-((t - 70)/0.001)^2): dips of 1e-5 of the run."""
    law = bg.DryFriction("1 - 0.6*exp(-((t - 70)/0.001)**2)")
    events = simulator(pushed("F"), {}, {"brake": law}, backend=backend).run(
        [0, 100], inputs={"F": 0.5}
    ).events  # fmt: skip
    release = 70 - 0.001 * math.sqrt(math.log(0.6 / 0.5))
    assert [e.kind for e in events] == ["slip", "stick"]
    assert events[0].time == pytest.approx(release, abs=1e-9)


def test_a_square_wave_is_exact() -> None:
    """sign(sin(pi t)) on a mass without friction: a triangle of v from 0 to 1."""
    g = nx.DiGraph()
    g.add_nodes_from([bg.Se("F", sp.sign(sp.sin(sp.pi * T))), bg.One("m"), bg.I("M", 1, flow="v")])
    g.add_edges_from([("F", "m"), ("m", "M")])
    times = np.linspace(0, 40, 401)
    for method in ("exact", "DOP853"):
        v = simulator(bg.derive(g), {}).run(times, method=method)["v"]
        assert v == pytest.approx(np.abs((times + 1) % 2 - 1), abs=1e-12)


def test_known_sources_are_no_inputs_and_no_columns() -> None:
    ready = _ready("A*sin(w*t)", bg.DryFriction("level"), "numpy", A=2.0, w=3.0)
    assert ready.inputs == ()
    result = ready.run(np.linspace(0, 2, 9))
    assert not [name for name in result.columns if name.startswith("known")]
    name = next(name for name in result.columns if name in ("F", "e_F"))
    assert result[name] == pytest.approx(2 * np.sin(3 * result.time), abs=1e-13)
    assert ready.rhs(0.5, [1.0, 0.0]) == pytest.approx([2 * math.sin(1.5) - 1, 1.0])


@pytest.mark.parametrize("law", [bg.DryFriction("level"), CURVED])
def test_sweeps_tell_each_run_its_own_source(law: bg.DryFriction) -> None:
    family = Family(
        pushed("A*sin(w*t)**3"), {"A": 1.05, "w": 6.28, "level": 1}, {"brake": law}, "c"
    )
    numbers = [(1.05, 6.28), (1.3, 2.0), (1.01, 20.0)]
    table = sweep(
        family, [{"A": a, "w": w} for a, w in numbers], [0.0, 2.0],
        {"n": event_count("brake", "slip"), "first": first_event("brake", "slip"), "x": final("x")},
    )  # fmt: skip
    for at, (a, w) in enumerate(numbers):
        release, stick, way = _third(a, w)
        half = math.pi / w
        assert table["first"][at] == pytest.approx(release, abs=1e-9)
        assert table["n"][at] == sum(release + k * half < 2 for k in range(20))
        moves = sum(stick + k * half < 2 for k in range(20))
        if moves == table["n"][at]:
            assert table["x"][at] == pytest.approx(way * (moves % 2), abs=1e-9)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_the_power_balance_closes(backend: str) -> None:
    result = _ready("1.5*sin(t)*cos(3*t)", bg.DryFriction("level/2"), backend).run([0, 9])
    assert result.events
    balance = result.audit()
    assert abs(balance.residual) <= 1e-9 * balance.turned_over
