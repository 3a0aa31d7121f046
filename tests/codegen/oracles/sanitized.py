"""Compiled code under the sanitizers of addresses and of undefined behaviour, called from Python."""

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

TELLING = "BONDGRAPH_TEST_SANITIZER_TELLS"
"""In the environment: undefined behaviour is told in words, not by a trap, in half as much time again."""

FLAGS = (
    "-O0", "-std=c99", "-fsanitize=address,undefined", "-fno-sanitize-recover=all",
    # What these find ends in a fault that the other sanitizer tells, and they take half of the time.
    "-fno-sanitize=null,object-size,nonnull-attribute,returns-nonnull-attribute,pointer-overflow",
    # The same checks by calls, not in place: a quarter less to compile.
    "--param=asan-instrumentation-with-call-threshold=0",
    *(("-g",) if os.environ.get(TELLING) else ("-g0", "-fsanitize-undefined-trap-on-error")),
)  # fmt: skip

TESTS = Path(__file__).parents[1]


@contextmanager
def sanitized(*makers: Callable[..., object]) -> Iterator[None]:
    """What these make is compiled for the sanitizers: the flags are their only default."""
    with pytest.MonkeyPatch.context() as patch:
        for maker in makers:
            patch.setattr(maker, "__defaults__", (FLAGS,))
        yield


def check_clean(script: str) -> None:
    """Run a script beside the tests, in a process of its own; it fails where a sanitizer complains.

    A script that fails runs again with what tells where undefined behaviour is.
    """
    done = _ran(script, "")
    if done.stdout != "clean\n":
        again = _ran(script, "1")
        raise AssertionError(f"{done.stderr[-1000:]}\nstatus {done.returncode}; told in words:\n"
                             f"{again.stderr[-3000:]}")  # fmt: skip


def _ran(script: str, telling: str) -> subprocess.CompletedProcess[str]:
    """The process that ran the script."""
    found = subprocess.run(
        ["gcc", "-print-file-name=libasan.so"], capture_output=True, text=True, check=True
    )
    environment = os.environ | {
        "LD_PRELOAD": found.stdout.strip(),
        # Half the time of a compiler that optimises, and nothing is optimised away that was wrong.
        "CFLAGS": "-O0",
        TELLING: telling,
        # Where memory was taken is not told for each of Python's own pieces, which takes half the time.
        "ASAN_OPTIONS": "detect_leaks=0:malloc_context_size=0:quarantine_size_mb=16",
    }  # fmt: skip
    folders = (TESTS / one for one in ("batch", "engine", "runs"))
    paths = [str(one) for one in (TESTS.parent, TESTS, *folders)]
    # Compilers that this process starts need none of it, and take twice as long with it.
    begin = f"import os, sys\nsys.path[:0] = {paths!r}\ndel os.environ['LD_PRELOAD']"
    text = f"{begin}\n{script}\nprint('clean')\n"
    return subprocess.run(
        [sys.executable, "-c", text], env=environment, capture_output=True, text=True, check=False
    )
