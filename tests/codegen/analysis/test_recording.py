"""Runs compared with files and frames."""

from pathlib import Path

import numpy as np
import pytest
from oracles.slides import slide

import bondgraph as bg
from codegen import compare


@pytest.mark.parametrize("ending", ["csv", "netcdf", "parquet", "mat"])
def test_a_run_and_its_own_file_do_not_differ(ending: str, tmp_path: Path) -> None:
    pytest.importorskip({"netcdf": "xarray", "parquet": "pyarrow"}.get(ending, "numpy"))
    run, path = slide(), tmp_path / f"run.{'nc' if ending == 'netcdf' else ending}"
    getattr(run, f"write_{ending}")(path)
    found = compare({"run": run, "file": path})
    assert [(d.signal, d.run, d.largest) for d in found.differences] == [("v", "file", 0.0)]
    assert found.shifts == ()


def test_a_measured_speed_is_compared_along_straight_lines(tmp_path: Path) -> None:
    """3 - 1.5 t against 3 - 2 t, furthest apart when the second stops, at 1.5 s; events have no match."""
    path = tmp_path / "measured.csv"
    path.write_text("time,v,who\n0,3,a\n1.5,0,b\n4,0,c\n")
    for first, other in ((slide(), path), (path, slide())):
        found = compare([first, other], ["v"])
        (difference,) = found.differences
        assert difference.largest == pytest.approx(0.75, abs=1e-9)
        assert difference.time == pytest.approx(1.5)
        assert found.shifts == ()
        assert "v, 2" in str(found)
        assert len(found.plot().axes) == 1


def test_frames_are_compared_by_all_their_columns_where_they_come_first() -> None:
    frame = {"t": [0.0, 1.0], "a": [1.0, 2.0], "b": [0.0, 0.0]}
    found = compare({"one": frame, "other": {**frame, "b": [0.0, 0.5]}})
    assert [(d.signal, d.largest) for d in found.differences] == [("a", 0.0), ("b", 0.5)]
    pandas = pytest.importorskip("pandas")
    run = slide()
    assert compare([run, run.to_pandas()]).differences[0].largest == 0.0
    assert compare([run, pandas.DataFrame(frame).rename(columns={"a": "v"})]).signals == ("v",)


def test_what_files_lack_is_refused_by_name(tmp_path: Path) -> None:
    path = tmp_path / "measured.csv"
    path.write_text("t,w\n0,1\n1,2\n")
    with pytest.raises(bg.SignalError, match=r"measured\.csv has no column 'v'.*there are t, w"):
        compare([slide(), path])
    path.write_text("s,v\n0,1\n1,2\n")
    with pytest.raises(
        bg.SignalError, match=r"measured\.csv has no column 't' or 'time'; there are s, v"
    ):
        compare([slide(), path])
    with pytest.raises(bg.SignalError, match=r"has no column 't' or 'time' for time"):
        compare([path, slide()])
    path.write_text("t,v\n0,1\n2,2\n1,2\n")
    with pytest.raises(bg.SignalError, match=r"line 4, column 't': time must increase"):
        compare([slide(), path])


def test_recordings_cannot_be_changed() -> None:
    found = compare([{"t": np.array([0.0, 1.0]), "v": np.ones(2)}, {"t": [0, 1], "v": [1, 1]}])
    with pytest.raises(ValueError, match="read-only"):
        found.runs["1"]["v"][0] = 2.0
    with pytest.raises(KeyError, match="'w' is no column; there are v"):
        found.runs["1"]["w"]
