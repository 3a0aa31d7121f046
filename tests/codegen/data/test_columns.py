"""Columns of files and frames: the numbers themselves, and refusals that name file, line and column."""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.io import savemat

import bondgraph as bg
from codegen.data.columns import read_columns

T, V = np.array([0.0, 0.1, 0.25]), np.array([1.0, -2.5e-300, 1 / 3])


def _csv(path: Path) -> object:
    rows = zip(T.tolist(), ("a", "b", "c"), V.tolist(), strict=True)
    path.write_text("t,what,v\n" + "".join(f"{t!r},{w},{v!r}\n" for t, w, v in rows))
    return path


def _parquet(path: Path) -> object:
    arrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    parquet.write_table(arrow.table({"t": T, "what": ["a", "b", "c"], "v": V}), path)
    return path


def _mat(path: Path) -> object:
    savemat(path, {"t": T, "v": V, "what": "abc"})
    return path


def _netcdf(path: Path) -> object:
    _dataset(path).to_netcdf(path)  # type: ignore[attr-defined]
    return path


def _dataset(path: Path) -> object:
    return pytest.importorskip("xarray").Dataset({"v": ("t", V)}, {"t": T})


def _frame(path: Path) -> object:
    return pytest.importorskip("pandas").DataFrame({"t": T, "what": ["a", "b", "c"], "v": V})


def _indexed(path: Path) -> object:
    return _frame(path).set_index("t")  # type: ignore[attr-defined]


def _arrow(path: Path) -> object:
    return pytest.importorskip("pyarrow").table({"t": T, "v": V})


def _records(path: Path) -> object:
    rows = np.zeros(3, dtype=[("t", float), ("v", float)])
    rows["t"], rows["v"] = T, V
    return rows


SOURCES = {
    "a.csv": _csv, "a.parquet": _parquet, "a.mat": _mat, "a.nc": _netcdf, "frame": _frame,
    "indexed": _indexed, "dataset": _dataset, "arrow": _arrow, "records": _records,
    "mapping": lambda path: {"v": V.tolist(), "t": T},
}  # fmt: skip


@pytest.mark.parametrize("name", SOURCES)
def test_columns_come_digit_for_digit(name: str, tmp_path: Path) -> None:
    source = SOURCES[name](tmp_path / name)
    found = read_columns(source, ("t", "v"))
    assert [one.tolist() for one in found.arrays] == [T.tolist(), V.tolist()]


@pytest.mark.parametrize("name", SOURCES)
def test_a_column_that_there_is_not_is_refused_with_those_there_are(
    name: str, tmp_path: Path
) -> None:
    source = SOURCES[name](tmp_path / name)
    with pytest.raises(bg.SignalError, match=r"has no column 'V'; there are .*v"):
        read_columns(source, ("t", "V"))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("t,v\n0,1\n1,2\n", [[0, 1], [1, 2]]),
        ("t;v\r\n0;1\r\n\r\n1;2\r\n", [[0, 1], [1, 2]]),
        ("\ufefft\tv\n0\t1\n1\t2", [[0, 1], [1, 2]]),
        ('"t", "v"\n 0 , 1\n 1 , 2e0\n', [[0, 1], [1, 2]]),
        ("v,t\n1,0\n2,1\n", [[0, 1], [1, 2]]),
    ],
)
def test_files_of_text_as_others_write_them(
    text: str, expected: list[list[float]], tmp_path: Path
) -> None:
    path = tmp_path / "a.csv"
    path.write_bytes(text.encode())
    assert [one.tolist() for one in read_columns(path, ("t", "v")).arrays] == expected


def test_columns_of_text_are_told_by_numbers_too(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text("0,1,5\n1,2,6\n")
    assert [one.tolist() for one in read_columns(path, (1, "3")).arrays] == [[0, 1], [5, 6]]
    path.write_text("t,2\n0,7\n")
    assert read_columns(path, ("2",)).arrays[0].tolist() == [7]
    with pytest.raises(bg.SignalError, match=r"a\.txt has no column 3; there are t, 2"):
        read_columns(path, (3,))


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("t,v\n0,1\n1,x\n", r"a\.csv, line 3, column 'v': 'x' is not a number$"),
        ("t;v\n0;1\n1;2,5\n", r"line 3, column 'v': '2,5' is not a number; write decimals with a"),
        ("t,v\n0,1\n1,\n", r"a\.csv, line 3, column 'v': an empty cell; fill the gap"),
        ("t,v\n\n0,1\n1,nan\n", r"a\.csv, line 4, column 'v': nan is not a finite number"),
        ("t,v\n0,1\n1\n", r"a\.csv, line 3: 1 column\(s\), but the first line has 2"),
        ("t,v,v\n0,1,2\n", r"a\.csv, line 1: two columns are called 'v'; rename one"),
        ('t,v\n0,"1\n', r"a\.csv, line 2: not CSV"),
        ("", r"a\.csv is empty"),
    ],
)
def test_refusals_of_text_name_line_and_column(text: str, told: str, tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text(text)
    with pytest.raises(bg.SignalError, match=told):
        read_columns(path, ("t", "v"))


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ([0.0, float("inf")], r"row 2, column 'v': inf is not a finite number"),
        ([0.0, None], r"row 2, column 'v': an empty cell"),
        (["a", "b"], r"row 1, column 'v': 'a' is not a number"),
        ([True, False], r"row 1, column 'v': True is not a number"),
        ([[0.0, 1.0], [2.0, 3.0]], r"column 'v' has the shape \(2, 2\)"),
        ([0.0], r"columns of different lengths, 1, 2|columns of different lengths, 2, 1"),
        (np.array(["2020-01-01", "2020-01-02"], dtype="M8[s]"), r"'v' holds dates .* give seconds"),
    ],
)
def test_refusals_of_frames_name_row_and_column(values: Any, told: str) -> None:
    with pytest.raises(bg.SignalError, match=told):
        read_columns({"t": [0, 1], "v": values}, ("t", "v"))


def test_files_that_cannot_be_read_are_named(tmp_path: Path) -> None:
    with pytest.raises(bg.SignalError, match=r"none\.csv cannot be read: No such file"):
        read_columns(tmp_path / "none.csv")
    with pytest.raises(bg.SignalError, match=r"a\.xls' must end in \.csv, \.tsv, .* or \.nc"):
        read_columns("a.xls")
    with pytest.raises(bg.SignalError, match=r"neither a path nor a frame"):
        read_columns(7)
    for name, told in (("a.csv", "not text in UTF-8"), ("a.mat", "is no MAT file")):
        (tmp_path / name).write_bytes(b"\xff\xfe\x00\x01" * 100)
        with pytest.raises(bg.SignalError, match=rf"{name} {told}|{told}"):
            read_columns(tmp_path / name)


def test_parquet_files_that_are_none_are_named(tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    (tmp_path / "a.parquet").write_bytes(b"no")
    with pytest.raises(bg.SignalError, match=r"a\.parquet is no parquet file"):
        read_columns(tmp_path / "a.parquet", ("t",))


def test_missing_packages_are_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("codegen.data.columns.find_spec", lambda name: None)
    for name, package in (("a.parquet", "pyarrow"), ("a.nc", "xarray")):
        (tmp_path / name).write_bytes(b"")
        with pytest.raises(bg.MissingExtraError, match=rf"{package}.*bondgraph-toolkit\[tables\]"):
            read_columns(tmp_path / name)


def test_frames_need_no_package(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("pandas", "xarray", "pyarrow"):
        monkeypatch.setitem(sys.modules, name, None)
    assert read_columns({"t": [0]}).arrays[0].tolist() == [0.0]
