"""Friction ports whose slips only sources rule: they cannot hold, and slip or pass through zero."""

from pathlib import Path

import networkx as nx
import numpy as np
import pytest
from oracles.drivelines import SPAN, Random, complaints, random_driveline
from oracles.exported import loaded
from oracles.units import Case, simulated
from references.build import bond_graph
from references.friction import Wave
from soak.families import seeds

import bondgraph as bg
import codegen
from codegen import Ramp, Sampled, Step, simulator
from codegen.sweeps.job import Job
from codegen.sweeps.measuring import batch_of

SECOND = np.linspace(0.0, 1.0, 5)
ROUTES = [("numpy", "auto"), ("numpy", "DOP853"), ("c", "auto"), ("c", "DOP853")]


def _brake(speed: str = "w") -> nx.DiGraph:
    nodes = [bg.Sf("motor", speed), bg.One("shaft"), bg.R("brake", effort="tau", flow="slip")]
    return bond_graph(nodes, "motor>shaft>brake")


def _driven(level: object = 10) -> Case:
    laws = {"brake": bg.DryFriction(level)}
    return Case(bg.derive(_brake()), {}, laws, {}, {"w": Ramp(0, 2, initial=-1)}, 1.0)


def _told(result: codegen.Result) -> list[tuple[float, str, str]]:
    return [(round(e.time, 8), str(e.port), e.kind) for e in result.events]


@pytest.mark.parametrize(("backend", "method"), ROUTES)
def test_a_slip_that_a_source_rules_passes_through_zero(backend: str, method: str) -> None:
    case = _driven()
    run = simulator(case.equations, {}, case.laws, backend)
    result = run.run(SECOND, inputs=case.inputs, method=method)
    assert result["slip"] == pytest.approx([-1, -0.5, 0, 0.5, 1], abs=1e-12)
    assert result["tau"][[0, 1, 3, 4]].tolist() == [-10, -10, 10, 10]
    assert _told(result) == [(0.5, "brake", "cross")]


@pytest.mark.parametrize(("backend", "method"), ROUTES)
def test_it_sticks_while_the_source_stays_at_zero_and_gives_nothing(
    backend: str, method: str
) -> None:
    """A pulse of 1e-4 s on a source that rests at zero before and after it, then a step and a slope."""
    speed = Sampled([0.2, 0.20005, 0.2001], [0.0, 3.0, 0.0]) + Step(0.4, 1.0) + Step(0.6, -1.0)
    speed = speed + Ramp(0.8, -1.0)
    case = _driven()
    run = simulator(case.equations, {}, case.laws, backend)
    result = run.run([0, 0.1, 0.3, 0.5, 0.7, 0.9], inputs={"w": speed}, method=method)
    assert result["tau"].tolist() == [0, 0, 0, 10, 0, -10]
    assert _told(result) == [
        (0.2, "brake", "slip"), (0.2001, "brake", "stick"), (0.4, "brake", "slip"),
        (0.6, "brake", "stick"), (0.8, "brake", "slip"),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("speed", "efforts", "events"),
    [
        ("-(t - 2/5)**2", [-10, -10, -10, -10, -10], []),
        ("Max(0, t - 1/3)", [0, 0, 10, 10, 10], [(0.33333333, "brake", "slip")]),
    ],
)
def test_it_follows_the_source_where_no_breakpoint_tells(
    speed: str, efforts: list[float], events: list[tuple[float, str, str]]
) -> None:
    """Touching zero is no event; leaving it where an expression has a corner is one."""
    equations = bg.derive(_brake(speed))
    result = simulator(equations, {}, {"brake": bg.DryFriction(10)}).run(SECOND)
    assert result["tau"].tolist() == efforts
    assert _told(result) == events


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_units_follow_it_both_ways(version: str, tmp_path: Path) -> None:
    case = _driven()
    unit = case.written(tmp_path / "unit.fmu", version)
    for kind in ("ModelExchange", "CoSimulation"):
        found = simulated(unit, kind, case, ["slip", "tau"], 11)
        before, after = found["time"] < 0.499, found["time"] > 0.501
        assert found["slip"] == pytest.approx(2 * found["time"] - 1, abs=1e-9)
        assert found["tau"][before] == pytest.approx(-10.0)
        assert found["tau"][after] == pytest.approx(10.0)


def _line(**changes: object) -> Random:
    """A mass between two shafts turned by sources, and what rubs between."""
    parts: dict[str, object] = {
        "masses": (1.0,), "speeds": (Wave(values=(1.9,)), Wave(values=(1.5,))),
        "springs": {}, "dampers": {}, "friction": ((0, 1), (0, 2)),
        "levels": (Wave(values=(3.0,)), Wave(values=(1.0,))), "forces": (Wave(),), "start": (0.0,),
    }  # fmt: skip
    return Random(**(parts | changes))  # type: ignore[arg-type]


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_two_ports_on_one_ruled_combination_do_not_stick_at_once(backend: str) -> None:
    """Levels 3 and 1 at shafts of 1.9 and 1.5: it accelerates by 4, by 2 past the slower, then one holds."""
    line = _line()
    run = simulator(bg.derive(line.graph()), {}, backend=backend)
    result = run.run(np.linspace(0, 1, 11), inputs=line.inputs())
    assert _told(result) == [(0.375, "rub1", "cross"), (0.575, "rub0", "stick")]
    assert result["v0"][-1] == pytest.approx(1.9, abs=1e-12)
    assert (result["f0"][-1], result["f1"][-1]) == pytest.approx((-1.0, 1.0), abs=1e-9)


def test_a_sweep_in_c_does_such_runs_in_one_call() -> None:
    """It passes the slower shaft after 1.5/(L0 + 1), and comes to the faster 0.4/(L0 - 1) later."""
    line, levels = _line(), np.array([3.0, 5.0])
    family = codegen.Family(bg.derive(line.graph()), {"L0": 1.0, "L1": 1.0}, backend="c")
    inputs = {name: signal for name, signal in line.inputs().items() if name[0] != "L"}
    measures = {
        "cross": codegen.first_event("rub1", "cross"), "stick": codegen.first_event("rub0", "stick"),
        "speed": codegen.final("v0"),
    }  # fmt: skip
    times = np.linspace(0, 1, 11)
    loop = batch_of(Job(family, ("L0",), times, measures, {}, inputs))
    assert loop is not None
    loop([(level,) for level in levels.tolist()])
    assert loop.statuses == {0: 2}
    found = codegen.sweep(
        family, {"L0": levels}, times, measures, inputs=inputs, workers=0, progress=False
    )
    assert found["cross"] == pytest.approx(1.5 / (levels + 1), abs=1e-9)
    assert found["stick"] == pytest.approx(1.5 / (levels + 1) + 0.4 / (levels - 1), abs=1e-9)
    assert found["speed"] == pytest.approx([1.9, 1.9], abs=1e-12)


def _beside() -> nx.DiGraph:
    """Two clutches from shafts turned by sources to a hub that a damper of 2 ties to a mass."""
    nodes = [
        bg.Sf("m0", "w0"), bg.Sf("m1", "w1"), bg.One("a"), bg.One("b"), bg.Zero("z0"), bg.Zero("z1"),
        bg.One("hub"), bg.R("c0", effort="f0", flow="s0"), bg.R("c1", effort="f1", flow="s1"),
        bg.Zero("arm"), bg.R("damper", 2), bg.One("n"), bg.I("m", 1, flow="v"),
    ]  # fmt: skip
    return bond_graph(nodes, "m0>a>z0>hub z0>c0 m1>b>z1>hub z1>c1 hub>arm>n>m arm>damper")


BESIDE = {"c0": bg.DryFriction(3), "c1": bg.DryFriction(5)}


@pytest.mark.parametrize("route", ["numpy", "c", "python"])
def test_two_ports_beside_a_damper_do_not_stick_at_once(route: str) -> None:
    """The hub keeps to the faster clutch: f1 = 0.5 of slip against c0's 3, so c1 holds 2 (w1 - v) - 3."""
    equations, inputs = bg.derive(_beside()), {"w0": 1.9, "w1": 1.5}
    times = np.linspace(0, 0.4, 5)
    if route == "python":
        exported = loaded(codegen.to_python(equations, {}, BESIDE))
        found = exported.simulate(times, {}, inputs, step=0.01)
    else:
        found = simulator(equations, {}, BESIDE, route).run(times, inputs=inputs)
    # Against c1 at rest: 2 (1.5 - v) = 3 + f1, v' = 2 (1.5 - v).
    v = 1.5 * (1 - np.exp(-2 * times))
    assert found["v"] == pytest.approx(v, abs=1e-6)
    assert found["f0"] == pytest.approx(np.full(5, 3.0))
    assert found["f1"] == pytest.approx(2 * (1.5 - v) - 3, abs=1e-5)


def _in_series() -> tuple[bg.StateEquations, dict[str, object]]:
    """A clutch in series with a damper whose flow is the square of its effort, on a mass of 2."""
    nodes = [
        bg.Se("push", "P"), bg.One("n"), bg.I("m", 2, flow="v"), bg.Zero("z"),
        bg.R("rub", effort="f", flow="s"), bg.R("d", effort="e", flow="q", gives="flow"),
    ]  # fmt: skip
    laws = {"rub": bg.DryFriction(3), "d": "e*Abs(e)/4"}
    return bg.derive(bond_graph(nodes, "push>n>m n>z z>d z>rub")), laws


def test_what_a_law_in_series_lets_hold_does_hold() -> None:
    """The damper takes the whole speed while it needs less than 3: 2 sqrt(v). Above v = 9/4 it slips."""
    equations, laws = _in_series()
    ready = simulator(equations, {}, laws)
    for v in (0.01, 1.0, -2.0):
        assert ready.rhs(0.0, [v], [0.0]) == pytest.approx(
            [-np.sign(v) * np.sqrt(abs(v))], rel=1e-7
        )
    assert ready.rhs(0.0, [2.5], [0.0]) == pytest.approx([-1.5], rel=1e-12)
    exported = loaded(codegen.to_python(equations, {}, laws)).Model()
    for v in (1.0, -2.0, 2.5):
        assert exported.rhs(0.0, [v], [0.0]) == pytest.approx(ready.rhs(0.0, [v], [0.0]), rel=1e-6)


def test_a_law_in_series_holds_in_c_as_well() -> None:
    """2 v' = -2 sqrt(v) from 1: sqrt(v) = 1 - t/2."""
    equations, laws = _in_series()
    times = np.linspace(0, 0.5, 3)
    result = simulator(equations, {}, laws, "c").run(times, {"v": 1.0}, {"P": 0.0}, method="DOP853")
    assert result.backend == "c"
    assert np.sqrt(result["v"]) == pytest.approx(1 - times / 2, abs=1e-8)
    assert result["s"] == pytest.approx(np.zeros(3), abs=1e-8)


def _gear() -> tuple[bg.StateEquations, dict[str, object]]:
    """A self-locking gear: what it loses is five times what its mesh carries."""
    nodes = [
        bg.Se("d", "tau_d"), bg.One("a"), bg.I("J1", 1, flow="w"), bg.R("loss", effort="tau_f", flow="s"),
        bg.Zero("mesh", effort="tau_m"), bg.TF("G", "1/2"), bg.One("b"),
        bg.I("J2", "3/2", priority=-1), bg.Se("l", "tau_L"),
    ]  # fmt: skip
    laws = {"loss": bg.DryFriction("5*Abs(tau_m)")}
    return bg.derive(bond_graph(nodes, "d>a>J1 a>loss a>mesh>G>b>J2 l>b")), laws


@pytest.mark.parametrize("sign", [1, -1])
def test_a_self_locking_gear_holds_both_ways(sign: int) -> None:
    """At rest the mesh carries 5 of the load and could hold 25; holding needs 1 - 5 = -4. Slipping
    one way its law has no solution, and that is no mode."""
    equations, laws = _gear()
    inputs = {"tau_d": 1.0 * sign, "tau_L": -10.0 * sign}
    ready = simulator(equations, {}, laws, "c")
    assert ready.rhs(0.0, [0.0], [inputs[name] for name in ready.inputs]) == pytest.approx([0.0])
    result = ready.run([0, 0.01], inputs=inputs, method="DOP853")
    assert result.backend == "c"
    assert result["w"].tolist() == [0, 0]
    assert result["tau_f"] == pytest.approx([-4.0 * sign] * 2)
    assert codegen.trim(ready, inputs)["tau_f"] == pytest.approx(-4.0 * sign)
    exported = loaded(codegen.to_python(equations, {}, laws))
    found = exported.simulate([0, 0.01], {}, inputs, step=1e-3)
    assert found["w"].tolist() == [0, 0]
    assert found["tau_f"] == pytest.approx([-4.0 * sign] * 2)


def test_where_no_mode_can_be_evaluated_the_reason_is_told() -> None:
    laws = {"brake": bg.DryFriction("L")}
    run = simulator(bg.derive(_brake()), {}, laws)
    with pytest.raises(bg.SimulationError, match="'brake' has level -3"):
        run.run(SECOND, inputs={"w": 1.0, "L": -3.0})


TIMES = np.linspace(0.0, SPAN, 21)


def _complaints(seed: int, backend: str) -> list[str]:
    line = random_driveline(np.random.default_rng(seed))
    start = {f"v{i}": speed for i, speed in enumerate(line.start)}
    run = simulator(bg.derive(line.graph()), {}, backend=backend)
    return complaints(line, TIMES, run.run(TIMES, start, line.inputs()))


@pytest.mark.parametrize("seed", seeds("ruled-friction"))
def test_random_drivelines_move_as_the_judge_finds(seed: int) -> None:
    assert _complaints(seed, "numpy") == []


def test_leaps_see_what_inputs_rule_where_storages_hang_on_one_another_one_way() -> None:
    """A slip that a sine alone rules, beside a stuck port: what balances rates puts them far apart."""
    assert _complaints(1471, "c") == []


@pytest.mark.parametrize("seed", seeds("ruled-friction-in-c"))
def test_random_drivelines_move_as_the_judge_finds_in_c(seed: int) -> None:
    assert _complaints(seed, "c") == []
