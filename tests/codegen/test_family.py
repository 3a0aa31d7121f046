"""`Family`: other numbers for the same program, here and in other processes."""

import os
import pickle
import subprocess
import sys
from pathlib import Path

import networkx as nx
import numpy as np
import pytest
from oracles.sweeping import LOCKING, TIMES, locking, spring_mass
from references.build import bond_graph

import bondgraph as bg
import codegen
from codegen import Family

TESTS = Path(__file__).parents[1]


def test_a_family_gives_what_a_simulator_of_these_numbers_gives() -> None:
    family = locking()
    numbers = {**family.parameters, "c": 500, "I_w1": 1.1}
    one = family.simulator(c=500, I_w1=1.1)
    other = codegen.simulator(family.equations, numbers, family.laws)
    given = {name: LOCKING[name] for name in ("time", "initial", "inputs")}
    first, second = one.run(**given), other.run(**given)
    assert first.events == second.events
    for name in first:
        assert (first[name] == second[name]).all()


def test_other_numbers_are_bound_to_one_program(monkeypatch) -> None:
    family = spring_mass()
    one, other = family.simulator(), family.simulator(k=3)
    assert one.closed.program is other.closed.program
    monkeypatch.setattr("codegen.family.lower", None)
    assert family.simulator(m=1).rhs(0, [0, 1], [0]) == pytest.approx([-1, 0])
    assert family.parameters == {"m": 2.0, "k": 8.0}


def test_a_pickled_family_runs_the_same_program() -> None:
    family = locking()
    copy = pickle.loads(pickle.dumps(family))
    assert copy.program == family.program
    assert copy.fingerprint() == family.fingerprint()
    lowered = codegen.lower(copy.equations, copy.laws, copy.parameters)
    assert lowered == family.program
    places = [i for pattern in lowered.layout.values() for i in (*pattern.rows, *pattern.columns)]
    assert {type(place) for place in places} == {int}
    given = {name: LOCKING[name] for name in ("time", "initial", "inputs")}
    first, second = family.simulator(c=300).run(**given), copy.simulator(c=300).run(**given)
    assert all((first[name] == second[name]).all() for name in first)
    assert first.events == second.events


def test_unusable_numbers_are_refused_by_name() -> None:
    family = spring_mass()
    with pytest.raises(bg.ParameterError, match="'c' is not a parameter; there are m, k"):
        family.simulator(c=1)
    with pytest.raises(bg.ParameterError, match=r"'m'.* is zero or infinite at m = 0"):
        family.simulator(m=0)
    with pytest.raises(bg.ParameterError, match=r"missing parameter\(s\) m"):
        Family(family.equations, {"k": 1}).simulator()
    with pytest.raises(bg.ParameterError, match="parameters must map"):
        Family(family.equations, [1])  # type: ignore[arg-type]
    with pytest.raises(bg.SignalError, match="unknown backend 'abacus'"):
        Family(family.equations, {"m": 1, "k": 1}, backend="abacus")


def test_names_that_look_alike_are_one() -> None:
    assert spring_mass().simulator(**dict.fromkeys(["\uff4b"], 2)).rhs(
        0, [1, 0], [0]
    ) == pytest.approx([0, 2])


def test_a_fingerprint_tells_models_and_numbers_apart() -> None:
    family = locking()
    changed = [
        Family(family.equations, {**family.parameters, "c": 751}, family.laws),
        Family(family.equations, family.parameters, {**family.laws, "tire_1": "c*omega_t1"}),
        Family(family.equations, family.parameters,
               {**family.laws, "clutch": bg.DryFriction("tau_h", "1 + exp(-slip)")}),
        Family(bg.derive(_softer()), {"m": 2.0, "k": 8.0}), spring_mass(), family,
    ]  # fmt: skip
    assert len({one.fingerprint() for one in changed}) == len(changed)
    assert locking().fingerprint() == family.fingerprint()


def _softer() -> nx.DiGraph:
    nodes = [bg.Se("push", "P"), bg.One("mass"), bg.I("m", "m", flow="v"),
             bg.C("spring", "2/k", effort="F")]  # fmt: skip
    return bond_graph(nodes, "push>mass>m mass>spring")


def test_fingerprints_and_numbers_do_not_depend_on_the_process() -> None:
    code = (
        "from oracles.sweeping import *\n"
        "family = locking()\n"
        "run = family.simulator(c=601).run(LOCKING['time'], LOCKING['initial'], LOCKING['inputs'])\n"
        "print((family.fingerprint(), [run[name].tolist() for name in run], run.events))"
    )
    paths = os.pathsep.join(map(str, (TESTS.parent, TESTS, TESTS / "codegen")))
    there = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, "PYTHONPATH": paths, "PYTHONHASHSEED": "1"},
        check=True, capture_output=True, text=True,
    ).stdout  # fmt: skip
    family = locking()
    given = {name: LOCKING[name] for name in ("time", "initial", "inputs")}
    run = family.simulator(c=601).run(**given)
    here = (family.fingerprint(), [run[name].tolist() for name in run], run.events)
    assert there == f"{here}\n"


def test_ready_measures_of_a_run() -> None:
    result = spring_mass().simulator().run(TIMES, {"v": 1.0}, {"P": 0.0})
    v, F = result["v"], result["F"]
    assert codegen.peak("F")(result) == abs(F).max()
    assert codegen.largest("v")(result) == v.max() == 1.0
    assert codegen.smallest("v")(result) == v.min() < 0
    assert codegen.final("v")(result) == v[-1]
    k = float(spring_mass().parameters["k"])  # type: ignore[arg-type]
    assert codegen.integral("v")(result) == pytest.approx(F[-1] / k, rel=1e-9)
    assert (codegen.samples("F")(result) == F).all()
    assert codegen.work("spring")(result) == result.work("spring")[-1]


def test_ready_measures_of_events() -> None:
    result = locking().simulator().run(
        LOCKING["time"], LOCKING["initial"], LOCKING["inputs"]
    )  # fmt: skip
    assert codegen.first_event("clutch", "stick")(result) == result.events[0].time
    assert np.isnan(codegen.first_event("clutch", "slip")(result))
    assert codegen.event_count("clutch", "stick")(result) == 1.0
    assert codegen.event_count("left", "stick")(result) == 0.0
    with pytest.raises(bg.SignalError, match="no node 'clutsch'"):
        codegen.event_count("clutsch", "stick")(result)


def test_ready_measures_are_pickled_and_tell_how_they_were_made() -> None:
    for measure in (
        codegen.peak("v"),
        codegen.first_event("clutch", "stick"),
        codegen.samples("v"),
    ):
        assert pickle.loads(pickle.dumps(measure)) == measure
    assert repr(codegen.first_event("clutch", "stick")) == "first_event('clutch', 'stick')"
