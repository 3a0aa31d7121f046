"""Which tests need a compiler, decided here alone, and `--quick`, which leaves those and slow ones out.

Files in which nearly everything is compiled are named; what else starts a compiler is skipped when it does.
Which tests are slow stands in `slow.txt`, so that the same ones run on every machine.
"""

import os
import sys
from collections.abc import Sequence
from fnmatch import fnmatch
from pathlib import Path

import pytest

FILES = (
    "codegen/batch/test_*.py", "codegen/c/test_c_*.py", "codegen/cosimulation/test_units.py",
    "codegen/engine/test_build.py",
    "codegen/engine/test_c_backend.py", "codegen/engine/test_engine_bounds.py",
    "codegen/engine/test_located.py", "codegen/engine/test_memory.py", "codegen/fmu/test_*.py",
    "codegen/ports/test_many_ports.py", "codegen/program/test_awkward_names.py",
    "differentials/test_agreement.py",
    "docs/test_commands.py", "test_notebooks.py",
)  # fmt: skip
"""Below `tests`."""

SLOW = Path(__file__).with_name("slow.txt")
"""Tests that take more than an eighth of a second, averaged over what they are given; `used.py` writes it."""

COMPILERS = ("cc", "gcc", "clang")

TESTS = Path(__file__).parents[1]


def pytest_addoption(parser: pytest.Parser) -> None:
    """``--quick``: what needs no compiler and no more than a few seconds."""
    parser.addoption(
        "--quick", action="store_true", help="leave out what is slow or needs a compiler"
    )


def pytest_configure(config: pytest.Config) -> None:
    """A hook of Python's own cannot be taken away: there is one only where it is asked for."""
    config.addinivalue_line("markers", "needs_compiler: starts a C compiler; set by the rig")
    if config.getoption("--quick"):
        sys.addaudithook(_refuse)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark tests, and leave out those that are not asked for."""
    compiling = {path for path in {item.path for item in items} if needs_compiler(path)}
    for item in items:
        if item.path in compiling:
            item.add_marker("needs_compiler")
    if config.getoption("--quick"):
        slow = set(SLOW.read_text("utf-8").splitlines())
        out = [
            one
            for one in items
            if one.get_closest_marker("needs_compiler")
            or one.get_closest_marker("slow")
            or function(one.nodeid) in slow
        ]
        config.hook.pytest_deselected(items=out)
        items[:] = [one for one in items if one not in set(out)]


def function(nodeid: str) -> str:
    """A test's name without what it is parametrized with."""
    return nodeid.partition("[")[0]


def needs_compiler(path: Path) -> bool:
    """Whether nearly all tests of a file start a compiler."""
    if not path.is_relative_to(TESTS):
        return False
    return any(fnmatch(path.relative_to(TESTS).as_posix(), pattern) for pattern in FILES)


def compiles(command: Sequence[str]) -> bool:
    """Whether a command is a compiler's."""
    words = [os.path.basename(os.fsdecode(word)) for word in command]
    return words[:1] != [] and (words[0] in COMPILERS or "ziglang" in words[:3])


def _refuse(event: str, arguments: tuple[object, ...]) -> None:
    if event == "subprocess.Popen":
        command = arguments[1]
        if isinstance(command, (list, tuple)) and compiles(command):
            pytest.skip("needs a compiler")
