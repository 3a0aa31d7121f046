"""Every kind of port that switches runs in C as in numpy, by exact steps and by step control."""

import shutil
from typing import Any

import numpy as np
import pytest
from oracles.audited import CLOSED, open_part
from oracles.switching import CASES, Case, case, equations
from references.build import bond_graph
from soak.families import whole

import bondgraph as bg
from codegen import Result, simulator

pytestmark = pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")

TIGHT = {"rtol": 1e-12, "atol": 1e-13}
"""Of steps with control; exact ones do not ask."""

LOCATED = ("condition that is not affine", "friction behind a moving ratio",
           "dog clutch behind a moving ratio", "bridge of diodes")  # fmt: skip
"""What exact steps are not for: laws or conditions that are not affine, and ports that share a load."""

SLICE = ("diode", "contactor and diode", "dog clutch, by time", "dog clutch beside a brake",
         "condition that is not affine", "friction behind a moving ratio")  # fmt: skip
"""Looked at every time."""


def _run(name: str, backend: str, **settings: Any) -> Result:
    one: Case = case(name)
    ready = simulator(equations(name), one.parameters, one.laws, backend)
    assert (ready.engine is not None) or backend == "numpy" or name in LOCATED
    done = ready.run(
        one.times, one.initial, one.inputs, initially_on=one.initially_on, **TIGHT, **settings
    )
    assert done.backend == backend
    return done


def _agree(found: Result, expected: Result) -> None:
    told = [(event.port, event.kind) for event in expected.events]
    assert told
    assert [(event.port, event.kind) for event in found.events] == told
    times = [event.time for event in expected.events]
    assert [event.time for event in found.events] == pytest.approx(times, abs=1e-9)
    assert list(found) == list(expected)
    for name in expected:
        span = max(float(np.ptp(expected[name])), 1e-9)
        assert np.abs(found[name] - expected[name]).max() <= 1e-9 * span, name


@pytest.mark.parametrize("name", CASES if whole("switches-in-c") else SLICE)
def test_c_agrees_with_numpy(name: str) -> None:
    """Events to 1e-9 s, columns to 1e-9 of their range; the power balance closes with its impacts."""
    expected, found = _run(name, "numpy"), _run(name, "c")
    _agree(found, expected)
    assert open_part(expected) < CLOSED
    assert open_part(found) < CLOSED


@pytest.mark.parametrize("name", ["contactor and diode", "dog clutch beside a brake"])
def test_step_control_in_c_agrees_with_exact_steps(name: str) -> None:
    _agree(_run(name, "c", method="DOP853"), _run(name, "numpy"))


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_impacts_take_what_momentum_leaves(backend: str) -> None:
    """At 0.31 s the dog joins v_1 and v_2: m_1 m_2/(m_1 + m_2) (v_1 - v_2)^2/2 is lost."""
    result = _run("dog clutch, by time", backend)
    at = int(np.searchsorted(result.time, 0.31))
    # A cubic through four samples before, as both move smoothly there.
    before = [
        np.polyval(np.polyfit(result.time[at - 4 : at], result[v][at - 4 : at], 3), 0.31)
        for v in ("v_1", "v_2")
    ]
    lost = 3 / 4 * (before[0] - before[1]) ** 2 / 2
    assert result.audit().impacts == pytest.approx(lost, rel=1e-6)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_a_coil_that_is_cut_off_loses_what_it_holds(backend: str) -> None:
    """L i^2/2 with i = (1 - exp(-2 t))/2 at 1 s, all of it in the impact."""
    nodes = [
        bg.Se("E", "U"),
        bg.One("w"),
        bg.Sw("key", on="1 - t"),
        bg.R("R", 2),
        bg.I("L", 1, flow="i"),
    ]
    ready = simulator(bg.derive(bond_graph(nodes, "E>w w>key w>R w>L")), {}, backend=backend)
    result = ready.run(np.linspace(0, 2, 9), inputs={"U": 1.0})
    current = (1 - np.exp(-2)) / 2
    assert result.audit().impacts == pytest.approx(current**2 / 2, rel=1e-9)
    assert open_part(result) < CLOSED


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_what_a_diode_carries_on_is_not_lost(backend: str) -> None:
    result = _run("contactor and diode", backend)
    assert abs(result.audit().impacts) < 1e-12
