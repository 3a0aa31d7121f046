"""Compiled code reads nothing that was not set and nothing beside its rooms, whatever size is zero."""

import zipfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from oracles.c_model import compiled, written
from oracles.edge_runs import check_runs, check_sweeps
from oracles.edges import EDGES, every
from oracles.memcheck import check_program, check_script, complaints
from soak.families import whole

from codegen import to_c
from codegen.batch import engine as batch_engine
from codegen.batch import located as batch_located
from codegen.c.runtime import runtime_file
from codegen.engine import located, runs, sizes

ALL = whole("memory")
"""Whether every small model and textbook case is run, not the few that have sizes of zero."""

CASES = every()
EXPORTED = tuple(CASES) if ALL else ("brake", "constant")
RUN = tuple(CASES) if ALL else ("brake", "rubbing")
UNITS = tuple(CASES) if ALL else ("wound_brake",)
ORACLES = Path(__file__).parents[1] / "oracles"


def test_edges_are_among_what_is_run() -> None:
    assert {*EXPORTED, *RUN, *UNITS} <= set(CASES)
    assert set(EDGES) <= set(CASES)


@pytest.mark.parametrize("name", EXPORTED)
def test_exported_c_is_clean(name: str, tmp_path: Path) -> None:
    """Located runs by every method with one sample, two and more; fixed steps; the affine map."""
    case = CASES[name]()
    given = {"initial": case.initial, "inputs": case.inputs}
    files = to_c(case.equations, case.parameters, case.laws, main=True, **given)
    program = compiled(tmp_path / "main", written(tmp_path / "main", files), "-O0", "-g")
    for how in ([], ["located"]):
        check_program([str(program), repr(case.end / 100), repr(case.end / 300), "step=1e-5", *how])
    del files["main.c"]
    files |= {name: runtime_file(name) for name in ("located_rows.h", "located_rows.c")}
    sources = [*written(tmp_path, files), str(ORACLES / "memory.c")]
    printed = check_program([str(compiled(tmp_path, sources, "-O0", "-g")), repr(case.end)])
    assert printed.count("no failure") >= 9


@pytest.mark.parametrize("name", UNITS)
@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_units_are_clean(name: str, version: str, tmp_path: Path, compiled_quickly: None) -> None:
    """Model exchange and co-simulation, every variable, saved states, slopes."""
    case = CASES[name]()
    with zipfile.ZipFile(case.written(tmp_path / "unit.fmu", version)) as archive:
        files = {
            one.removeprefix("sources/"): archive.read(one).decode()
            for one in archive.namelist()
            if one.endswith((".c", ".h"))
        }
    sources = [*written(tmp_path, files), str(ORACLES / "unit.c")]
    program = compiled(tmp_path, sources, "-O0", "-g", f"-DFMI_{version[0]}")
    check_program([str(program), repr(case.end)])


def _spoilt(*shape: int) -> np.ndarray:
    """Room in which every number is none, as `aligned` gives it."""
    room = _aligned(*shape)
    room[...] = np.nan
    return room


_aligned = sizes.aligned


@pytest.fixture
def spoilt(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Whatever the C core is given to work in, and what it puts on its stack, begins as rubbish."""
    monkeypatch.setenv("CFLAGS", "-O0 -ftrivial-auto-var-init=pattern")
    for module in (runs, located, batch_engine, batch_located):
        monkeypatch.setattr(module, "aligned", _spoilt)
    sizes.engine.cache_clear()
    yield
    sizes.engine.cache_clear()


@pytest.mark.parametrize("name", RUN)
def test_rubbish_in_rooms_and_on_the_stack_changes_nothing(name: str, spoilt: None) -> None:
    """The exact engine, the one that locates events, and both loops of sweeps."""
    case = CASES[name]()
    check_runs(case)
    assert check_sweeps(case) in ((0, 6) if ALL else (6 if name == "rubbing" else 0,))


SCRIPT = """
from oracles.edge_runs import check_runs, check_sweeps
from oracles.edges import every
for name, make in every().items():
    check_runs(make())
    check_sweeps(make())
print("run")
"""


@pytest.mark.most(40_000)
@pytest.mark.skipif(not ALL, reason="takes an hour: BONDGRAPH_SOAK_MEMORY=1 asks for it")
def test_engines_are_clean_under_valgrind(tmp_path: Path) -> None:
    """The whole C core as Python calls it, over every small model and textbook case."""
    assert check_script(SCRIPT, tmp_path).endswith("run\n")


def test_a_complaint_about_a_library_is_told_from_others() -> None:
    log = (
        "==1== \n==1== Conditional jump\n==1==    at 0x1: largest (located_rates.c:155)\n"
        "==1== \n==1== Invalid read\n==1==    at 0x2: is_dst (dl-load.c:216)\n"
        "==1== \n==1== Use of uninitialised value\n==1==    at 0x3: ??? (in /cache/abc.so)\n"
    )
    assert len(complaints(log, "/cache")) == 2
