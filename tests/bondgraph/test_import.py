"""`import bondgraph` is light and silent, and hands on what it names."""

import subprocess
import sys
from pathlib import Path

import pytest

import bondgraph as bg

ROOT = Path(bg.__file__).parents[1]


def _run(code: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-W", "error", "-c", code],
        capture_output=True,
        text=True,
        cwd=ROOT,
        check=True,
    )


@pytest.mark.parametrize("package", ["bondgraph", "codegen", "differentials"])
def test_packages_import_what_they_offer_as_it_is_asked_for(package: str) -> None:
    heavy = ("matplotlib", "scipy", "sympy", "numpy", "networkx", "control", "multiprocessing")
    done = _run(
        f"import sys; import {package}\n"
        f"assert not [name for name in {heavy} if name in sys.modules], sorted(sys.modules)"
    )
    assert (done.stdout, done.stderr) == ("", "")


def test_modules_do_not_hide_what_is_offered_under_their_names() -> None:
    """`bondgraph.derive` is a function, and a module that others import it from."""
    _run(
        "import bondgraph.derive, bondgraph.drawing.picture, codegen.simulator, codegen.trim\n"
        "import bondgraph, codegen, differentials.scenarios, differentials\n"
        "offered = (bondgraph.derive, bondgraph.drawing, codegen.simulator, codegen.trim)\n"
        "assert all(map(callable, offered)), offered\n"
        "assert 'fig11' in differentials.scenarios\n"
        "assert bondgraph.nodes.elements.Node is not None\n"
        "from bondgraph.derive import derive\n"
        "assert bondgraph.derive is derive"
    )


def test_what_is_not_offered_is_named() -> None:
    with pytest.raises(AttributeError, match="module 'bondgraph' has no attribute 'drive'"):
        bg.drive  # noqa: B018
    with pytest.raises(ImportError, match="cannot import name 'drive' from 'bondgraph'"):
        from bondgraph import drive  # noqa: F401


def test_import_prints_nothing_and_loads_no_numerics() -> None:
    heavy = ("matplotlib", "scipy", "codegen", "differentials", "control")
    done = _run(
        "import sys; import bondgraph; bondgraph.derive\n"
        f"assert not [name for name in {heavy} if name in sys.modules], sorted(sys.modules)"
    )
    assert (done.stdout, done.stderr) == ("", "")


def test_import_reads_no_working_directory(tmp_path: Path) -> None:
    """Nothing is written beside the package or where it is imported."""
    done = subprocess.run(
        [sys.executable, "-B", "-c", f"import sys; sys.path.insert(0, {str(ROOT)!r}); import bondgraph"],
        capture_output=True, text=True, cwd=tmp_path, check=True,
    )  # fmt: skip
    assert done.stdout == done.stderr == ""
    assert list(tmp_path.iterdir()) == []


def test_public_names_exist_and_are_documented() -> None:
    assert len(set(bg.__all__)) == len(bg.__all__)
    assert all(getattr(bg, name).__doc__ for name in bg.__all__)
