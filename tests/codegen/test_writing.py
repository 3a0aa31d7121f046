"""Every writer writes beside and replaces: what fails leaves what was there, and names the path."""

import os
import stat
from collections.abc import Callable
from pathlib import Path

import networkx as nx
import numpy as np
import pytest
from oracles.models import series_circuit
from oracles.sweeping import TIMES, spring_mass

import bondgraph as bg
import codegen
from bondgraph.writing import (
    growing,
    made_folder,
    partial_of,
    replacing,
    write_all,
    write_bytes,
    write_text,
)
from differentials.figures import save_picture

pytestmark = pytest.mark.usefixtures("compiled_quickly")


def _graph() -> nx.DiGraph:
    return series_circuit()


def _run() -> codegen.Result:
    return spring_mass().simulator().run(TIMES, {"v": 1.0}, {"P": 0.0})


WRITERS: dict[str, Callable[[Path], object]] = {
    "a.csv": lambda path: _run().write_csv(path),
    "a.nc": lambda path: _run().write_netcdf(path),
    "a.mat": lambda path: _run().write_mat(path),
    "a.parquet": lambda path: pytest.importorskip("pyarrow") and _run().write_parquet(path),
    "a.fmu": lambda path: codegen.write_fmu(path, bg.derive(_graph()), {"R": 1, "L": 1, "C": 1}),
    "a.json": lambda path: bg.write_json(_graph(), path),
    "a.graphml": lambda path: bg.write_graphml(_graph(), path),
    "a.svg": lambda path: bg.drawing(_graph()).save(path),
    "a.png": lambda path: bg.drawing(_graph()).save(path),
    "a.pdf": lambda path: bg.drawing(_graph()).save(path),
    "b.png": lambda path: save_picture(_run().plot(), path),
    "a.txt": lambda path: write_text(path, "new"),
    "a.bin": lambda path: write_all({path.with_suffix(".py"): "new", path: "new"}),
}


@pytest.mark.parametrize("name", WRITERS)
def test_a_full_disk_leaves_what_was_there(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A full disk shows when bytes are flushed to it; a folder in the way when the file is moved."""
    path = tmp_path / name
    path.write_bytes(b"old")

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", full)
        with pytest.raises(bg.WriteError, match=rf"{name} cannot be written: No space left"):
            WRITERS[name](path)
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]
    WRITERS[name](path)
    assert path.read_bytes() not in (b"old", b"")
    assert [one for one in tmp_path.iterdir() if one.suffix == ".tmp"] == []


@pytest.mark.parametrize("name", WRITERS)
def test_a_folder_in_the_way_is_told(name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    path.mkdir()
    with pytest.raises(bg.WriteError, match=rf"{name} cannot be written: it is a folder"):
        WRITERS[name](path)
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
@pytest.mark.parametrize("name", ["a.csv", "a.nc", "a.fmu", "b.png", "a.json"])
def test_a_device_that_is_full(name: str, tmp_path: Path) -> None:
    """What is no file is written to as it is: a stream of this process, a pipe, here a full device."""
    link = tmp_path / name
    link.symlink_to("/dev/full")
    with pytest.raises(bg.WriteError, match=rf"{name} cannot be written: No space left"):
        WRITERS[name](link)
    assert link.is_symlink()


def test_a_folder_that_is_missing_or_cannot_be_made(tmp_path: Path) -> None:
    with pytest.raises(bg.WriteError, match=r"none/a.txt cannot be written: No such file"):
        write_text(tmp_path / "none" / "a.txt", "new")
    (tmp_path / "file").write_bytes(b"old")
    with pytest.raises(bg.WriteError, match=r"file/deep cannot be written: Not a directory"):
        made_folder(tmp_path / "file" / "deep")
    with pytest.raises(OSError, match="cannot be written"):
        made_folder(tmp_path / "file" / "deep")


def test_what_fails_while_it_is_written_leaves_what_was_there(tmp_path: Path) -> None:
    path = tmp_path / "a"
    path.write_bytes(b"old")

    def interrupted() -> None:
        with replacing(path) as file:
            file.write(b"half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_what_grows_is_partial_until_it_is_whole(tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    path.write_bytes(b"old")
    path.chmod(0o640)
    with growing(path) as file:
        file.write(b"new")
        file.flush()
        assert path.read_bytes() == b"old"
        assert partial_of(path).read_bytes() == b"new"
    assert path.read_bytes() == b"new"
    assert stat.S_IMODE(path.stat().st_mode) == 0o640
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("error", [KeyboardInterrupt, OSError(28, "No space left on device")])
def test_what_ends_halfway_stays_partial_and_is_told(
    error: type[BaseException] | BaseException, tmp_path: Path
) -> None:
    path = tmp_path / "run.csv"
    path.write_bytes(b"old")

    def ending(text: bytes) -> None:
        with growing(path) as file:
            file.write(text)
            raise error

    with pytest.raises((KeyboardInterrupt, bg.WriteError)) as told:
        ending(b"half")
    assert path.read_bytes() == b"old"
    assert partial_of(path).read_bytes() == b"half"
    first = told.value if isinstance(told.value, KeyboardInterrupt) else told.value.__cause__
    assert first is not None
    assert first.__notes__ == [f"what was written before that is in {partial_of(path)}"]
    with pytest.raises((KeyboardInterrupt, bg.WriteError)):
        ending(b"")
    assert list(tmp_path.iterdir()) == [path]


def test_only_a_file_grows(tmp_path: Path) -> None:
    def grow(path: Path) -> None:
        with growing(path):
            pass

    with pytest.raises(bg.WriteError, match="null cannot be written: it is no file on a disk"):
        grow(Path(os.devnull))
    with pytest.raises(bg.WriteError, match="cannot be written: it is a folder"):
        grow(tmp_path)
    link = tmp_path / "link.csv"
    link.symlink_to(tmp_path / "run.csv")
    grow(link)
    assert link.is_symlink()
    assert (tmp_path / "run.csv").exists()


def test_of_several_files_none_is_replaced_before_all_are_written(tmp_path: Path) -> None:
    one, other = tmp_path / "one", tmp_path / "other"
    one.write_bytes(b"old")
    other.mkdir()
    with pytest.raises(bg.WriteError, match="other cannot be written"):
        write_all({one: "new", other: "new"})
    assert one.read_bytes() == b"old"


def test_rights_and_links_stay(tmp_path: Path) -> None:
    path, link = tmp_path / "a", tmp_path / "link"
    path.write_bytes(b"old")
    path.chmod(0o640)
    link.symlink_to(path)
    write_bytes(link, b"new")
    assert path.read_bytes() == b"new"
    assert stat.S_IMODE(path.stat().st_mode) == 0o640
    assert link.is_symlink()


def test_digits_of_a_table_are_those_of_the_run(tmp_path: Path) -> None:
    run = _run()
    run.write_csv(tmp_path / "a.csv")
    head, *rows = (tmp_path / "a.csv").read_text(encoding="utf-8").splitlines()
    assert head.split(",") == ["t", *run]
    table = np.array([[float(one) for one in row.split(",")] for row in rows])
    assert np.array_equal(table, np.column_stack([run.time, *run.columns.values()]))
