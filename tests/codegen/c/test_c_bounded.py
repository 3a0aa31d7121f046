"""What exported C may not do in real time is found where it is planted, and nowhere else."""

import re
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest
from oracles.c_model import written
from oracles.realtime import alsd, gearbox, six_pulse
from oracles.switched_steps import switched_steps

import bondgraph as bg
from codegen import to_c
from codegen.c.bounded import findings

CASES = {"alsd": alsd, "gearbox": gearbox, "six-pulse": six_pulse}


@pytest.mark.parametrize("name", CASES)
def test_steps_of_the_three_models_are_bounded(name: str) -> None:
    assert findings(CASES[name]().export("rosenbrock")) == []


def test_so_are_those_of_models_with_switches() -> None:
    for name, case in [*switched_steps()][::3]:
        assert findings(to_c(bg.derive(case.graph), case.numbers, main=True)) == [], name


PLANTED = (
    ("    double *more = malloc(8);", "malloc asks for memory"),
    ("    double *more = (double *)alloca(8);", "alloca asks for memory"),
    ("    int n = (int)h; double room[n];", "an array of n elements"),
    ("    while (h > 0)\n        h -= 1;", "while, which has no counter"),
    ("    do {\n        h -= 1;\n    } while (h > 0);", "do, which has no counter"),
    ("    for (;;)\n        h -= 1;", r"counter runs to no fixed bound: \(;;\)"),
    (
        "    for (int i = 0; i < 3; i++)\n        i--;",
        r"no fixed bound: \(int i = 0; i < 3; i\+\+\)",
    ),
    ("    for (int i = 0, n = 1; i < n; i++)\n        n++;", "counter runs to no fixed bound"),
    ("    for (int i = 0; i < 3; i--)\n        h += 1;", "counter runs to no fixed bound"),
    ("    for (int i = 0; s[i] != 0.0; i++)\n        h += 1;", "counter runs to no fixed bound"),
    (
        "    if (h > 1)\n        return bg_model_step(m, t, h - 1, s, w);",
        "bg_model_step calls itself",
    ),
    ("again:\n    if (--h > 0)\n        goto again;", "goto, which has no counter"),
)
"""Lines planted in a step, and what is said of each."""


@cache
def _plain() -> dict[str, str]:
    return to_c(alsd().equations, alsd().numbers, alsd().laws)


@pytest.mark.parametrize("place", ["bg_model_step", "bg_model_run", "efforts_against"])
@pytest.mark.parametrize(("lines", "told"), PLANTED)
def test_what_is_planted_is_found(lines: str, told: str, place: str) -> None:
    files = dict(_plain())
    for name, text in files.items():
        begin = text.find(f"{place}(")
        while begin >= 0 and (at := text.find("\n{\n", begin)) >= 0:
            if ";" not in text[begin:at]:
                files[name] = f"{text[: at + 3]}{lines}\n{text[at + 3 :]}"
                break
            begin = text.find(f"{place}(", begin + 1)
    found = findings(files)
    if place == "bg_model_run" and "alloc" not in told:
        # No step comes there: located events alone do.
        assert found == [] or "calls itself" in told
        return
    assert any(re.search(told, one) for one in found), found


def test_by_command_line_it_tells_of_a_folder(tmp_path: Path) -> None:
    written(tmp_path, _plain())
    line = [sys.executable, "-m", "codegen.c.bounded", str(tmp_path)]
    done = subprocess.run(line, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert "nothing allocates, all loops are bounded" in done.stdout
    (tmp_path / "more.c").write_text("int more(int n)\n{\n    return (int)(long)malloc(n);\n}\n")
    done = subprocess.run(line, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert done.stdout == "more.c: malloc asks for memory\n"
    done = subprocess.run(line[:-1], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "usage: python -m codegen.c.bounded FOLDER" in done.stderr
