"""Clutches that lock one relative speed twice: they act as one and share the load fairly."""

import networkx as nx
import numpy as np
import pytest

import bondgraph as bg
import codegen
import differentials
from differentials.laws import linear_tire
from differentials.parts import assemble, clutch

LEVELS = {"tau_h": 400.0, "tau_l": 600.0}
NUMBERS = {"i": 2.8, "I_i": 0.1604, "I_1": 0.008, "I_2": 0.008, "I_w": 0.8, "k": 8600.0, "b": 0.0,
           "k_t": 2e5, "r": 0.3, "omega_t1_0": 80.0, "omega_t2_0": 82.0}  # fmt: skip


def _run(graph: nx.DiGraph, levels: dict[str, str], demands: dict[str, float]) -> codegen.Result:
    laws = {node: bg.DryFriction(level) for node, level in levels.items()}
    laws |= {f"tire_{j}": linear_tire(j) for j in (1, 2)}
    ready = codegen.simulator(bg.derive(graph, outputs=list(levels)), NUMBERS, laws=laws)
    start = {"omega_1": 80, "omega_t1": 80, "omega_2": 82, "omega_t2": 82}
    inputs = {name: codegen.Lag(codegen.Step(0.05, level), 0.04) for name, level in demands.items()}
    return ready.run(np.linspace(0, 0.25, 251), start, {"tau_e": 100.0, **inputs})


@pytest.fixture(scope="module")
def runs() -> tuple[codegen.Result, codegen.Result]:
    """The ALSD with a second clutch between case and left output, and with one of their joint level."""
    one = differentials.graph("alsd", halfshafts=True)
    both = assemble(one, clutch("other", "tau_g", "omega_g", driving="case", driven="left"))
    pair = _run(both, {"clutch": "tau_h", "other": "tau_l"}, LEVELS)
    return pair, _run(one, {"clutch": "tau_h"}, {"tau_h": sum(LEVELS.values())})


def test_two_clutches_on_one_slip_move_as_one_of_their_joint_level(
    runs: tuple[codegen.Result, codegen.Result],
) -> None:
    pair, single = runs
    for name in single.states:
        assert abs(pair[name] - single[name]).max() < 1e-7 * np.ptp(single[name]), name


def test_they_lock_and_let_go_in_the_same_instants(
    runs: tuple[codegen.Result, codegen.Result],
) -> None:
    pair, single = runs
    expected = [(event.time, event.kind) for event in single.events]
    assert [kind for _, kind in expected] == ["stick", "slip"]
    for port in ("clutch", "other"):
        found = [(event.time, event.kind) for event in pair.events if event.port == port]
        assert [kind for _, kind in found] == ["stick", "slip"]
        assert [t for t, _ in found] == pytest.approx([t for t, _ in expected], abs=1e-9)


def test_while_both_hold_each_carries_the_same_fraction_of_its_level(
    runs: tuple[codegen.Result, codegen.Result],
) -> None:
    pair, single = runs
    stick, slip = (event.time for event in single.events)
    held = (pair.time > stick) & (pair.time < slip)
    fraction = pair["tau_f"][held] / pair["tau_h"][held]
    assert -pair["tau_g"][held] / pair["tau_l"][held] == pytest.approx(fraction, abs=1e-9)
    assert (abs(fraction) <= 1 + 1e-9).all()
    assert pair["tau_f"][held] - pair["tau_g"][held] == pytest.approx(
        single["tau_f"][held], abs=1e-5
    )
