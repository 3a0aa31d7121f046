"""Compiled code under valgrind: no read of what was never set, none outside of what there is."""

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

CHECKER = ("valgrind", "--quiet", "--error-exitcode=99", "--leak-check=full")

FLAGS = "-O0 -g -march=x86-64-v2"
"""Code whose instructions valgrind knows, and whose lines it can tell."""

TESTS = Path(__file__).parents[1]


def check_program(command: Sequence[str]) -> str:
    """Run a program under valgrind; what it prints.

    It fails where valgrind complains and where the program does; skipped where there is no valgrind.
    """
    _need_valgrind()
    done = subprocess.run([*CHECKER, *command], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-1000:] + done.stderr[-3000:]
    return done.stdout


def check_script(script: str, folder: Path) -> str:
    """Run Python beside the tests under valgrind; what it prints.

    Libraries are compiled into the folder; only what is seen in calls of these counts, as the
    interpreter and its packages are not ours.
    """
    _need_valgrind()
    log, text = folder / "valgrind.log", f"import sys\nsys.path[:0] = {_paths()!r}\n{script}\n"
    environment = os.environ | {
        "XDG_CACHE_HOME": str(folder / "cache"), "CFLAGS": FLAGS, "PYTHONMALLOC": "malloc",
        "OPENBLAS_NUM_THREADS": "1",
    }  # fmt: skip
    command = ["valgrind", f"--log-file={log}", sys.executable, "-c", text]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-3000:]
    ours = complaints(log.read_text(encoding="utf-8", errors="replace"), str(folder / "cache"))
    assert not ours, "\n\n".join(ours[:3])
    return done.stdout


def complaints(log: str, place: str) -> list[str]:
    """The complaints of a log that tell of a call of a library at this place or of its sources."""
    found = re.split(r"^==\d+== \n", log, flags=re.MULTILINE)
    mine = re.compile(
        rf"\({re.escape('in ' + place)}|\((?:batch|exact|fmu|located|model|port|run)_?\w*\.c:\d+\)"
    )
    return [one for one in found if mine.search(one)]


def _paths() -> list[str]:
    return [str(TESTS), str(TESTS.parent)]


def _need_valgrind() -> None:
    if shutil.which("valgrind") is None:
        pytest.skip("no valgrind")
