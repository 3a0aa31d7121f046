"""Compilers that share: what one test has compiled, no other compiles again, whichever process it runs in.

For one run of the tests a folder is made with programs `cc` and `gcc` that stand before the system's;
they keep what they compile by what it depends on (see `shared_cc.py`). The folder is also where compiled
libraries are kept that else go to the user's cache, so that nothing of an earlier run is found.
"""

import os
import shlex
import shutil
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

FOLDER = "BONDGRAPH_TEST_FOLDER"
"""In the environment: the run's folder, which its processes share."""

QUICK = "BONDGRAPH_TEST_QUICK_CC"
"""In the environment: the compiler for code that is not optimised; none for the system's own. Else tcc."""

NAMES = ("cc", "gcc")

PROGRAM = Path(__file__).with_name("shared_cc.py")


def pytest_configure(config: pytest.Config) -> None:
    """The first process of a run makes the folder; those that it starts find it."""
    # Most tests compile for one short run: what optimising takes is many times what it saves there.
    os.environ.setdefault("CFLAGS", "-O0")
    if FOLDER in os.environ:
        return
    folder = Path(tempfile.mkdtemp(prefix="bondgraph-tests-"))
    (folder / "bin").mkdir()
    for name in NAMES:
        found = shutil.which(name)
        if found:
            quick = shutil.which(os.environ.get(QUICK, "tcc")) or ""
            words = [sys.executable, "-I", "-S", str(PROGRAM), str(folder), found, quick]
            program = folder / "bin" / name
            program.write_text(f'#!/bin/sh\nexec {shlex.join(words)} "$@"\n', encoding="utf-8")
            program.chmod(0o755)
    config.pluginmanager.register(Shared(folder), "shared compilers")


@pytest.fixture
def optimised(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Engines compiled so that multiplications are fused with additions, as they are for users."""
    from codegen.engine.sizes import engine

    # gcc fuses nothing at -O1 alone; -O2 takes half as long again.
    monkeypatch.setenv("CFLAGS", "-O1 -fexpensive-optimizations")
    engine.cache_clear()
    yield
    engine.cache_clear()


class Shared:
    """The folder while the run lasts."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.patch = pytest.MonkeyPatch()
        self.patch.setenv(FOLDER, str(folder))
        self.patch.setenv("PATH", str(folder / "bin"), prepend=os.pathsep)
        self.patch.setenv("XDG_CACHE_HOME", str(folder / "cache"))

    @pytest.hookimpl(trylast=True)
    def pytest_unconfigure(self) -> None:
        """Leave nothing behind."""
        self.patch.undo()
        shutil.rmtree(self.folder, ignore_errors=True)


def counted() -> Counter[str]:
    """How many programs were compiled as one, were taken again, or were compiled in parts."""
    log = Path(os.environ[FOLDER]) / "log"
    return Counter(log.read_text("utf-8").split() if log.exists() else ())
