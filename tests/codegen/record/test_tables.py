"""Runs as data sets, data frames and files."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from oracles.slides import slide, swing

import bondgraph as bg
from codegen import Event

xarray = pytest.importorskip("xarray")


def test_a_data_set_has_every_column_over_time_with_units_and_roles() -> None:
    run = slide()
    table = run.to_xarray()
    assert list(table.data_vars) == list(run)
    assert table["v"].dims == ("time",)
    assert table["v"].values == pytest.approx(np.maximum(3 - 1.5 * run.time, 0), abs=1e-9)
    assert table["v"].attrs == {"role": "state", "units": "m/s"}
    assert table["time"].attrs == {"units": "s"}
    assert float(table["v"].sel(time=1.0)) == pytest.approx(1.5)
    assert swing().to_xarray()["P"].attrs == {"role": "input", "units": "N"}


def test_events_lie_along_an_axis_of_their_own() -> None:
    table = slide().to_xarray()
    assert table["event_time"].values == pytest.approx([2.0])
    assert table["event_port"].values.tolist() == ["rub"]
    assert table["event_kind"].values.tolist() == ["stick"]
    assert dict(swing().to_xarray().sizes) == {"time": 2001, "event": 0}


def test_signals_keep_names_that_axes_have() -> None:
    run = swing(force="time", speed="event")
    table = run.to_xarray()
    assert dict(table.sizes) == {"time_": 2001, "event_": 0}
    assert (table["time"].values == run["time"]).all()
    assert run.to_pandas().index.name == "time_"


def test_columns_of_tables_are_not_the_runs_own() -> None:
    run = slide()
    frame = run.to_pandas()
    frame.loc[:, "v"] = 7.0
    run.to_xarray()["v"].values[:] = 7.0
    assert run["v"][0] == 3.0


def test_a_data_frame_has_a_row_for_each_sample() -> None:
    run = slide()
    frame = run.to_pandas()
    assert frame.index.name == "time"
    assert list(frame.columns) == list(run)
    assert (frame.index.to_numpy() == run.time).all()
    assert frame.loc[1.0, "v"] == pytest.approx(1.5)


@pytest.mark.parametrize(
    "events", [(), (Event(0.25, "ä b", "stick"), Event(1 / 3, ("x", 2), "slip"))]
)
def test_netcdf_is_read_back_digit_for_digit(tmp_path: Path, events: tuple[Event, ...]) -> None:
    run = replace(slide(), events=events)
    run.write_netcdf(tmp_path / "run.nc")
    with xarray.open_dataset(tmp_path / "run.nc") as found:
        assert (found["time"].values == run.time).all()
        for name in run:
            assert (found[name].values == run[name]).all(), name
        assert found["v"].attrs["units"] == "m/s"
        assert found["event_time"].values.tolist() == [event.time for event in events]
        assert found["event_port"].values.tolist() == [str(event.port) for event in events]
        assert found["event_kind"].values.tolist() == [event.kind for event in events]


def test_netcdf_is_the_same_bytes_every_time(tmp_path: Path) -> None:
    for name in ("one.nc", "other.nc"):
        slide().write_netcdf(tmp_path / name)
    one, other = ((tmp_path / name).read_bytes() for name in ("one.nc", "other.nc"))
    assert one == other


def test_netcdf_keeps_greek_names(tmp_path: Path) -> None:
    run = swing(speed="ω_1")
    run.write_netcdf(tmp_path / "run.nc")
    with xarray.open_dataset(tmp_path / "run.nc") as found:
        assert (found["ω_1"].values == run["ω_1"]).all()


def test_csv_is_read_back_digit_for_digit(tmp_path: Path) -> None:
    run = slide()
    run.write_csv(tmp_path / "run.csv")
    found = np.genfromtxt(tmp_path / "run.csv", delimiter=",", names=True)
    assert (found["t"] == run.time).all()
    assert (found["v"] == run["v"]).all()


def test_missing_packages_are_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    run = slide()
    with monkeypatch.context() as patch:
        patch.setattr("codegen.record.tables.find_spec", lambda name: None)
        with pytest.raises(bg.MissingExtraError, match=r"h5netcdf.*bondgraph-toolkit\[tables\]"):
            run.write_netcdf(tmp_path / "run.nc")
    for name in ("xarray", "pandas"):
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(bg.MissingExtraError, match=r"xarray.*bondgraph-toolkit\[tables\]"):
        run.to_xarray()
    with pytest.raises(bg.MissingExtraError, match=r"xarray.*bondgraph-toolkit\[tables\]"):
        run.write_netcdf(tmp_path / "run.nc")
    with pytest.raises(bg.MissingExtraError, match=r"pandas.*bondgraph-toolkit\[tables\]"):
        run.to_pandas()
    assert not list(tmp_path.iterdir())
