"""Runs side by side: each is what the run by itself is, what C gives, and what closed forms say."""

from typing import Any

import numpy as np
import pytest
from oracles.beside import Many, many_chains
from oracles.sweeping import LOCKING, answer, locking, spring_mass

import bondgraph as bg
import codegen
from codegen import Family, Swept, Table, sweep
from codegen.abreast.abreast import abreast
from codegen.abreast.asked import Asked
from codegen.record.result import Result
from codegen.sweeps.job import Job
from codegen.sweeps.measuring import abreast_of
from codegen.tuning import TUNING
from differentials.scenarios import prepared

HERE: dict[str, Any] = {"workers": 0, "progress": False}
CASE = prepared("alsd", "fig11")


def _compared(many: Many, seed: int, backend: str = "numpy") -> tuple[int, set[Any]]:
    """How many runs were done side by side, and the orders of events that they had."""
    rows, orders, done = many.rows(), set(), 0
    found = many.beside().results(rows, lambda row: many.alone(np.asarray(row)))
    for row, one in zip(rows, found, strict=True):
        if one is None:
            continue
        other = many.alone(row, backend)
        told = [(event.port, event.kind) for event in one.events]
        assert told == [(event.port, event.kind) for event in other.events], seed
        times = [event.time for event in other.events]
        assert [event.time for event in one.events] == pytest.approx(times, abs=1e-9)
        assert list(one) == list(other)
        for name in other:
            size = max(float(np.abs(other[name]).max()), 1e-3)
            assert np.abs(one[name] - other[name]).max() <= 1e-9 * size, (seed, name)
        orders.add(tuple(told))
        done += 1
    return done, orders


@pytest.mark.parametrize("first", range(0, 24, 6))
def test_random_chains_are_single_runs(first: int) -> None:
    """Runs of one sweep stick and slip in other orders; those that share loads are done by themselves."""
    done = orders = 0
    for seed in range(first, first + 6):
        many = many_chains(seed, 6, breakaway=seed % 2 == 1)
        beside, told = _compared(many, seed)
        done, orders = done + beside, orders + len(told)
    assert done >= 15
    assert orders >= 10


@pytest.mark.parametrize("count", [2, 3, 6, 401])
def test_samples_far_apart_and_close(count: int) -> None:
    for seed in (1, 4, 9):
        done, _ = _compared(many_chains(seed, 4, np.linspace(0.0, 2.0, count)), seed)
        assert done == 4


def test_what_rounding_would_decide_is_done_by_itself() -> None:
    """A port without level and load slips at once or at the next breakpoint, by rounding alone."""
    done, _ = _compared(many_chains(358, 8, np.linspace(0.0, 2.0, 21), breakaway=True), 358)
    assert done == 0


def test_random_chains_are_what_c_gives() -> None:
    for seed in (2, 5):
        done, orders = _compared(many_chains(seed, 12), seed, "c")
        assert done == 12
        assert len(orders) > 3


def test_a_figure_of_the_paper_is_what_c_gives() -> None:
    rng = np.random.default_rng(3)
    base = float(CASE.parameters["k"])
    table = Table(k=base * rng.uniform(0.5, 2.0, 24), size=rng.uniform(500.0, 2200.0, 24))
    inputs = {**CASE.inputs, "tau_h": Swept("size", codegen.Lag(codegen.Step(0.5, 1.0), 0.04))}
    measures = {
        "peak": codegen.peak("tau_k1"), "end": codegen.final("omega_1"),
        "torque": codegen.samples("tau_f"), "lock": codegen.first_event("clutch", "stick"),
        "slip": codegen.first_event("clutch", "slip"), "least": codegen.smallest("tau_h"),
    }  # fmt: skip
    times, given = np.linspace(0.0, 1.0, 1001), (measures, CASE.initial, inputs)
    one, other = (
        sweep(
            Family(CASE.equations, CASE.parameters, CASE.laws, backend),
            table,
            times,
            *given,
            **HERE,
        )
        for backend in ("numpy", "c")
    )
    for name in measures:
        size = float(np.nanmax(np.abs(other[name])))
        assert one[name] == pytest.approx(other[name], abs=1e-9 * size, nan_ok=True), name
    assert 0 < np.isnan(other["slip"]).sum() < 24
    assert not one.failed


def test_a_spring_and_a_mass_are_the_closed_form() -> None:
    rng = np.random.default_rng(0)
    columns = {"m": rng.uniform(0.5, 3, 20), "k": rng.uniform(1, 30, 20), "v": rng.normal(size=20)}
    columns["P"] = rng.normal(size=20)
    times = np.linspace(0.0, 2.0, 21)
    measures = {"speed": codegen.final("v"), "force": codegen.final("F")}
    found = sweep(spring_mass(), Table(**columns), times, measures, **HERE)
    m, k, v, P = (found[name] for name in "mkvP")
    speed, force = answer(m, k, v, P, 2.0)
    assert found["speed"] == pytest.approx(speed, rel=1e-9, abs=1e-9)
    assert found["force"] == pytest.approx(force, rel=1e-9, abs=1e-9)


def final_speed(result: Result) -> float:
    """A measure of one's own, of what is recorded and of what is not."""
    return float(result["omega_1"][-1] + result.power("clutch").sum() + len(result.events))


MEASURES = {
    **LOCKING["measures"], "own": final_speed, "torque": codegen.samples("tau_f"),
    "work": codegen.work("clutch"), "flow": codegen.integral("omega_f"),
}  # fmt: skip


def _locking(table: Table, **more: Any) -> codegen.Sweep:
    given = {**LOCKING, "initial": {"omega_1": 80.0}, "measures": MEASURES, **HERE, **more}
    return sweep(locking(), table, **given)


TABLE = Table(c=np.linspace(300.0, 900.0, 14), omega_2=np.linspace(81.0, 88.0, 14))


def test_functions_of_ones_own_and_what_is_not_recorded() -> None:
    found = _locking(TABLE)
    for at in (0, 6, 13):
        c, omega = TABLE.row(at)
        start = {"omega_1": 80.0, "omega_2": omega}
        result = locking().simulator(c=c).run(LOCKING["time"], start, LOCKING["inputs"])
        for name, measure in MEASURES.items():
            assert found[name][at] == pytest.approx(
                measure(result), rel=1e-9, abs=1e-9, nan_ok=True
            ), name


def test_chunks_and_workers_change_no_number() -> None:
    whole = _locking(TABLE, chunk=14)
    for more in ({"chunk": 1}, {"chunk": 5}, {"chunk": 4, "workers": 2}):
        other = _locking(TABLE, measures={n: m for n, m in MEASURES.items() if n != "own"}, **more)
        for name in ("stick", "peak", "torque", "work", "flow"):
            assert np.array_equal(whole[name], other[name], equal_nan=True)


def test_runs_that_are_refused_are_told_as_by_themselves() -> None:
    rows = [[750.0, 82.0], *([c, 84.0] for c in np.linspace(300, 900, 10))]
    table = Table(
        I_w1=[0.8, 0.0, *[0.7] * 9], size=[1.0, 1.0, -1.0, *[1.0] * 8], c=[r[0] for r in rows]
    )
    inputs = {"tau_e": 0.0, "tau_h": Swept("size", codegen.Lag(codegen.Step(0.0, 1000.0), 0.04))}
    found = _locking(table, inputs=inputs, initial=LOCKING["initial"])
    job = Job(locking(), table.names, LOCKING["time"], MEASURES, LOCKING["initial"], inputs)
    assert [one.run for one in found.failed] == [1, 2]
    for one in found.failed:
        assert one.message == job.run(table.row(one.run))
    assert "its value I_w1 is zero" in found.failed[0].message
    assert np.isfinite(found["peak"][3:]).all()


@pytest.mark.parametrize(
    ("more", "runs"),
    [
        ({}, 14),
        ({"runs": 7}, 7),
        ({"time": np.linspace(0.0, 1.0, 21) ** 2}, 14),
        ({"settings": {"method": "DOP853"}}, 14),
        ({"initial": lambda values: {}}, 14),
        ({"initially_on": ("clutch",)}, 14),
    ],
)
def test_which_runs_are_done_side_by_side(more: dict[str, Any], runs: int) -> None:
    given = {"time": LOCKING["time"], "initial": {"omega_1": 80.0}, "inputs": LOCKING["inputs"]}
    job = Job(locking(), TABLE.names, measures=MEASURES, **{**given, "runs": runs, **more})
    assert (abreast_of(job) is None) == bool(more)
    assert TUNING.side_by_side == 8


def test_models_that_switch_or_are_not_affine_are_done_one_by_one() -> None:
    for law in (bg.DryFriction("tau_h*exp(-omega_f**2)"), "c*omega_f**3"):
        family = Family(
            locking().equations, locking().parameters, {**locking().laws, "clutch": law}
        )
        asked = Asked(
            family, ("c",), LOCKING["time"], {}, {"tau_e": 0.0, "tau_h": 1.0}, "auto", True
        )
        assert abreast(asked) is None


def test_a_formula_that_takes_no_arrays_is_done_one_by_one() -> None:
    """The larger of a number of each run and one that all share."""
    import networkx as nx

    graph = nx.DiGraph()
    graph.add_nodes_from([bg.One("mass"), bg.I("m", "Max(m, 2)", flow="v"), bg.R("damper", "b")])
    graph.add_edges_from([("mass", "m"), ("mass", "damper")])
    family = Family(bg.derive(graph), {"m": 1.0, "b": 1.0})
    m = np.linspace(1.0, 4.0, 10)
    found = sweep(family, {"m": m}, [0.0, 0.5, 1.0], {"v": codegen.final("v")}, {"v": 1.0}, **HERE)
    assert found["v"] == pytest.approx(np.exp(-1.0 / np.maximum(m, 2.0)), rel=1e-12)


def test_a_source_that_drives_a_dependent_storage() -> None:
    """Two inertias in one: an imposed speed leaves the second no state of its own."""
    import networkx as nx

    graph = nx.DiGraph()
    graph.add_nodes_from([bg.Sf("drive", "w"), bg.One("shaft"), bg.I("J", "J"), bg.Zero("joint"),
                          bg.C("spring", "1/k", effort="T"), bg.One("wheel"), bg.I("I", "I", flow="o"),
                          bg.R("drag", "b")])  # fmt: skip
    graph.add_edges_from([("drive", "shaft"), ("shaft", "J"), ("shaft", "joint"), ("joint", "spring"),
                          ("joint", "wheel"), ("wheel", "I"), ("wheel", "drag")])  # fmt: skip
    family = Family(bg.derive(graph), {"J": 1.0, "I": 0.5, "k": 20.0, "b": 0.3})
    table = Table(k=np.linspace(5.0, 50.0, 12), I=np.linspace(0.2, 2.0, 12))
    times, inputs = np.linspace(0.0, 2.0, 101), {"w": codegen.Lag(codegen.Step(0.1, 3.0), 0.2)}
    measures = {"o": codegen.samples("o"), "T": codegen.final("T")}
    found = sweep(family, table, times, measures, None, inputs, **HERE)
    fast = Family(family.equations, family.parameters, backend="c")
    other = sweep(fast, table, times, measures, None, inputs, **HERE)
    assert found["o"] == pytest.approx(other["o"], abs=1e-9)
    assert found["T"] == pytest.approx(other["T"], rel=1e-9)
