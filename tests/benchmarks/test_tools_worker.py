"""How a tool is asked: environments, a process of its own, what is read of what it says."""

import ast
import doctest
import importlib
import re
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.tools import asking, environments

TOOLS = Path(asking.__file__).parent
SCRIPTS = sorted((TOOLS / "scripts").glob("*.py"))
ROWS = {"chain", "ladder", "clutch", "sweep", "gradient"}

SCRIPT = """
def prepare(spec):
    return spec["start"]

def run(ready):
    if ready < 0:
        raise ValueError("too little\\nfor this")
    return 2 * ready

ROWS = {"chain": (prepare, run, lambda spec, ready, found: [ready, found])}
CANNOT = {"ladder": "no circuits"}
"""


@pytest.fixture
def said(tmp_path):
    """What the worker says of a row to a script, the last line of it."""
    path = tmp_path / "script.py"
    path.write_text(SCRIPT)

    def ask(row, start):
        command = [sys.executable, "-I", str(TOOLS / "worker.py"), str(path), row, "5"]
        given = f'{{"start": {start}}}'
        done = subprocess.run(command, input=given, capture_output=True, text=True, check=True)
        return asking.latest(done.stdout)

    return ask


def test_a_worker_tells_times_and_the_answer(said):
    found = said("chain", 3)
    assert found["answer"] == [3, 6]
    assert found["first"] > 0
    assert {"prepare", "again", "compiled"} < set(found)


def test_a_worker_tells_what_fails_and_what_cannot_be(said):
    assert said("chain", -1) == {"error": "ValueError: too little"}
    assert said("ladder", 1) == {"cannot": "no circuits"}


def test_a_worker_that_takes_too_long_of_a_processor_is_told_apart(monkeypatch, tmp_path):
    scripts = tmp_path / "scripts"
    scripts.mkdir()
    (scripts / "spin.py").write_text(SCRIPT.replace("return 2 * ready", "\n    while True: pass"))
    (tmp_path / "worker.py").write_text((TOOLS / "worker.py").read_text())
    monkeypatch.setattr(asking, "HERE", tmp_path)
    assert asking.asked(sys.executable, "spin", "chain", {"start": 1}, 1.0) == {"over": 1.0}


def test_nothing_is_read_of_what_says_nothing():
    assert asking.latest("Warning: RESULT is near\n") == {}


@pytest.mark.parametrize("name", ["asking", "environments", "modelica_text", "tables", "verdicts"])
def test_examples_in_docstrings(name):
    found = doctest.testmod(importlib.import_module(f"benchmarks.tools.{name}"))
    assert found.attempted > 0
    assert not found.failed


def told(path, name):
    """The keys of a dictionary that a script binds, without running it."""
    for node in ast.parse(path.read_text()).body:
        names = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        if any(isinstance(one, ast.Name) and one.id == name for one in names):
            return {key.value for key in node.value.keys}
    return set()


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_every_tool_has_each_row_or_says_why_not(path):
    rows, cannot = told(path, "ROWS"), told(path, "CANNOT")
    assert rows | cannot == ROWS
    assert not rows & cannot


@pytest.mark.parametrize(
    "path", sorted((TOOLS / "scripts").glob("*.txt")), ids=lambda path: path.stem
)
def test_every_package_of_an_environment_has_a_version(path):
    lines = path.read_text().splitlines()
    packages = lines[1:] if environments.minor(path.read_text()) else lines
    assert packages
    assert all(re.fullmatch(r"[\w.-]+==[\w.]+", line) for line in packages)
    assert path.with_suffix(".py") in SCRIPTS


def test_a_python_is_found_where_this_one_is_new_enough():
    assert environments.interpreter(0) == sys.executable
    assert environments.interpreter(environments.NEWEST + 1) is None


def test_what_cannot_be_installed_is_told(tmp_path):
    wanted = tmp_path / "of.txt"
    wanted.write_text("# python >= 3.99\nnothing==1.0\n")
    assert environments.installed("of", wanted) == "not installed: no Python 3.99 or newer here"
