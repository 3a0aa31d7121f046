"""Many event-located runs in one call of C: closed forms, and what each run gives by itself."""

import pickle
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from oracles.exported import small_cases
from oracles.models import oscillator
from references.build import bond_graph

import bondgraph as bg
from codegen import (
    Family,
    Lag,
    Signal,
    Sine,
    Step,
    Swept,
    Table,
    event_count,
    final,
    first_event,
    integral,
    largest,
    peak,
    samples,
    smallest,
    sweep,
)  # fmt: skip
from codegen.batch.exact import ExactLoop
from codegen.batch.located import LocatedLoop
from codegen.c.lanes import lanes
from codegen.inputs.pieces import Piece
from codegen.sweeps.job import Job
from codegen.sweeps.measuring import batch_of
from differentials.laws import magic_formula_tire, stribeck_clutch
from differentials.scenarios import prepared

TIMES = np.linspace(0.0, 3.0, 61)
QUIET = {"progress": False}


def _braked(law: str, backend: str = "c", **numbers: float) -> Family:
    nodes = [bg.Se("push", "P"), bg.One("body"), bg.I("m", "m", flow="v"), bg.R("drag", law=law)]
    return Family(bg.derive(bond_graph(nodes, "push>body>m body>drag")), numbers, backend=backend)


def _same(job: Job, rows: Any, near: float = 1e-12) -> None:
    """The loop does all of these runs itself, and gives what each gives by itself."""
    loop = batch_of(job)
    assert loop is not None
    assert isinstance(loop.loop, LocatedLoop)
    columns, left = loop(rows)
    assert not left
    for at, row in enumerate(rows):
        found = job.run(row)
        assert not isinstance(found, str), found
        for name, column, expected in zip(job.measures, columns, found, strict=True):
            size = max(float(np.abs(np.nan_to_num(expected)).max()), 1e-6)
            assert column[at] == pytest.approx(expected, abs=near * size, nan_ok=True), name


def test_a_cubic_brake_has_a_closed_form() -> None:
    """m v' = -c v^3: v = v_0/s with s = sqrt(1 + 2 c v_0^2 t/m); its integral is (s - 1) m/(c v_0)."""
    family = _braked("c*v**3", m=2.0, c=0.5)
    grid = {"c": [0.1, 0.5, 2.0, 9.0], "v": [1.0, 4.0, -3.0]}
    measures = {"end": final("v"), "all": samples("v"), "most": peak("v"), "way": integral("v")}
    times = np.linspace(0.0, 3.0, 3001)
    found = sweep(family, grid, times, measures, None, {"P": 0.0}, workers=2, **QUIET)
    c, v = found["c"][:, None], found["v"][:, None]
    s = np.sqrt(1 + 2 * c * v**2 * times / 2.0)
    assert found["all"] == pytest.approx(v / s, rel=1e-8)
    assert found["end"] == pytest.approx((v / s)[:, -1], rel=1e-8)
    assert found["most"] == pytest.approx(np.abs(found["v"]))
    assert found["way"] == pytest.approx(((s - 1) * 2.0 / (c * v))[:, -1], rel=1e-8)


CASES = dict(small_cases())


@pytest.mark.parametrize("name", CASES)
def test_models_of_every_kind(name: str) -> None:
    equations, numbers, laws = CASES[name]
    family = Family(equations, numbers, laws, "c")
    program, rng = family.program, np.random.default_rng(5)
    inputs = {one: Sine(float(rng.uniform(1, 6)), 1.3, offset=0.3) for one in family.inputs}
    start = {state: float(rng.uniform(-1, 1)) for state in family.states[1:]}
    signals = [s.name for s in (*program.states, *program.law_states, *program.inputs,
                                *program.asked, *program.readings)]  # fmt: skip
    measures: dict[str, Any] = {f"last {s}": final(s) for s in dict.fromkeys(signals)}
    for port in program.friction:
        measures[f"stick {port.name}"] = first_event(port.name, "stick")
        measures[f"slips {port.name}"] = event_count(port.name, "slip")
    settings: dict[str, Any] = {"method": "DOP853", "rtol": 1e-8, "atol": 1e-10}
    first = next(iter(family.parameters))
    names = (first, *family.states[:1])
    rows = [[family.parameters[first], 0.4][: len(names)], [1.1, -0.7][: len(names)]]
    job = Job(family, names, TIMES, measures, start, inputs, settings)
    if batch_of(job) is None:
        # No state; or the rate of an input is shown, or drives what changes: its steps matter then.
        assert not program.states or program.layout["K"].rows or program.layout["E"].rows
    else:
        # Side by side functions differ in their last place, and with them the steps over a corner.
        _same(job, rows, settings["rtol"] if lanes(program) else 1e-12)


CASE = prepared(
    "alsd", "fig11", laws={"tire_1": magic_formula_tire(1), "tire_2": magic_formula_tire(2)}
)
DIFFERENTIAL = {
    "peak": peak("tau_k1"), "most": largest("omega_1"), "least": smallest("tau_k2"),
    "lock": first_event("clutch", "stick"), "slips": event_count("clutch", "slip"),
}  # fmt: skip


def _nonlinear(backend: str) -> Family:
    laws = {**CASE.laws, "clutch": stribeck_clutch("tau_h", 1.3, 2.0)}
    return Family(CASE.equations, CASE.parameters, laws, backend)


def _demand(values: Mapping[str, float]) -> dict[str, Any]:
    return {**CASE.inputs, "tau_h": Lag(Step(0.5, values["demand"]), 0.04)}


def test_a_nonlinear_differential_against_the_loop_in_python() -> None:
    times = np.linspace(0.45, 0.6, 76)
    rows = Table(k=[6000.0, 8600.0], demand=[1000.0, 700.0])
    one, other = (
        sweep(_nonlinear(b), rows, times, DIFFERENTIAL, CASE.initial, _demand, workers=0, **QUIET)
        for b in ("c", "numpy")
    )
    assert other["slips"].tolist() == [0, 1]
    for name in DIFFERENTIAL:
        size = float(np.abs(np.nan_to_num(other[name])).max())
        assert one[name] == pytest.approx(other[name], abs=1e-6 * size, nan_ok=True), name
    assert not one.failed


def test_inputs_held_beside_others_that_change() -> None:
    family = _braked("c*v**3", m=2.0, c=0.5)
    nodes = [bg.Se("push", "P"), bg.Se("pull", "Q"), bg.One("body"), bg.I("m", "m", flow="v"),
             bg.R("drag", law="c*v**3")]  # fmt: skip
    both = bg.derive(bond_graph(nodes, "push>body pull>body body>m body>drag"))
    family = Family(both, family.parameters, backend="c")
    job = Job(family, ("Q", "v"), TIMES, {"v": samples("v"), "Q": final("Q")}, None,
              {"P": Lag(Step(1.0, 2.0), 0.1) + Sine(0.5, 2.0)})  # fmt: skip
    _same(job, [(0.0, 1.0), (-2.0, 1.0), (3.0, -1.0)])
    sizes = {"P": Swept("size", Lag(Step(1.0, 2.0), 0.1) + Sine(0.5, 2.0)), "Q": Swept("other")}
    job = Job(family, ("size", "other", "c"), TIMES, {"v": samples("v"), "P": samples("P")},
              {"v": 1.0}, sizes)  # fmt: skip
    _same(job, [(0.0, 1.0, 0.5), (-2.0, 1.0, 2.0), (3.0, -1.0, 0.7)])


@pytest.mark.parametrize("method", ["auto", "DOP853"])
@pytest.mark.parametrize("inputs", [{"P": Swept("size")}, None], ids=["sized", "held"])
def test_chunks_without_a_run_that_can_be_done(method: str, inputs: Any) -> None:
    nodes = [bg.Se("push", "P"), bg.One("body"), bg.I("m", "m", flow="v"), bg.R("drag", "b")]
    equations = bg.derive(bond_graph(nodes, "push>body>m body>drag"))
    family = Family(equations, {"m": 1.0, "b": 0.5}, backend="c")
    rows = [{"m": m, "size" if inputs else "P": 1.0} for m in (1.0, 0.0, 2.0)]
    found = sweep(family, rows, TIMES, {"end": final("v")}, None, inputs, method=method, chunk=1,
                  workers=2, **QUIET)  # fmt: skip
    assert [failure.run for failure in found.failed] == [1]
    assert found["end"][[0, 2]] == pytest.approx(
        2.0 * (1 - np.exp(-0.5 * 3.0 / np.array([1.0, 2.0])))
    )


class _Nothing(Signal):
    """A signal of the caller's own, whose one piece has no terms."""

    breakpoints = ()
    pieces = (Piece(0.0, ()),)


def test_sizes_of_a_signal_without_terms_and_sizes_that_overflow() -> None:
    family, measures = _braked("c*v**3", m=2.0, c=0.5), {"end": final("v")}
    none = {"P": Swept("size", _Nothing())}
    found = sweep(
        family, {"size": [1.0, 2.0]}, TIMES, measures, {"v": 1.0}, none, workers=0, **QUIET
    )
    assert found["end"] == pytest.approx(1 / np.sqrt(1 + 0.5 * 3.0), rel=1e-8)
    large = {"P": Swept("size", Step(1.0, 1e10))}
    found = sweep(family, {"size": [1e308]}, TIMES, measures, {"v": 1.0}, large, workers=0, **QUIET)
    assert [failure.run for failure in found.failed] == [0]


@pytest.mark.parametrize("method", ["auto", "DOP853"])
def test_sizes_that_are_not_finite_fail_alone(method: str) -> None:
    affine = Family(bg.derive(oscillator()), {"m": 1.0, "k": 20.0, "F_c": 1.0}, backend="c")
    equations = affine.equations
    family = Family(equations, affine.parameters, {"ground": bg.DryFriction("L")}, "c")
    rows = Table(size=[1.0, np.nan, np.inf, 2.0])
    given = {"initial": {"v": 3.0}, "inputs": {"L": Swept("size", Step(1.0, 2.0, 1.0))}, **QUIET}
    found = sweep(family, rows, TIMES, {"end": final("F")}, method=method, workers=0, **given)
    assert [failure.run for failure in found.failed] == [1, 2]
    assert all("the factor is not finite" in failure.message for failure in found.failed)
    assert np.isfinite(found["end"][[0, 3]]).all()


def test_affine_models_by_a_method_that_locates() -> None:
    family = Family(bg.derive(oscillator()), {"m": 1.0, "k": 20.0, "F_c": 1.0}, backend="c")
    measures = {"speed": samples("v"), "stick": first_event("ground", "stick")}
    grid, found = {"k": [10.0, 40.0], "v": [1.0, 2.0]}, {}
    for method, kind in (("auto", ExactLoop), ("exact", ExactLoop), ("DOP853", LocatedLoop),
                         ("Radau", LocatedLoop)):  # fmt: skip
        job = Job(family, ("k",), TIMES, measures, None, None, {"method": method})
        loop = batch_of(job)
        assert loop is not None
        assert isinstance(loop.loop, kind)
        found[method] = sweep(family, grid, TIMES, measures, method=method, workers=0, **QUIET)
    for method in ("exact", "DOP853", "Radau"):
        assert found[method]["speed"] == pytest.approx(found["auto"]["speed"], abs=1e-6)
        assert found[method]["stick"] == pytest.approx(
            found["auto"]["stick"], abs=1e-6, nan_ok=True
        )
    assert batch_of(Job(family, ("k",), TIMES, measures, None, None, {"method": "CVODE"})) is None


def test_a_run_that_leaves_where_its_law_has_values_fails_alone() -> None:
    """v' = -sqrt(v) is at rest at t = 2 sqrt(v_0), beyond which v has no root."""
    fast, slow = (_braked("sqrt(v)", backend, m=1.0) for backend in ("c", "numpy"))
    found, expected = (
        sweep(
            f,
            {"v": [9.0, 1.0, 16.0]},
            TIMES,
            {"end": final("v")},
            None,
            {"P": 0.0},
            workers=0,
            **QUIET,
        )
        for f in (fast, slow)
    )
    assert [failure.run for failure in found.failed] == [1]
    assert [failure.values for failure in found.failed] == [{"v": 1.0}]
    assert [f.message for f in found.failed] == [f.message for f in expected.failed]
    assert found["end"][[0, 2]] == pytest.approx([(3 - 1.5) ** 2, (4 - 1.5) ** 2], rel=1e-8)


def test_an_effort_without_a_value_fails_where_no_state_sees_it() -> None:
    nodes = [bg.Sf("pump", "Q"), bg.One("n"), bg.R("valve", law="log(f)", effort="e", flow="f"),
             bg.Zero("z"), bg.C("tank", "c"), bg.One("body"), bg.I("m", "m", flow="v"),
             bg.R("drag", law="v**3")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "pump>n n>valve n>z>body z>tank body>m body>drag"))
    found, expected = (
        sweep(Family(equations, {"m": 1.0, "c": 1.0}, backend=b), {"Q": [2.0, -1.0]}, TIMES,
              {"effort": final("e")}, workers=0, **QUIET)
        for b in ("c", "numpy")
    )  # fmt: skip
    assert [failure.run for failure in found.failed] == [1]
    assert [f.message for f in found.failed] == [f.message for f in expected.failed]
    assert found["effort"][0] == pytest.approx(np.log(2.0))


def _pendulum() -> Family:
    nodes = [bg.One("turn"), bg.I("J", "m*l**2", flow="omega"), bg.Df("angle", integrate="theta"),
             bg.TF("arm", "l*cos(theta)"), bg.One("up"), bg.Se("weight", "P"),
             bg.I("more", "J")]  # fmt: skip
    graph = bond_graph(nodes, "turn>J turn>angle turn>arm>up weight>up turn>more")
    return Family(bg.derive(graph), {"m": 0.7, "l": 0.4, "J": 0.1}, backend="c")


def test_values_that_change_are_checked_run_by_run() -> None:
    family = _pendulum()
    assert family.program.varying
    rows = Table(m=[0.7, 0.0, 0.9, 0.7], theta=[0.1, 0.1, 1.2, 0.1], J=[0.1, 0.1, 0.1, -0.112])
    given = {"measures": {"end": final("theta")}, "inputs": {"P": 3.0}, "workers": 0, **QUIET}
    found = sweep(family, rows, TIMES, **given)
    assert [failure.run for failure in found.failed] == [1, 3]
    assert "is zero" in found.failed[0].message
    assert "A is singular" in found.failed[1].message
    assert np.isfinite(found["end"][[0, 2]]).all()
    _same(Job(family, ("m", "theta"), TIMES, {"a": samples("theta")}, None, {"P": 3.0}),
          [(0.7, 0.1), (0.9, 1.2)])  # fmt: skip


def test_a_pickled_job_has_its_loop_again() -> None:
    job = Job(_braked("c*v**3", m=2.0, c=0.5), ("v",), TIMES, {"v": final("v")}, None, {"P": 1.0})
    again = pickle.loads(pickle.dumps(job))
    one, other = (batch_of(each)([(1.0,), (2.0,)])[0][0] for each in (job, again))
    assert one.tolist() == other.tolist()
