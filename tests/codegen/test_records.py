"""What the package hands out cannot be changed afterwards: neither what it shows, nor what it works from."""

import copy
import pickle
from collections.abc import Callable
from typing import Any

import networkx as nx
import numpy as np
import pytest
from oracles.models import oscillator, series_circuit
from oracles.sweeping import LOCKING, locking
from references.build import bond_graph
from references.frozen import changeable

import bondgraph as bg
import codegen
from codegen import Family, Lag, Sampled, Sine, Step

TIMES = np.linspace(0.0, 1.0, 51)
NUMBERS = {"m": 2.3, "k": 517.0, "F_c": 4.1}


@pytest.fixture(scope="module")
def rubbing() -> bg.StateEquations:
    return bg.derive(oscillator())


def _switched() -> codegen.SwitchedSimulator:
    nodes = [bg.One("first"), bg.I("m_1", 1, flow="v_1"), bg.Zero("gap"), bg.Sw("slack", on="1 - t"),
             bg.One("second"), bg.I("m_2", 3, flow="v_2")]  # fmt: skip
    return codegen.switched_simulator(
        bond_graph(nodes, "first>m_1 first>gap>slack gap>second>m_2"), {}
    )


def _crank() -> nx.DiGraph:
    """A wheel whose inertia changes with its angle."""
    nodes = [bg.Se("torque", "tau"), bg.One("shaft"), bg.I("wheel", "J + c*cos(phi)**2", flow="w"),
             bg.Df("angle", flow="w_s", integrate="phi")]  # fmt: skip
    return bond_graph(nodes, "torque>shaft>wheel shaft>angle")


def _asked(result: codegen.Result) -> list[list[str]]:
    """What can be changed of a run, before and after it was asked for all that it works out later."""
    before = changeable(result)
    audit = result.audit()
    whole = result.integral(result.states[0])
    assert result.integral(result.states[0]) is not whole
    return [before, changeable(result), changeable(audit)]


@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize("method", ["auto", "DOP853"])
def test_no_run_can_be_changed(rubbing: bg.StateEquations, backend: str, method: str) -> None:
    ready = codegen.simulator(rubbing, NUMBERS, {}, backend)
    run = ready.run(TIMES, {"F": 60.0}, method=method)
    assert run.events
    assert run.backend == backend
    assert [*_asked(run), changeable(ready)] == [[]] * 4
    with pytest.raises(ValueError, match="read-only"):
        run["v"][0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        run.time[0] = 1.0
    with pytest.raises(TypeError, match="does not support item assignment"):
        run.audit().gave["more"] = 1.0  # type: ignore[index]


def test_no_run_of_a_model_that_moves_can_be_changed() -> None:
    ready = codegen.simulator(bg.derive(_crank()), {"J": 1.0, "c": 0.5})
    run = ready.run(TIMES, {"w": 1.0}, {"tau": Sine(1.0, 2.0)})
    assert [*_asked(run), changeable(ready)] == [[]] * 4


def test_no_run_with_switches_can_be_changed() -> None:
    ready = _switched()
    run = ready.run([0.0, 0.5, 2.0], {"v_1": 4.0})
    assert run.events
    assert [*_asked(run), changeable(ready)] == [[]] * 4
    with pytest.raises(ValueError, match="read-only"):
        run["slack"][0] = 1.0


def test_no_sparse_model_or_run_of_it_can_be_changed() -> None:
    model = codegen.sparse_model(series_circuit(), {"R": 2.0, "L": 0.5, "C": 0.02}, ["resistor"])
    run = codegen.run_sparse(model, TIMES, inputs={"V": Step(0.2, 12.0)})
    assert [changeable(model), changeable(run)] == [[], []]


def test_no_program_or_family_can_be_changed() -> None:
    family = locking()
    family.simulator(c=300)
    again = pickle.loads(pickle.dumps(family))
    found = (family.program, family, again, again.program)
    assert [changeable(record) for record in found] == [[]] * 4


def test_no_sweep_can_be_changed() -> None:
    found = codegen.sweep(
        locking(), {"c": [300.0, 700.0]}, LOCKING["time"], LOCKING["measures"],
        initial=LOCKING["initial"], inputs=LOCKING["inputs"], workers=0, progress=False,
    )  # fmt: skip
    assert found.complete
    assert changeable(found) == []
    with pytest.raises(ValueError, match="read-only"):
        found["peak"][0] = 1.0


def test_no_comparison_or_spectrum_can_be_changed(rubbing: bg.StateEquations) -> None:
    ready = codegen.simulator(rubbing, NUMBERS)
    one, other = ready.run(TIMES, {"F": 60.0}), ready.run(TIMES, {"F": 50.0})
    found = (codegen.compare([one, other]), codegen.spectrum(one, "v"))
    assert [changeable(record) for record in found] == [[], []]


def test_no_signal_or_measure_can_be_changed() -> None:
    signals = [
        Step(0.1, 2.0),
        Lag(Step(0.0, 1.0), 0.04),
        Sampled([0.0, 1.0], [2.0, 3.0]),
        Sine(1.0, 2.0),
    ]
    whole = 2 * signals[0] + signals[1]
    assert whole(0.2) == pytest.approx(4 + 1 - np.exp(-5))
    assert all(signal.pieces for signal in signals)
    found = (*signals, whole, codegen.Swept("a", whole), *LOCKING["measures"].values())
    assert [changeable(record) for record in found] == [[]] * len(found)


def test_records_keep_what_they_were_given(rubbing: bg.StateEquations) -> None:
    """What a caller does with arguments afterwards is nothing to a record."""
    times, laws = TIMES.copy(), {"ground": bg.DryFriction("F_c")}
    ready, family = codegen.simulator(rubbing, NUMBERS, laws), Family(rubbing, NUMBERS, laws)
    run = ready.run(times, {"F": 60.0})
    before = run.audit()
    laws["ground"] = bg.DryFriction("2*F_c")
    times[:] = 0.0
    assert (run.time == TIMES).all()
    assert family.simulator().run(TIMES, {"F": 60.0}).events == run.events
    assert ready.run(TIMES, {"F": 60.0}).audit() == before


@pytest.mark.parametrize("again", [copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))])
def test_an_audit_can_be_copied_and_pickled(
    rubbing: bg.StateEquations, again: Callable[[Any], Any]
) -> None:
    audit = codegen.simulator(rubbing, NUMBERS).run(TIMES, {"F": 60.0}).audit()
    copied = again(audit)
    assert copied == audit
    assert str(copied) == str(audit)
    assert changeable(copied) == []
