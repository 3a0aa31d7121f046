"""Every command line that the README and the guides show does what it is shown for."""

import os
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path

import pytest

import codegen
import differentials
from codegen.engine.compiler import compiler
from differentials.__main__ import main

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


def _blocks(language: str) -> list[tuple[str, str]]:
    """The fenced blocks of a language, each with its page and number."""
    found = []
    for page in PAGES:
        texts = re.findall(rf"^```{language}\n(.*?)^```", page.read_text("utf-8"), re.M | re.S)
        found += [(f"{page.stem} {number}", text) for number, text in enumerate(texts, 1)]
    return found


OWN = (("python", "-m", "differentials"), ("bondgraph",))
"""How the command line is called."""

SHELL = _blocks("sh")
LINES = [line.split("#")[0].strip() for _, text in SHELL for line in text.splitlines()]


TOGETHER = """import runpy, sys
for path in sys.argv[1:]:
    runpy.run_path(path, run_name="__main__")
"""
"""Scripts one after the other, none with a name of another: in one process they import once."""

SAMPLED = ("linspace(0.0, 1.0, 1001)", "linspace(0.0, 0.02, 21)")
"""In the script of an exported run. `test_exporting.py` lets the same one run to its end."""


def _lines(text: str) -> Iterator[str]:
    """The lines of a block; examples that follow one another are one line."""
    for examples, group in groupby(text.splitlines(), lambda line: "python examples/" in line):
        if examples:
            paths = [shlex.split(line, comments=True)[1] for line in group]
            yield shlex.join(["python", "-c", TOGETHER, *paths])
        else:
            yield from group


def _shorten(script: Path) -> None:
    text = script.read_text("utf-8")
    assert SAMPLED[0] in text
    script.write_text(text.replace(*SAMPLED), "utf-8")


def _run(line: str, folder: Path, tools: Path) -> None:
    """Run one line of a shell in a folder; it must succeed."""
    path = [str(Path(sys.executable).parent), str(tools), os.environ["PATH"]]
    env = os.environ | {"PATH": os.pathsep.join(path), "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        ["sh", "-eu"], input=line, cwd=folder, env=env, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


def _called(words: list[str]) -> None:
    """Run the command line's own command in this process, which spares its imports; it must succeed."""
    try:
        status = main(words)
    except SystemExit as left:
        status = left.code or 0
    assert status == 0, words


def _tools(folder: Path) -> Path:
    """A folder with `cc`, whichever compiler there is; it does not optimise, which takes it long."""
    folder.mkdir()
    found = shutil.which("cc")
    command = found or " ".join(compiler())
    (folder / "cc").write_text(f'#!/bin/sh\nexec {command} "$@" -O0\n')
    (folder / "cc").chmod(0o755)
    return folder


@pytest.mark.parametrize(("page", "text"), SHELL, ids=[page for page, _ in SHELL])
def test_command_lines_run(
    page: str, text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Those of make and pip are looked at by the tests below; all others run, a block at a time."""
    tools = _tools(tmp_path / "tools")
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    for line in _lines(text):
        words = shlex.split(line, comments=True)
        own = next((len(name) for name in OWN if tuple(words[: len(name)]) == name), 0)
        if words[:1] == ["cd"]:
            monkeypatch.chdir(words[1])
        elif own:
            _called(words[own:])
        elif words and words[0] not in ("make", "pip"):
            if words[:2] == ["python", "run_alsd.py"]:
                _shorten(Path(words[1]))
            _run(line, Path.cwd(), tools)
    if "--out out" in text:
        assert any((tmp_path / "out").iterdir()), page


def test_the_makefile_has_what_pages_name() -> None:
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.M))
    text = "\n".join(page.read_text("utf-8") for page in PAGES)
    named = {line.split()[1] for line in LINES if line.startswith("make ")}
    named |= set(re.findall(r"`make ([a-z-]+)`", text))
    assert {"demo", "test", "docs"} <= named <= targets


def test_the_project_has_the_extras_that_pages_name() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras = set(project["optional-dependencies"])
    named = {
        name for line in LINES for group in re.findall(r'"\.\[(.*?)\]"', line)
        for name in group.split(",")
    }  # fmt: skip
    assert named
    assert named <= extras
    table = re.findall(r"^\| (`[a-z`, ]+`) \|", (ROOT / "README.md").read_text("utf-8"), re.M)
    listed = {name.strip("` ") for row in table for name in row.split(",")}
    assert extras <= listed


def test_c_of_the_pages_compiles_with_an_exported_model(tmp_path: Path) -> None:
    blocks = _blocks("c")
    assert blocks
    equations = differentials.equations("alsd")
    values = {name.name: 1.0 for name in equations.parameters}
    for name, text in codegen.to_c(equations, values).items():
        (tmp_path / name).write_text(text)
    for number, (_, text) in enumerate(blocks):
        unit = tmp_path / f"page_{number}.c"
        unit.write_text(text)
        _run(f"cc -std=c99 -Wall -Wextra -Wpedantic -Werror -c {unit.name}", tmp_path,
             _tools(tmp_path / f"tools_{number}"))  # fmt: skip
