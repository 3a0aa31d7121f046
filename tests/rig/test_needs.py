"""What `--quick` leaves out."""

import subprocess
import sys
from pathlib import Path

from rig import needs

TESTS = Path(__file__).parents[1]


def test_every_pattern_names_a_file() -> None:
    assert all(list(TESTS.glob(pattern)) for pattern in needs.FILES)
    assert needs.needs_compiler(TESTS / "codegen" / "fmu" / "test_fmu_runs.py")
    assert not needs.needs_compiler(TESTS / "codegen" / "ports" / "test_friction_belt.py")
    assert not needs.needs_compiler(TESTS.parent / "codegen" / "fmu" / "test_fmu_runs.py")


def test_every_slow_test_is_there() -> None:
    """Documents are tests by themselves; a function of a file is found in its text."""
    for name in needs.SLOW.read_text("utf-8").splitlines():
        path, _, test = name.partition("::")
        text = (TESTS.parent / path).read_text("utf-8")
        assert path.endswith(".md") or test.rpartition(".")[2] in text, name


def test_compilers_are_told_from_other_programs() -> None:
    assert needs.compiles(["/usr/bin/gcc", "-c", "x.c"])
    assert needs.compiles(["python", "-m", "ziglang", "cc"])
    assert not needs.compiles(["python", "-c", "cc"])
    assert not needs.compiles([])


def test_whoever_starts_a_compiler_is_skipped(tmp_path: Path) -> None:
    (tmp_path / "test_it.py").write_text(
        "import subprocess, sys, pytest\n"
        "def test_cc():\n"
        "    try: subprocess.run(['cc', '--version'])\n"
        "    except Exception: pass\n"
        "    raise AssertionError\n"
        "def test_other(): subprocess.run([sys.executable, '-c', ''], check=True)\n"
        "@pytest.mark.slow\n"
        "def test_slow(): raise AssertionError\n"
    )
    (tmp_path / "pytest.ini").write_text("[pytest]\nmarkers =\n    slow: slow\n")
    command = [sys.executable, "-m", "pytest", "-q", "-rs", "-p", "rig.needs", "--quick", "."]
    done = subprocess.run(
        command, cwd=tmp_path, env={"PYTHONPATH": str(TESTS)}, capture_output=True, text=True,
        check=False,
    )  # fmt: skip
    assert "1 passed, 1 skipped, 1 deselected" in done.stdout
    assert "needs a compiler" in done.stdout
