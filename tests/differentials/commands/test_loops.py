"""Closed loops by the command line: their names go wherever a scenario's does."""

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

import differentials
from differentials.loop_figures import LOOP_FIGURES, loop_panels

Call = Callable[..., Result]
Data = Callable[..., dict]


def test_list_names_the_manoeuvres(call: Call, data: Data) -> None:
    assert "step_steer, step_steer_open, ice, ice_open" in call("list").output
    rows = {row["name"]: row for row in data("list", "--json")["manoeuvres"]}
    assert rows["ice"]["engine_torque"] == 350
    assert rows["ice"]["own"]["alsd"] == {"k_t1": 10_000}


def test_simulate_takes_a_manoeuvre_and_what_changes_it(data: Data) -> None:
    found = data(
        "simulate", "alsd", "--scenario", "ice", "--set", "dw_ref=2", "--until", "2", "-o", "a.csv",
    )  # fmt: skip
    assert found["until"] == 2
    assert found["final"]["dw"] == pytest.approx(2, abs=1e-3)


def test_a_run_has_its_picture_and_table(call: Call) -> None:
    done = call("simulate", "stationary_tvd", "--scenario", "step_steer", "--out", "out")
    assert done.exit_code == 0, done.output
    assert Path("out/stationary_tvd_step_steer.png").read_bytes().startswith(b"\x89PNG")
    assert (
        "omega_ref" in Path("out/stationary_tvd_step_steer.csv").read_text("utf-8").splitlines()[0]
    )


def test_sweep_and_export_take_a_manoeuvre(call: Call, data: Data) -> None:
    runs = data(
        "sweep", "alsd", "--scenario", "ice", "--grid", "tau_max=200,400", "--largest", "asked",
        "--until", "0.6", "--workers", "0",
    )["runs"]  # fmt: skip
    assert [row["largest_asked"] for row in runs] == [200, 400]
    assert call("export", "alsd", "--to", "c", "--scenario", "ice", "--out", "c").exit_code == 0


def test_unknown_numbers_and_differentials_are_refused(call: Call) -> None:
    done = call("simulate", "alsd", "--scenario", "ice", "--set", "K_pp=1")
    assert done.exit_code == 2
    assert "did you mean 'K_p'" in done.stderr
    done = call("simulate", "passive", "--scenario", "ice")
    assert done.exit_code == 2
    assert "no clutch that moves torque" in done.stderr


def test_every_figure_shows_what_its_runs_have() -> None:
    for figure in LOOP_FIGURES.values():
        columns = [differentials.simulate(*run).columns for run in figure.runs]
        for panel in figure.panels:
            for curve in panel.curves:
                assert {curve.signal, curve.minus or curve.signal} <= set(columns[curve.run])


@pytest.mark.parametrize("manoeuvre", differentials.manoeuvres)
def test_every_run_has_what_its_panels_show(manoeuvre: str) -> None:
    chosen, case = differentials.catalog["alsd"], differentials.manoeuvres[manoeuvre]
    columns = differentials.simulate("alsd", manoeuvre).columns
    shown = {curve.signal for panel in loop_panels(chosen, case) for curve in panel.curves}
    assert shown <= set(columns)


def test_figures_draws_one_by_name(call: Call) -> None:
    done = call("figures", "ice", "--out", "figs")
    assert done.exit_code == 0, done.output
    names = {path.name for path in Path("figs").iterdir()}
    assert {"ice.png", "alsd_ice.csv", "four_wheel_drive_tvd_ice_open.csv"} <= names
