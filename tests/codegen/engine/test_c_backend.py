"""The C engine against the numpy loop: samples, events, statuses."""

from pathlib import Path

import numpy as np
import pytest
from oracles.alone import exact
from oracles.c_model import WARNED, check_told
from oracles.chains import random_chain
from oracles.models import belt, block, oscillator, stacked_blocks
from references.build import bond_graph

import bondgraph as bg
import differentials
from codegen import (
    BackendWarning,
    Constant,
    Family,
    Lag,
    Ramp,
    Result,
    Sampled,
    Simulator,
    Sine,
    Step,
    event_count,
    simulator,
    sweep,
)
from codegen.engine.runs import CRuns, Outcome, Status, not_affine
from codegen.engine.sizes import Sizes, engine, sources
from codegen.runs.arguments import initial_values, signals_for
from codegen.runs.track import Event
from differentials.scenarios import scenarios

CASES = [
    ("passive", "engine_step"), ("passive_input_clutch", "input_clutch"),
    ("passive_input_shaft", "engine_step"), ("passive_halfshafts", "engine_step"),
    *(("alsd", name) for name in scenarios if name.startswith(("fig11", "fig12"))),
    ("superposition_tvd", "fig13_superposition"), ("stationary_tvd", "fig13"),
    ("four_wheel_drive_tvd", "fig14"),
]  # fmt: skip


def _outcome(ready: Simulator, times, initial=None, inputs=None) -> tuple[Outcome, list[Event]]:
    """A run by the engine alone: how it ended, and its events."""
    times = np.asarray(times, dtype=float)
    signals = signals_for(inputs or {}, ready.inputs)
    given = np.array([signal(times[0]) for signal in signals])
    start = ready.vector(times[0], initial_values(initial or {}, ready.states), given)
    return exact(CRuns(ready.closed), times, start, signals)


def _agree(one: Result, two: Result, near: float = 1e-9) -> None:
    assert [(e.port, e.kind) for e in one.events] == [(e.port, e.kind) for e in two.events]
    assert [e.time for e in one.events] == pytest.approx([e.time for e in two.events], abs=1e-9)
    for name in one.columns:
        size = max(np.ptp(two[name]), 1e-3 * np.abs(two[name]).max(), 1e-4)
        assert np.abs(one[name] - two[name]).max() <= near * size, name


def _both(equations, numbers, times, initial=None, inputs=None, near=1e-9, laws=None) -> Result:
    ready = simulator(equations, numbers, laws)
    assert _outcome(ready, times, initial, inputs)[0].status == Status.OK
    fast = simulator(equations, numbers, laws, "c").run(times, initial, inputs)
    _agree(fast, ready.run(times, initial, inputs, method="exact"), near)
    return fast


@pytest.mark.parametrize(("name", "scenario"), CASES)
def test_the_catalogs_figures(name: str, scenario: str) -> None:
    fast = differentials.simulate(name, scenario, backend="c")
    _agree(fast, differentials.simulate(name, scenario))


def test_an_oscillator_on_a_belt_through_all_kinds_of_inputs() -> None:
    inputs = {
        "V_b": Lag(Step(0.2, 1.5), 0.05) + Sine(0.4, 1.7, offset=0.3) + Ramp(0.9, -2.0, end=1.8),
    }
    fast = _both(
        bg.derive(belt(bg.C("spring", "1/k", effort="F"))), {"m": 1.0, "k": 40.0, "F_c": 2.0},
        np.linspace(0, 4, 1601), {"v": 0.2}, inputs,
    )  # fmt: skip
    assert {event.kind for event in fast.events} >= {"stick", "slip"}


def test_two_masses_that_swing_against_each_other_lock_in_one_instant() -> None:
    nodes = [bg.One("n1"), bg.One("n2"), bg.Zero("z"), bg.C("k", "1/k", effort="F"),
             bg.I("m1", "m", flow="v_1"), bg.I("m2", "m", flow="v_2"),
             bg.R("rub1", law=bg.DryFriction("L"), effort="f_1", flow="s_1"),
             bg.R("rub2", law=bg.DryFriction("L"), effort="f_2", flow="s_2")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "n1>m1 n1>rub1 n2>m2 n2>rub2 n1>z>n2 z>k"))
    numbers = {"m": 2.0, "k": 50.0, "L": 3.0}
    fast = _both(equations, numbers, np.linspace(0, 4, 81), {"F": 17.3 * 3.0}, near=1e-7)
    assert [e.kind for e in fast.events] == ["cross"] * 16 + ["stick"] * 2
    _both(equations, numbers, np.linspace(0, 2, 161), {"v_1": 1.2, "v_2": 1.2})


PUSHES = [(0.0, 2.0, 0.5), (1.0, 4.5, 0.6), (2.0, 8.0, -2.0), (3.0, 1.0, 2.5), (4.0, -9.0, 0.0),
          (5.0, 0.5, 0.1), (6.5, -4.4, -0.7), (7.5, 0.0, -1.7), (8.5, 3.9, 1.3), (9.5, 0.0, 0.0)]  # fmt: skip


@pytest.mark.parametrize("samples", [641, 17])
def test_blocks_on_top_of_each_other(samples: int) -> None:
    total = [Constant(0.0), Constant(0.0)]
    before = (0.0, 0.0)
    for time, *values in PUSHES:
        for i in range(2):
            total[i] = total[i] + Step(time, values[i] - before[i])
        before = tuple(values)
    numbers = {"m_1": 2.0, "m_2": 1.0, "L_1": 3.0, "L_2": 1.0}
    laws = {"ground": bg.DryFriction("L_1", 1, 1.2), "contact": bg.DryFriction("L_2", 1, 1.5)}
    inputs = {"P_1": total[0], "P_2": total[1] + Sine(0.3, 1.1)}
    times, equations = np.linspace(0, 12, samples), bg.derive(stacked_blocks())
    fast = _both(equations, numbers, times, None, inputs, laws=laws)
    assert len(fast.events) > 10


@pytest.mark.parametrize("seed", range(4))
def test_random_chains_with_random_inputs_at_ragged_times(seed: int) -> None:
    rng = np.random.default_rng(100 + seed)
    chain = random_chain(np.random.default_rng(seed))
    inputs: dict[str, object] = {f"P{i}": push for i, push in enumerate(chain.pushes)}
    inputs |= {f"L{i}": level for i, level in enumerate(chain.levels)}
    knots = np.sort(rng.uniform(0, 2, 5))
    inputs["P0"] = Lag(Sampled(knots, rng.normal(0, 3, 5)), 0.1) + Sine(2.0, 1.3, offset=0.5)
    times = np.sort(np.concatenate([[0.0, 2.0], rng.uniform(0, 2, 60), 1.1 + np.arange(4) * 1e-13]))
    start = {f"v{i}": v for i, v in enumerate(chain.start.tolist())}
    _both(bg.derive(chain.graph()), {}, times, start, inputs, near=1e-7)


def test_steps_much_longer_than_time_constants_are_divided() -> None:
    """A tire's pole at 937 1/s, sampled every 50 ms."""
    nodes = [bg.Se("push", "P"), bg.One("body"), bg.I("m", "m", flow="v"), bg.R("drag", "b"),
             bg.R("ground", law=bg.DryFriction("L"), effort="f", flow="s")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "push>body>m body>drag body>ground"))
    # The level is an input: the engine has the sizes of the block's below.
    inputs = {"P": Sine(30.0, 2.0), "L": 5.0}
    fast = _both(equations, {"m": 1.0, "b": 900.0}, np.linspace(0, 3, 61), None, inputs)
    assert len(fast.events) == 24


def test_models_without_friction_run() -> None:
    nodes = [bg.Se("push", "P"), bg.One("body"), bg.I("m", "m", flow="v"), bg.R("drag", "b")]
    equations = bg.derive(bond_graph(nodes, "push>body>m body>drag"))
    _both(equations, {"m": 1.0, "b": 2.0}, np.linspace(0, 3, 61), {"v": 1.0}, {"P": Ramp(1.0, 2.0)})


BLOCK = bg.derive(block(bg.DryFriction("L")))


def test_a_level_below_zero_has_its_status_and_its_time() -> None:
    inputs = {"P": 0.0, "L": Ramp(0.0, -10.0, 5.0)}
    times = np.linspace(0, 1, 11)
    outcome, _ = _outcome(simulator(BLOCK, {"m": 1.0}), times, {"v": 9.0}, inputs)
    assert outcome.status == Status.NEGATIVE
    assert outcome.time == pytest.approx(0.6)
    with pytest.raises(bg.SimulationError, match=r"at t = 0\.6 the friction at 'ground' has level"):
        simulator(BLOCK, {"m": 1.0}, backend="c").run(times, {"v": 9.0}, inputs)


def test_redundant_ports_are_left_to_located_runs() -> None:
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"),
             *(bg.R(f"r{i}", law=bg.DryFriction(f"{i}*L"), effort=f"f_{i}") for i in (1, 2))]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "push>n>m n>r1 n>r2"))
    ready = simulator(equations, {"m": 1.0, "L": 1.0})
    assert _outcome(ready, [0, 1], None, {"P": 1.0})[0].status == Status.NOT_AFFINE
    shared = simulator(equations, {"m": 1.0, "L": 1.0}, backend="c").run([0, 1], None, {"P": 1.5})
    assert shared.backend == "c"
    assert (shared["f_1"][-1], shared["f_2"][-1]) == pytest.approx((0.5, 1.0))


def test_too_many_steps_have_a_status() -> None:
    """2 pi 1e15 turns to follow have no end; what a stiff damper joins has soon decayed."""
    ready = simulator(bg.derive(oscillator()), {"m": 1e-16, "k": 4e14, "F_c": 1.0})
    assert _outcome(ready, [0, 1], {"v": 1.0})[0].status == Status.ENDLESS
    damped = bg.derive(oscillator(bg.R("damper", "b")))
    ready = simulator(damped, {"m": 1.0, "k": 1.0, "F_c": 0.01, "b": 1e9})
    assert _outcome(ready, [0, 1], {"v": 1.0})[0].status == Status.STIFF


def test_a_run_without_end_is_refused_with_its_steps() -> None:
    fast = simulator(bg.derive(oscillator()), {"m": 1e-16, "k": 4e14, "F_c": 1.0}, backend="c")
    with pytest.raises(bg.SimulationError, match=r"to look for events until 1 s takes \S+ steps"):
        fast.run([0, 1], {"v": 1.0})


def test_many_events_of_a_long_run() -> None:
    """A block pushed to and fro at 100 Hz: two events in every period, for 100 s."""
    ready = simulator(bg.derive(block()), {"m": 1.0, "F_c": 1.0})
    _, events = _outcome(ready, [0.0, 100.0], None, {"P": Sine(2.0, 100.0)})
    assert len(events) == 20_000
    at = np.array([event.time for event in events])
    period = np.diff(at[::2])
    assert period[100:] == pytest.approx(0.01, abs=1e-9)


@pytest.mark.parametrize("method", ["exact", "DOP853", "Radau"])
def test_an_event_at_the_last_instant_is_one(method: str) -> None:
    """v = 1 - t/2 comes to rest at 2 s, where the run ends; a force grows to the breakaway at 1 s."""
    numbers, counts = {"m": 1.0, "F_c": 1.0}, [event_count("ground", k) for k in ("stick", "slip")]
    family = Family(bg.derive(block()), numbers, None, "c")
    for end, start, push, kind in (
        (2.0, {"v": 1.0}, Constant(0.5), "stick"),
        (1.0, {}, Ramp(0.0, 1.0), "slip"),
    ):
        times = np.linspace(0, end, 21)
        run = family.simulator().run(times, start, {"P": push}, method=method)
        assert run.backend == "c"
        assert [(e.kind, round(e.time, 9)) for e in run.events] == [(kind, end)]
        swept = sweep(
            family, {"m": [1.0]}, times, dict(zip(("stick", "slip"), counts, strict=True)), start,
            {"P": push}, method=method, workers=0, progress=False,
        )  # fmt: skip
        assert (swept[kind][0], swept["stick"][0] + swept["slip"][0]) == (1, 1)


def test_room_for_events_grows() -> None:
    ready = simulator(bg.derive(oscillator()), {"m": 1.0, "k": 1e4, "F_c": 0.01})
    _, events = _outcome(ready, np.linspace(0, 20, 101), {"v": 30.0})
    assert len(events) > 500


def test_the_engine_is_for_affine_models_alone() -> None:
    cubic = simulator(bg.derive(oscillator()), {"m": 1, "k": 1}, {"ground": "slip**3"}, backend="c")
    assert cubic.engine is None
    assert not_affine(cubic.closed.program) == "the law at 'ground' is slip**3"
    moving = bg.derive(oscillator(bg.R("d", "3 + t")))
    ready = simulator(moving, {"m": 1, "k": 1, "F_c": 1}, backend="c")
    assert not_affine(ready.closed.program) == "values of this one change in time"
    with pytest.raises(bg.SimulationError, match="exact"):
        cubic.run([0, 1], method="exact")


def test_a_run_tells_what_ran_it() -> None:
    fast = simulator(bg.derive(oscillator()), {"m": 1.0, "k": 1e4, "F_c": 1.0}, backend="c")
    for method in ("exact", "DOP853"):
        assert fast.run([0, 1], {"v": 1.0}, method=method).backend == "c"
    with pytest.warns(BackendWarning, match="C has no method 'CVODE'"):
        assert fast.run([0, 1], {"v": 1.0}, method="CVODE").backend == "numpy"


@pytest.mark.parametrize("K", [0, 1, 3])
def test_the_engine_compiles_without_warnings(
    K: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without ports and with several also beside a model: see the loop over runs."""
    wanted = Sizes(N=3, X=2, U=1, W=1, K=K, G=1)
    check_told(tmp_path, {**sources(), "config.h": wanted.config})
    if K == 1:
        monkeypatch.setenv("CFLAGS", "-O1")
        engine(wanted, WARNED)
