"""Runs side by side: what each gives by itself, whatever goes beside it, and which go so."""

from typing import Any

import networkx as nx
import numpy as np
import pytest
from references.build import bond_graph

import bondgraph as bg
from codegen import (
    Family,
    Lag,
    Sampled,
    Signal,
    Sine,
    Step,
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
from codegen.engine.located import LanesLibrary
from differentials.laws import magic_formula_tire, stribeck_clutch
from differentials.scenarios import prepared

CASE = prepared(
    "alsd", "fig11", laws={"tire_1": magic_formula_tire(1), "tire_2": magic_formula_tire(2)}
)
TIMES = np.linspace(0.0, 1.0, 201)
QUIET: dict[str, Any] = {"progress": False, "workers": 0}
SIGNALS = ("omega_1", "omega_2", "tau_k1", "tau_k2", "omega_t1", "tau_t2", "tau_f")
KEPT = {name: samples(name) for name in SIGNALS} | {
    "stick": first_event("clutch", "stick"), "slips": event_count("clutch", "slip"),
}  # fmt: skip


def _differential(backend: str = "c", **laws: Any) -> Family:
    return Family(CASE.equations, CASE.parameters, {**CASE.laws, **laws}, backend)


def _swept(family: Family, table: Any, **settings: Any) -> Any:
    return sweep(
        family, table, TIMES, KEPT, CASE.initial, CASE.inputs, **{**QUIET, **settings}
    )  # fmt: skip


def _numbers(count: int) -> dict[str, Any]:
    rng = np.random.default_rng(3)
    return {"k": rng.uniform(4000.0, 12000.0, count), "I_w": rng.uniform(0.9, 1.6, count)}


def _grid(count: int) -> Table:
    return Table(**_numbers(count))


def test_a_clutch_that_locks_between_tires_that_saturate() -> None:
    """Tight steps in numpy, which share no code with lanes, at every sample."""
    table = _grid(11)
    found = _swept(_differential(), table)
    exact = _swept(_differential("numpy"), table, rtol=1e-11, atol=1e-12)
    assert not found.failed
    assert isinstance(_differential().library.side_by_side, LanesLibrary)
    assert found["slips"].tolist() == exact["slips"].tolist()
    assert found["stick"] == pytest.approx(exact["stick"], abs=1e-7, nan_ok=True)
    for name in SIGNALS:
        span = np.ptp(exact[name], axis=1)
        apart = np.abs(found[name] - exact[name]).max(axis=1)
        assert (apart <= 1e-6 * np.maximum(span, 1e-2)).all(), name


def test_no_run_hangs_on_those_beside_it() -> None:
    numbers, family = _numbers(21), _differential(clutch=stribeck_clutch("tau_h", 1.3, 2.0))
    whole, turned, alone = (
        _swept(family, Table(**{name: row[chosen] for name, row in numbers.items()}))
        for chosen in (slice(None), slice(None, None, -1), slice(4, 5))
    )
    for name in KEPT:
        assert np.array_equal(turned[name][::-1], whole[name], equal_nan=True), name
        assert np.array_equal(alone[name][0], whole[name][4], equal_nan=True), name


def _pipe(law: str, **numbers: float) -> Family:
    """Two tanks one below the other, each with an outlet of this law, fed by a pump."""
    nodes = [
        bg.Sf("pump", "Q"), bg.Zero("upper"), bg.C("A", "C_A", effort="p_A"), bg.One("fall"),
        bg.R("first", law=law.format("e_first"), gives="flow"), bg.Zero("lower"),
        bg.C("B", "C_B", effort="p_B"), bg.R("last", law=law.format("e_last"), gives="flow"),
    ]  # fmt: skip
    bonds = "pump>upper>A upper>fall>lower>B fall>first lower>last"
    return Family(bg.derive(bond_graph(nodes, bonds)), numbers, backend="c")


ROOT = "c*sign({0})*sqrt(abs({0}))"


def test_roots_whose_pressure_changes_its_sign() -> None:
    """The loop in numpy locates the same corners; both tanks exchange their parts several times."""
    inputs = {"Q": Sine(0.8, 0.5)}
    start, times = {"p_A": 0.5, "p_B": 0.1}, np.linspace(0.0, 6.0, 121)
    numbers = {"C_A": 1.0, "C_B": 0.4, "c": 0.7}
    family = _pipe(ROOT, **numbers)
    table = Table(c=np.linspace(0.3, 1.1, 9))
    kept = {"A": samples("p_A"), "B": samples("p_B"), "way": integral("f_last")}
    found = sweep(family, table, times, kept, start, inputs, **QUIET)
    slow = Family(family.equations, numbers, backend="numpy")
    exact = sweep(slow, table, times, kept, start, inputs, rtol=1e-11, atol=1e-12, **QUIET)
    assert not found.failed
    assert isinstance(family.library.side_by_side, LanesLibrary)
    assert (exact["A"] < 0).any()
    assert (exact["A"] > 0).any()
    for name in kept:
        assert found[name] == pytest.approx(exact[name], abs=1e-6), name


@pytest.mark.parametrize("signal", [
    Step(1.0, 0.4), Lag(Step(1.0, 2.0), 0.3), Sine(3.0, 1.2, offset=0.5),
    Sampled([0.0, 1.0, 2.0, 3.0], [0.0, 2.0, -1.0, 0.5], "pchip"),
    Sampled([0.0, 1.0, 2.0, 3.0], [0.0, 2.0, -1.0, 0.5], "held"),
], ids=["step", "lag", "sine", "pchip", "held"])  # fmt: skip
def test_inputs_of_every_kind(signal: Signal) -> None:
    """A mass on a cubic spring that is pushed: no port, so that steps and samples are all there is."""
    nodes = [bg.Se("push", "P"), bg.One("v_"), bg.I("m", "m", flow="v"), bg.C("s", law="q_s**3 + q_s"),
             bg.R("d", "b")]  # fmt: skip
    graph: nx.DiGraph[Any] = bond_graph(nodes, "push>v_>m v_>s v_>d")
    family = Family(bg.derive(graph), {"m": 1.0, "b": 0.1}, backend="c")
    table, times = Table(m=np.linspace(0.5, 2.0, 9)), np.linspace(0.0, 3.0, 61)
    kept = {"v": samples("v"), "q": samples("q_s"), "P": samples("P")}
    found = sweep(family, table, times, kept, None, {"P": signal}, **QUIET)
    slow = Family(family.equations, {"m": 1.0, "b": 0.1}, backend="numpy")
    exact = sweep(slow, table, times, kept, None, {"P": signal}, rtol=1e-11, atol=1e-12, **QUIET)
    assert isinstance(family.library.side_by_side, LanesLibrary)
    for name in kept:
        assert found[name] == pytest.approx(exact[name], abs=2e-7), name


def test_what_measures_read_between_states() -> None:
    """Peaks of readings and totals, which ask for more than states at each sample and step."""
    table = _grid(9)
    kept = {"force": peak("tau_t1"), "least": smallest("tau_f"), "most": largest("omega_t2"),
            "way": integral("omega_1"), "end": final("tau_t2")}  # fmt: skip
    one, other = (
        sweep(_differential(b), table, TIMES, kept, CASE.initial, CASE.inputs, **QUIET)
        for b in ("c", "numpy")
    )
    for name in kept:
        size = float(np.abs(other[name]).max())
        assert one[name] == pytest.approx(other[name], abs=2e-6 * size), name


def test_friction_on_an_imposed_speed_sticks_at_a_rate_of_an_input() -> None:
    """A block dragged by a belt whose speed is given: it sticks to the belt, so that its rate is the belt's.

    While it sticks ``m v' = F - k q - c q^3`` with v = V sin(w t), so the friction is that less the spring.
    """
    nodes = [bg.Sf("belt", "V"), bg.Zero("between"), bg.R("rub", law=bg.DryFriction("F")), bg.One("block"),
             bg.I("m", "m", flow="v"), bg.C("s", law="k*q_s + c*q_s**3")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "belt>between>rub between>block>m block>s"))
    numbers = {"F": 5.0, "m": 2.0, "k": 3.0, "c": 4.0}
    family, times = Family(equations, numbers, backend="c"), np.linspace(0.0, 1.0, 51)
    table = Table(m=np.linspace(0.5, 3.0, 9))
    kept = {"v": samples("v"), "q": samples("q_s"), "f": samples("e_rub")}
    found = sweep(family, table, times, kept, None, {"V": Sine(0.5, 0.2)}, **QUIET)
    turn = 2 * np.pi * 0.2
    speed = 0.5 * np.sin(turn * times)
    way = 0.5 * (1 - np.cos(turn * times)) / turn
    assert found["v"] == pytest.approx(np.tile(speed, (9, 1)), abs=1e-8)
    assert found["q"] == pytest.approx(np.tile(way, (9, 1)), abs=1e-8)
    push = found["m"][:, None] * 0.5 * turn * np.cos(turn * times) + 3 * way + 4 * way**3
    assert np.abs(found["f"]) == pytest.approx(np.abs(push), abs=1e-7)


def test_which_go_side_by_side() -> None:
    assert isinstance(_pipe(ROOT, c=1.0, C_A=1.0, C_B=1.0).library.side_by_side, LanesLibrary)
    linear = _pipe("c*{0}", c=1.0, C_A=1.0, C_B=1.0).library
    assert linear.side_by_side is linear
