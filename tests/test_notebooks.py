"""Every notebook runs from clean, and is stored with what such a run shows.

``pytest tests/test_notebooks.py --update-golden`` stores what runs show now.
"""

import os
import re
from collections.abc import Iterator
from pathlib import Path

import nbformat
import pytest
from jupyter_client import KernelManager
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError
from nbformat import NotebookNode
from nbformat.v4 import new_code_cell, new_notebook
from references.shown import differences, kept

ROOT = Path(__file__).parents[1]
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))
LONGEST = 15
"""Lines of a cell of code: what is longer belongs into the package."""

every = pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)


def read(path: Path) -> NotebookNode:
    return nbformat.read(path, as_version=4)


def code(notebook: NotebookNode) -> list[NotebookNode]:
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def test_there_are_notebooks() -> None:
    assert [path.stem[:2] for path in NOTEBOOKS] == [f"{n:02}" for n in range(1, 9)]


BEGIN = """__import__('gc').freeze()
%reset -f
__import__('warnings').filterwarnings('default', 'no such warning')
__import__('os').chdir({!r})
_gathering = __import__('references.gathered').gathered.gathered()
_derived = _gathering.__enter__()
"""
"""No names, an empty folder, and warnings that were shown are shown again, as filters have changed.

What is imported stays, and need not be searched for garbage each time.
"""

END = """_gathering.__exit__(None, None, None)
_misfits = __import__('oracles.stated').stated.misfits_somewhere
assert _derived or not {!r}
assert [text for one in _derived for text in _misfits(one)] == []
"""
"""What is shown of equations is what the simulator computes, as `rig/walked.py` has it of guides."""


@pytest.fixture(scope="module")
def kernel(tmp_path_factory: pytest.TempPathFactory) -> Iterator[KernelManager]:
    """One process for all notebooks: to start it and to import takes as long as what most of them do."""
    manager = KernelManager(kernel_name="python3")
    with pytest.MonkeyPatch.context() as patch:
        places = [ROOT, ROOT / "tests", ROOT / "tests" / "codegen"]
        patch.setenv("PYTHONPATH", os.pathsep.join(map(str, places)))
        patch.setenv("IPYTHONDIR", str(tmp_path_factory.mktemp("ipython")))
        manager.start_kernel()
    yield manager
    manager.shutdown_kernel(now=True)
    manager.cleanup_resources()


def run(notebook: NotebookNode, kernel: KernelManager, folder: Path, graphs: bool = False) -> None:
    """From clean: without a name of those that ran before; ``graphs``: whether some have to be derived."""
    cells = [new_code_cell(BEGIN.format(str(folder))), *notebook.cells]
    cells += [new_code_cell(END.format(graphs))]
    client = NotebookClient(new_notebook(cells=cells), timeout=None, km=kernel, record_timing=False)
    try:
        client.execute()
    finally:
        client.kc.stop_channels()


@every
def test_shows_what_is_stored(
    path: Path, kernel: KernelManager, tmp_path: Path, update_golden: bool
) -> None:
    """Texts, formulas and drawings of a run are those in the file; other pictures are there."""
    notebook, stored = read(path), read(path)
    run(notebook, kernel, tmp_path, graphs=True)
    for count, cell in enumerate(code(notebook), 1):
        cell.outputs, cell.execution_count = kept(cell.outputs, count), count
    if update_golden:
        nbformat.write(notebook, path)
        stored = read(path)
    for cell, want in zip(code(notebook), code(stored), strict=True):
        assert differences(cell.outputs, want.outputs) == []
    outputs = [output for cell in code(notebook) for output in cell.outputs]
    assert outputs
    # A warning of any library is written there.
    assert [output.text for output in outputs if output.get("name") == "stderr"] == []


def test_none_has_the_names_of_another(kernel: KernelManager, tmp_path: Path) -> None:
    run(new_notebook(cells=[new_code_cell("one = 1"), new_code_cell("one")]), kernel, tmp_path)
    with pytest.raises(CellExecutionError, match="name 'one' is not defined"):
        run(new_notebook(cells=[new_code_cell("one")]), kernel, tmp_path)


@every
def test_is_stored_as_a_run_from_clean_leaves_it(path: Path) -> None:
    """Cells are counted from one; nothing is stored of which every run has another."""
    notebook = read(path)
    nbformat.validate(notebook)
    for count, cell in enumerate(code(notebook), 1):
        assert cell.execution_count == count
        assert cell.outputs == kept(cell.outputs, count)
    assert all(cell.metadata == {} for cell in notebook.cells)
    assert set(notebook.metadata) == {"kernelspec", "language_info"}
    assert dict(notebook.metadata.language_info) == {"name": "python"}


@every
def test_names_no_place_of_a_machine(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert not re.search(r"\b0x[0-9a-f]{6,}", text)
    assert not re.search(r"(?<![\w.])/(home|root|tmp|usr|work|Users)/|[A-Z]:\\\\", text)


@every
def test_asserts_and_explains(path: Path) -> None:
    notebook = read(path)
    cells = code(notebook)
    assert (
        sum(line.startswith("assert ") for cell in cells for line in cell.source.splitlines()) >= 8
    )
    assert max(len(cell.source.splitlines()) for cell in cells) <= LONGEST
    assert notebook.cells[0].cell_type == "markdown"
    prose = [cell for cell in notebook.cells if cell.cell_type == "markdown"]
    assert len(prose) >= len(cells) / 2


@every
def test_is_small(path: Path) -> None:
    """What is written by hand, and the whole with its pictures."""
    notebook = read(path)
    assert sum(len(cell.source) for cell in notebook.cells) < 20_000
    assert path.stat().st_size < 400_000
