"""Runs as parquet and MAT, read back by the packages that these files are for."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from oracles.slides import slide, swing
from scipy.io import loadmat

import bondgraph as bg
from codegen import Event
from codegen.data.columns import read_columns


def test_parquet_is_read_back_digit_for_digit(tmp_path: Path) -> None:
    pandas, arrow = pytest.importorskip("pandas"), pytest.importorskip("pyarrow.parquet")
    run = replace(slide(), events=(Event(0.25, "ä b", "stick"), Event(1 / 3, ("x", 2), "slip")))
    run.write_parquet(tmp_path / "run.parquet")
    found = pandas.read_parquet(tmp_path / "run.parquet")
    assert list(found.columns) == ["t", *run]
    assert (found["t"].to_numpy() == run.time).all()
    for name in run:
        assert (found[name].to_numpy() == run[name]).all(), name
    schema = arrow.read_schema(tmp_path / "run.parquet")
    assert schema.field("v").metadata == {b"unit": b"m/s"}
    assert schema.field("t").metadata == {b"unit": b"s"}
    told = json.loads(schema.metadata[b"events"])
    assert told == [[0.25, "ä b", "stick"], [1 / 3, "('x', 2)", "slip"]]


def test_mat_is_read_back_digit_for_digit(tmp_path: Path) -> None:
    run = slide()
    run.write_mat(tmp_path / "run.mat")
    found = loadmat(tmp_path / "run.mat")
    assert found["t"].shape == (41, 1)
    assert (found["t"][:, 0] == run.time).all()
    for name in run:
        assert (found[name][:, 0] == run[name]).all(), name
    assert found["event_time"][:, 0] == pytest.approx([2.0])
    assert [one.item() for one in found["event_port"].ravel()] == ["rub"]
    assert [one.item() for one in found["event_kind"].ravel()] == ["stick"]
    rows = [[str(cell.item()) if cell.size else "" for cell in row] for row in found["signals"]]
    assert rows[:2] == [["t", "t", "s"], ["v", "v", "m/s"]]


def test_names_that_matlab_has_not_are_told_in_signals(tmp_path: Path) -> None:
    run = swing(speed="ω_1", force="end")
    run.write_mat(tmp_path / "run.mat")
    found = loadmat(tmp_path / "run.mat", squeeze_me=True)
    assert (found["omega_1"] == run["ω_1"]).all()
    assert (found["end_"] == run["end"]).all()
    again = read_columns(tmp_path / "run.mat", ("t", "ω_1", "end"))
    assert (again.arrays[1] == run["ω_1"]).all()
    assert (again.arrays[2] == run["end"]).all()


def test_a_name_too_long_for_matlab_is_refused(tmp_path: Path) -> None:
    run = swing(speed="v" * 64)
    with pytest.raises(bg.SignalError, match="more than 63 characters in MATLAB; rename it"):
        run.write_mat(tmp_path / "run.mat")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("ending", ["mat", "parquet"])
def test_the_same_run_gives_the_same_bytes(ending: str, tmp_path: Path) -> None:
    if ending == "parquet":
        pytest.importorskip("pyarrow")
    for name in ("one", "other"):
        getattr(slide(), f"write_{ending}")(tmp_path / name)
    one, other = ((tmp_path / name).read_bytes() for name in ("one", "other"))
    assert one == other
    assert b"Created on" not in one


def test_no_events_are_no_rows(tmp_path: Path) -> None:
    swing().write_mat(tmp_path / "run.mat")
    assert loadmat(tmp_path / "run.mat")["event_time"].size == 0


def test_missing_packages_are_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("codegen.record.files.find_spec", lambda name: None)
    with pytest.raises(bg.MissingExtraError, match=r"pyarrow.*bondgraph-toolkit\[tables\]"):
        slide().write_parquet(tmp_path / "run.parquet")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("ending", ["csv", "nc", "parquet", "mat"])
def test_what_a_run_wrote_is_an_input_again(ending: str, tmp_path: Path) -> None:
    pytest.importorskip({"nc": "xarray", "parquet": "pyarrow"}.get(ending, "numpy"))
    run, path = slide(), tmp_path / f"run.{ending}"
    {"nc": run.write_netcdf, "csv": run.write_csv, "parquet": run.write_parquet,
     "mat": run.write_mat}[ending](path)  # fmt: skip
    found = read_columns(path, ("time" if ending == "nc" else "t", "v"))
    assert np.array_equal(found.arrays, [run.time, run["v"]])
