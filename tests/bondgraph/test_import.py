"""`import bondgraph` is light and silent, and hands on what it names."""

import subprocess
import sys
from pathlib import Path

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


def test_import_prints_nothing_and_loads_no_numerics() -> None:
    heavy = ("matplotlib", "scipy", "codegen", "differentials", "control")
    done = _run(
        "import sys; import bondgraph\n"
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
