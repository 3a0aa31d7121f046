"""What results list and offer of nodes of signals is what was declared; parts are given where asked for."""

import csv
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bondgraph as bg
import codegen

NUMBERS = {"J": 0.5, "b": 0.2, "K": 2.0}


def _motor(*nodes: Any) -> bg.BondGraph:
    motor = [bg.Se("motor", "1*tau"), bg.One("shaft"), bg.I("J", "J", flow="omega"), bg.R("b", "b")]
    return bg.graph([*motor, *nodes], "motor > shaft > J, shaft > b")


EVERY = _motor(
    bg.Function("tau", "K*(r - omega) + z + relay + u"), bg.State("z", "r - omega", low=-1, high="1/10"),
    bg.State("x", "omega"), bg.Hysteresis("relay", "x", 1, 2), bg.RateLimiter("r", "3 + t", 2, falling=1),
    bg.Controller("c", every="1/10", states={"n": 0}, update={"n": "n + 1"}, gives={"u": "n*x"}),
)  # fmt: skip
"""One of each kind."""

DECLARED = {"omega", "tau", "z", "x", "relay", "r", "n", "u"}
MORE = {"e_motor", "f_motor", "rate_z"}
"""Of the bond graph, and the rate that equations name."""

PARTS = (
    "f_tau",
    "e_x",
    "f_z",
    "e_z_low",
    "f_relay_switch",
    "e_r_clutch",
    "e_c_n",
    "z.low",
    "relay.switch",
)


@pytest.fixture(scope="module")
def run() -> codegen.Result:
    return codegen.simulator(bg.derive(EVERY), NUMBERS).run(np.linspace(0, 1, 6))


def test_tables_hold_what_was_declared(run: codegen.Result, tmp_path: Path) -> None:
    assert {*run} == DECLARED | MORE
    assert [*run] == [*run.columns]
    run.write_csv(tmp_path / "run.csv")
    with (tmp_path / "run.csv").open() as file:
        assert set(next(csv.reader(file))) == DECLARED | MORE | {"t"}


def test_completion_offers_no_parts(run: codegen.Result) -> None:
    offered = run._ipython_key_completions_()
    assert {*offered} >= DECLARED | MORE | {"e_J", "f_b", "p_J"}
    assert not {*offered} & {*PARTS, *run.inner, "p_r_mass", "e_z_position", "f_r"}
    html = run._repr_html_()
    assert not [name for name in (*PARTS, *run.inner) if f" {name}," in html]


def test_parts_are_read_by_name(run: codegen.Result) -> None:
    """z rests at its bounds while r - omega leads beyond; else it goes at that rate."""
    assert {*PARTS} <= {*run.inner} | {*map(str, run.observer.model.equations.signals)}
    for name in PARTS:
        assert run[name].shape == run.time.shape
    assert np.allclose(run["f_tau"], 0)
    assert np.allclose(run["e_x"], run["omega"])
    assert {*run["relay.switch"]} <= {0.0, 1.0}
    touching = (run["z"] >= 0.1 - 1e-9) | (run["z"] <= -1 + 1e-9)
    assert touching.any()
    assert np.allclose(run["f_z"][touching], 0)
    assert np.allclose(run["f_z"][~touching], run["rate_z"][~touching])


def test_what_is_unknown_is_answered_with_what_is_declared(run: codegen.Result) -> None:
    with pytest.raises(KeyError) as error:
        run["relais"]
    assert "relay" in str(error.value)
    assert not any(f" {name}," in str(error.value) for name in PARTS)


def test_steppers_list_the_same(run: codegen.Result) -> None:
    stepper = codegen.simulator(bg.derive(EVERY), NUMBERS).stepper()
    found = stepper.advance(0.05)
    assert {*found} == DECLARED | MORE
    assert found["f_tau"] == 0


def test_runs_of_sweeps_list_the_same() -> None:
    graph = _motor(bg.Function("tau", "K*(1 - omega)"), bg.State("x", "omega"))
    told = codegen.simulator(bg.derive(graph), NUMBERS).run([0, 1])
    assert {*told} == {"omega", "x", "tau", "e_motor", "f_motor"}
    assert np.allclose(told["e_x"], told["omega"])
