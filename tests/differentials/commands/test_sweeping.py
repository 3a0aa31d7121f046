"""Sweeps: grids, measures, what fails, what is kept."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import Result

import differentials
from differentials.commands.grids import grid

Call = Callable[..., Result]

Data = Callable[..., Any]
OSCILLATOR = (
    "sweep", "examples/oscillator.json", "--set", "m=2", "--set", "b=0", "--input", "F=0",
    "--workers", "0",
)  # fmt: skip


def test_a_grid_has_the_runs_numbers_and_measures(data: Data) -> None:
    found = data(
        "sweep", "alsd", "--grid", "k=4300:17200:3", "--peak", "tau_k1", "--first", "clutch:stick",
        "--count", "clutch:slip", "--workers", "0",
    )  # fmt: skip
    assert [run["k"] for run in found["runs"]] == [4300.0, 10750.0, 17200.0]
    assert found["failed"] == []
    expected = differentials.simulate("alsd", "fig11", {"k": 10750.0})
    run = found["runs"][1]
    assert run["peak_tau_k1"] == pytest.approx(abs(expected["tau_k1"]).max(), rel=1e-9)
    assert run["first_clutch_stick"] == pytest.approx(expected.events[0].time, abs=1e-9)
    assert run["count_clutch_slip"] == 1


def test_a_files_grid_gives_what_the_textbook_says(data: Data) -> None:
    """A mass that starts at v: the spring's largest force is v sqrt(k m)."""
    found = data(*OSCILLATOR, "--grid", "k=200:800:3", "--grid", "v=1,2", "--peak", "F_k")
    assert len(found["runs"]) == 6
    for run in found["runs"]:
        expected = run["v"] * math.sqrt(run["k"] * 2)
        assert run["peak_F_k"] == pytest.approx(expected, rel=1e-3)


def test_measures_of_signals(data: Data) -> None:
    """Over a whole swing of period 2 pi sqrt(m/k) = 0.31416 s the mass comes back to its start."""
    period = 2 * math.pi * math.sqrt(2 / 800)
    found = data(
        *OSCILLATOR, "--grid", "v=1", "--set", "k=800", "--until", str(period), "--final", "v",
        "--largest", "v", "--smallest", "v", "--integral", "v",
    )  # fmt: skip
    (run,) = found["runs"]
    assert run["final_v"] == pytest.approx(1, abs=1e-6)
    assert (run["largest_v"], run["smallest_v"]) == pytest.approx((1, -1), abs=1e-5)
    assert run["integral_v"] == pytest.approx(0, abs=1e-6)


def test_runs_that_fail_are_told_and_give_status_1(call: Call) -> None:
    done = call("sweep", "alsd", "--grid", "k=0,8600", "--final", "omega_1", "--workers", "0")
    assert done.exit_code == 1
    assert "8600" in done.stdout
    assert done.stderr.startswith("run 0 (k = 0) failed: ")
    assert len(done.stderr.splitlines()) == 1


def test_tables_are_written(call: Call, tmp_path: Path) -> None:
    arguments = (*OSCILLATOR, "--grid", "k=200,800", "--initial", "v=1", "--peak", "F_k")
    assert call(*arguments, "-o", "new/sweep.csv").exit_code == 0
    found = np.genfromtxt(tmp_path / "new" / "sweep.csv", delimiter=",", names=True)
    assert found["k"].tolist() == [200.0, 800.0]
    assert found["peak_F_k"] == pytest.approx([20, 40], rel=1e-3)
    xarray = pytest.importorskip("xarray")
    assert call(*arguments, "-o", "sweep.nc").exit_code == 0
    with xarray.open_dataset(tmp_path / "sweep.nc", engine="scipy") as dataset:
        assert dataset.peak_F_k.sel(k=800).item() == found["peak_F_k"][1]


def test_a_store_keeps_what_is_done(call: Call, tmp_path: Path) -> None:
    arguments = (*OSCILLATOR, "--grid", "k=200,800", "--final", "v", "--store", "runs")
    first = call(*arguments).stdout
    assert any((tmp_path / "runs").iterdir())
    assert call(*arguments).stdout == first
    other = call(*arguments, "--initial", "v=1")
    assert other.exit_code == 2
    assert len(other.stderr.splitlines()) == 1


def test_grids_are_spaced_as_they_say() -> None:
    assert grid("0:1:5") == [0, 0.25, 0.5, 0.75, 1]
    assert grid("1:1000:4:log") == pytest.approx([1, 10, 100, 1000])
    assert grid("3") == [3]


@pytest.mark.parametrize(
    "text", ["", "a", "1:2", "1:2:0", "1:2:x", "1:2:3:lin", "1,,2", "1:2:3:log:4"]
)
def test_what_is_no_grid_is_refused(text: str) -> None:
    with pytest.raises(ValueError):  # noqa: PT011 - its text is never shown
        grid(text)
