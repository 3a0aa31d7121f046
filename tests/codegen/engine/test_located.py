"""Event-located runs in C: against exact runs, closed forms, the loop in Python, and one method another."""

import subprocess
from pathlib import Path

import networkx as nx
import numpy as np
import pytest
from oracles.alone import located
from oracles.c_model import WARNED, check_told, compiled, written
from oracles.chains import random_chain
from oracles.exported import small_cases
from oracles.models import oscillator
from references.build import bond_graph

import bondgraph as bg
import differentials
from codegen import (
    Family,
    Lag,
    Ramp,
    Result,
    Sampled,
    Signal,
    Simulator,
    Sine,
    Step,
    simulator,
    to_c,
)
from codegen.engine.located import LocatedLibrary, LocatedRuns
from codegen.inputs.tables import signal_table
from codegen.runs.arguments import initial_values, signals_for
from codegen.runs.track import Settings
from codegen.taking.blocks import Whole
from differentials.laws import magic_formula_tire, stribeck_clutch
from differentials.scenarios import prepared

CASES = [
    ("passive_halfshafts", "engine_step"), ("passive_input_clutch", "input_clutch"), ("alsd", "fig11"),
    ("alsd", "fig12_20_2"), ("superposition_tvd", "fig13_superposition"), ("stationary_tvd", "fig13"),
    ("four_wheel_drive_tvd", "fig14"),
]  # fmt: skip


def _located(ready: Simulator, times, initial=None, inputs=None, method="DOP853") -> Whole:
    """A run by generated C and nothing else."""
    signals = signals_for(inputs or {}, ready.inputs)
    states = initial_values(initial or {}, ready.states)
    runs = ready.located or LocatedRuns(ready.closed)
    told = Settings(method, 1e-10, 1e-11)
    found = located(runs, np.asarray(times, dtype=float), states, signals, told)
    assert isinstance(found, Whole)
    return found


def _agree(found: Whole, run: Result, near: float, late: float = 1e-6) -> None:
    assert [(e.port, e.kind) for e in found.events] == [(e.port, e.kind) for e in run.events]
    assert [e.time for e in found.events] == pytest.approx([e.time for e in run.events], abs=late)
    for column, name in zip(found.shots.x.T, run.states, strict=False):
        size = max(np.ptp(run[name]), 1e-3 * np.abs(run[name]).max(), 1e-6)
        assert np.abs(column - run[name]).max() <= near * size, name


@pytest.mark.usefixtures("closely")
@pytest.mark.parametrize(("name", "scenario"), CASES)
def test_the_catalogs_figures_against_exact_steps(name: str, scenario: str) -> None:
    case = prepared(name, scenario)
    ready = simulator(case.equations, case.parameters, case.laws)
    exact = ready.run(case.times, case.initial, case.inputs, method="exact")
    fast = simulator(case.equations, case.parameters, case.laws, "c")
    for method in ("DOP853", "Radau"):
        run = fast.run(case.times, case.initial, case.inputs, method=method)
        assert (run.backend, exact.backend) == ("c", "numpy")
        assert [(e.kind, e.port) for e in run.events] == [(e.kind, e.port) for e in exact.events]
        late = [a.time - b.time for a, b in zip(run.events, exact.events, strict=True)]
        assert np.abs(late).max(initial=0.0) < 1e-9
        for signal in exact:
            size = max(np.ptp(exact[signal]), 1e-6)
            assert np.abs(run[signal] - exact[signal]).max() < 1e-6 * size, (method, signal)


@pytest.mark.usefixtures("closely")
@pytest.mark.parametrize(
    "laws",
    [
        {"clutch": stribeck_clutch("tau_h", 1.3, 2.0)},
        {"tire_1": magic_formula_tire(1), "tire_2": magic_formula_tire(2)},
    ],
    ids=["stribeck", "magic_formula"],
)
def test_nonlinear_differentials_against_the_loop_in_python(laws: dict) -> None:
    case = prepared("alsd", "fig11", laws=laws)
    times = case.times[400:650]
    arguments = (case.equations, case.parameters, case.laws)
    fast = simulator(*arguments, "c")
    assert fast.engine is None
    tight = {"rtol": 1e-11, "atol": 1e-12}
    slow = simulator(*arguments).run(times, case.initial, case.inputs, **tight)
    _agree(_located(fast, times, case.initial, case.inputs), slow, 1e-8, 1e-9)
    run = fast.run(times, case.initial, case.inputs, **tight)
    for name in slow:
        assert np.abs(run[name] - slow[name]).max() <= 1e-8 * np.abs(slow[name]).max() + 1e-12


def test_play_in_the_shafts() -> None:
    short = differentials.Scenario(80.0, -2.0, 350.0, (1000.0,), 0.01, 0.05, 0.1)
    slow, fast = (
        differentials.simulate("alsd", short, backend=backend, backlash=True)
        for backend in ("numpy", "c")
    )
    for name in slow:
        assert np.abs(fast[name] - slow[name]).max() <= 1e-6 * np.abs(slow[name]).max() + 1e-12


SMALL = dict(small_cases())


@pytest.mark.parametrize("name", SMALL)
def test_two_methods_agree_on_models_of_every_kind(name: str) -> None:
    equations, numbers, laws = SMALL[name]
    ready = simulator(equations, numbers, laws)
    rng = np.random.default_rng(7)
    initial = {state: float(rng.uniform(-1, 1)) for state in ready.states}
    inputs = {one: Sine(float(rng.uniform(1, 6)), 1.3, offset=0.3) for one in ready.inputs}
    runs = LocatedRuns(ready.closed)
    signals, states = signals_for(inputs, ready.inputs), initial_values(initial, ready.states)
    times = np.linspace(0, 2, 101)
    one, two = (
        located(runs, times, states, signals, Settings(m, 1e-10, 1e-11))
        for m in ("DOP853", "Radau")
    )
    assert isinstance(one, Whole)
    assert isinstance(two, Whole)
    assert [(e.port, e.kind) for e in one.events] == [(e.port, e.kind) for e in two.events]
    late = [a.time - b.time for a, b in zip(one.events, two.events, strict=True)]
    assert np.abs(late).max(initial=0.0) < 1e-8
    for part in ("x", "z", "u", "y", "rate"):
        a, b = getattr(one.shots, part), getattr(two.shots, part)
        assert np.abs(a - b).max(initial=0.0) <= 2e-7 * max(np.abs(a).max(initial=0.0), 1e-3), part


def _braked(law: str) -> bg.StateEquations:
    nodes = [bg.Se("push", 0), bg.One("body"), bg.I("m", "m", flow="v"), bg.R("drag", law=law)]
    return bg.derive(bond_graph(nodes, "push>body>m body>drag"))


@pytest.mark.parametrize("c", [0.5, 3e7])
@pytest.mark.parametrize("method", ["auto", "DOP853", "Radau"])
def test_a_cubic_brake_has_a_closed_form(c: float, method: str) -> None:
    """m v' = -c v^3: v = v_0/sqrt(1 + 2 c v_0^2 t/m); for a large c the implicit method is chosen."""
    if c > 1 and method == "DOP853":
        pytest.skip("explicit steps would need as many as the time constants there are")
    fast = simulator(_braked("c*v**3"), {"m": 2.0, "c": c}, backend="c")
    times = np.linspace(0, 3, 31)
    found = _located(fast, times, {"v": 4.0}, {}, method)
    expected = 4.0 / np.sqrt(1 + 2 * c * 16.0 * times / 2.0)
    assert found.shots.x[:, 0] == pytest.approx(expected, rel=2e-8)


def test_a_pendulum_keeps_its_energy_and_its_period() -> None:
    """theta'' = -(g/l) sin(theta); the period is 4 sqrt(l/g) K(sin(theta_0/2)) (Abramowitz, Stegun 17.3)."""
    from scipy.special import ellipk

    nodes = [bg.One("turn"), bg.I("J", "m*l**2", flow="omega"), bg.Df("angle", integrate="theta"),
             bg.R("weight", law="m*g*l*sin(theta)")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "turn>J turn>angle turn>weight"))
    numbers = {"m": 0.7, "l": 0.4, "g": 9.81}
    period = 4 * np.sqrt(0.4 / 9.81) * ellipk(np.sin(0.6) ** 2)
    fast = simulator(equations, numbers, backend="c")
    run = fast.run(np.linspace(0, 3 * period, 61), {"theta": 1.2})
    energy = 0.5 * 0.4 * run["omega"] ** 2 - 9.81 * np.cos(run["theta"])
    assert np.ptp(energy) < 1e-8 * 9.81
    assert run["theta"][-1] == pytest.approx(1.2, abs=1e-8)
    assert run["omega"][-1] == pytest.approx(0.0, abs=1e-7)


@pytest.mark.parametrize("seed", range(3))
def test_random_chains_with_random_inputs(seed: int) -> None:
    rng = np.random.default_rng(100 + seed)
    chain = random_chain(np.random.default_rng(seed))
    inputs: dict[str, object] = {f"P{i}": push for i, push in enumerate(chain.pushes)}
    inputs |= {f"L{i}": level for i, level in enumerate(chain.levels)}
    knots = np.sort(rng.uniform(0, 2, 5))
    inputs["P0"] = Lag(Sampled(knots, rng.normal(0, 3, 5)), 0.1) + Sine(2.0, 1.3, offset=0.5)
    times = np.sort(np.concatenate([[0.0, 2.0], rng.uniform(0, 2, 60)]))
    start = {f"v{i}": v for i, v in enumerate(chain.start.tolist())}
    ready = simulator(bg.derive(chain.graph()), {})
    _agree(_located(ready, times, start, inputs), ready.run(times, start, inputs), 1e-7, 1e-8)


def test_ports_that_share_a_load_run_in_c() -> None:
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"),
             *(bg.R(f"r{i}", law=bg.DryFriction(f"{i}*L"), effort=f"f_{i}") for i in (1, 2))]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "push>n>m n>r1 n>r2"))
    fast = simulator(equations, {"m": 1.0, "L": 1.0}, backend="c")
    found = _located(fast, [0, 1], None, {"P": 1.5})
    names = [name.name for name in fast.closed.program.inputs]
    shares = found.shots.u[-1, [names.index("f_1"), names.index("f_2")]]
    assert shares == pytest.approx((0.5, 1.0))


def test_room_for_events_grows() -> None:
    ready = simulator(bg.derive(oscillator()), {"m": 1.0, "k": 1e4, "F_c": 0.01})
    found = _located(ready, np.linspace(0, 12, 101), {"v": 30.0})
    assert len(found.events) > 300


def test_a_level_below_zero_is_refused_with_its_time() -> None:
    cubic = {"ground": bg.DryFriction("L", "1 + slip**2")}
    fast = simulator(bg.derive(oscillator()), {"m": 1.0, "k": 1.0}, cubic, backend="c")
    with pytest.raises(bg.SimulationError, match=r"the friction at 'ground' has level -"):
        fast.run(np.linspace(0, 1, 11), {"v": 9.0}, {"L": Ramp(0.0, -10.0, 5.0)})


def test_models_that_differ_in_numbers_share_one_library() -> None:
    one, two = (
        simulator(bg.derive(oscillator()), {"m": m, "k": 20.0, "F_c": 1.0}, backend="c")
        for m in (1.0, 2.0)
    )
    assert one.located is not None
    assert two.located is not None
    assert one.located.library.sources == two.located.library.sources
    times = np.linspace(0, 1, 11)
    runs = [one_.run(times, {"v": 2.0}, method="DOP853")["v"] for one_ in (one, two)]
    assert np.abs(runs[0] - runs[1]).max() > 0.1


def test_the_simulators_of_a_family_share_one_library() -> None:
    cubic = {"ground": "c*slip**3"}
    family = Family(bg.derive(oscillator()), {"m": 1.0, "k": 20.0, "c": 0.3}, cubic, backend="c")
    one, two = family.simulator(), family.simulator(c=0.6)
    assert one.located.library is two.located.library
    times = np.linspace(0, 1, 11)
    slow = Family(family.equations, family.parameters, cubic).simulator(c=0.6)
    expected = slow.run(times, {"v": 2.0})["v"]
    assert two.run(times, {"v": 2.0})["v"] == pytest.approx(expected, abs=1e-8)


def test_tables_give_the_signals_values_back() -> None:
    signals: list[Signal] = [
        Lag(Step(0.2, 1.5), 0.05) + Sine(0.4, 1.7, offset=0.3), Ramp(0.9, -2.0, end=1.8), Step(1.0, 2.0),
    ]  # fmt: skip
    table = signal_table(signals, 0.0, 3.0)
    for t in np.linspace(0.01, 2.99, 57).tolist():
        at = sum(b <= t for b in table.breaks)
        values = np.zeros(3)
        for which, first, count, start, rate in table.terms[
            table.begins[at] : table.begins[at + 1]
        ]:
            powers = (t - start) ** np.arange(count)
            part = np.dot(table.coefficients[first : first + count], powers)
            values[which] += (part * np.exp(rate * (t - start))).real
        assert values == pytest.approx([signal(t) for signal in signals], abs=1e-12)


def _rows(program: Path, *words: str) -> tuple[np.ndarray, list[str], str]:
    done = subprocess.run([program, *words], capture_output=True, text=True, check=True)
    head, *rows = done.stdout.splitlines()
    return np.array([row.split(",") for row in rows], dtype=float), head.split(","), done.stderr


def test_the_main_program_runs_a_scenario_with_events_located(tmp_path: Path) -> None:
    case = prepared("alsd", "fig11")
    arguments = (case.equations, case.parameters, case.laws)
    files = to_c(*arguments, name="alsd", main=True, initial=case.initial, inputs=case.inputs)
    program = compiled(tmp_path, written(tmp_path, files), "-O0")
    table, names, told = _rows(program, "1", "0.001", "located")
    run = simulator(*arguments).run(case.times, case.initial, case.inputs)
    events = [line.split(",") for line in told.splitlines()]
    assert [(port, kind) for _, port, kind, _ in events] == [(e.port, e.kind) for e in run.events]
    assert [float(time) for time, *_ in events] == pytest.approx(
        [e.time for e in run.events], abs=1e-9
    )
    assert table[:, 0] == pytest.approx(run.time, abs=1e-15)
    for at, name in enumerate(names[1:], 1):
        assert np.abs(table[:, at] - run[name]).max() < 1e-6 * np.ptp(run[name]), name
    errors = []
    for step in ("1e-3", "1e-4"):
        table, _, _ = _rows(program, "0.4", "0.001", f"step={step}")
        errors.append(np.abs(table[:, 1] - run["omega_1"][:401]).max())
    assert errors[1] < 1e-3 * errors[0]
    # A third of a millisecond: breakpoints are reached a rounding before or after their time.
    table, _, _ = _rows(program, "0.6", "0.001", "step=3.3e-4")
    assert len(table) == 601
    table, _, _ = _rows(program, "0.4", "0.1", "tau_e=0", "located")
    assert table[:, 1] == pytest.approx(80.0, abs=1e-2)


LEVELS = {"clutches_with_loss": "-O3", "diode": "-O1", "crank": "-O1"}


@pytest.mark.parametrize("name", ["duffing", "diode", "stacked", "crank", "clutches_with_loss"])
def test_located_runs_compile_without_warnings(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Models without friction ports, without states, with several ports, with moving ratios."""
    equations, numbers, laws = SMALL[name]
    ready = simulator(equations, numbers, laws)
    if name not in LEVELS:
        check_told(tmp_path, LocatedLibrary(ready.closed).sources)
        return
    monkeypatch.setenv("CFLAGS", LEVELS[name])
    runs = LocatedRuns(ready.closed, LocatedLibrary(ready.closed, WARNED))
    states = np.zeros(len(ready.states))
    signals = signals_for(dict.fromkeys(ready.inputs, 1.0), ready.inputs)
    settings = Settings("auto", 1e-10, 1e-11)
    assert isinstance(located(runs, np.array([0.0, 0.1]), states, signals, settings), Whole)


@pytest.mark.usefixtures("closely")
def test_chains_of_two_hundred_states_run() -> None:
    """Waves in a chain of masses and springs that nothing damps: the energy stays."""
    nodes: list = [bg.One("n0"), bg.I("m0", "m", flow="v0")]
    bonds = ["n0>m0"]
    for k in range(1, 100):
        nodes += [bg.Zero(f"z{k}"), bg.C(f"c{k}", "c", effort=f"f{k}"), bg.One(f"n{k}"),
                  bg.I(f"m{k}", "m", flow=f"v{k}")]  # fmt: skip
        bonds += [f"n{k - 1}>z{k}>n{k}>m{k}", f"z{k}>c{k}"]
    nodes += [bg.Zero("end"), bg.C("c_end", "c", effort="f_end")]
    bonds += ["n99>end>c_end"]
    graph: nx.DiGraph = bond_graph(nodes, " ".join(bonds))
    ready = simulator(bg.derive(graph), {"m": 0.1, "c": 1e-3}, backend="c")
    assert len(ready.states) == 200
    run = ready.run(np.linspace(0, 0.2, 21), {"v0": 3.0}, method="DOP853")
    names = ready.states
    energy = sum((0.1 if n.startswith("v") else 1e-3) * run[n] ** 2 / 2 for n in names)
    assert np.ptp(energy) < 1e-8 * energy[0]
    assert abs(run["v1"]).max() > 0.5
