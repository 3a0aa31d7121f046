"""Every command that the README or a help text shows can be typed as it stands."""

import re
import shlex
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from differentials.cli.app import app

Call = Callable[..., Result]

ROOT = Path(__file__).parents[3]
LINE = re.compile(r"^ {4}(?:bondgraph|python -m differentials) (.+)$", re.MULTILINE)

ELSEWHERE = {"demo --out out"}
"""What `test_tours` runs."""


def in_readme() -> list[str]:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    return [line.partition("  #")[0].strip() for line in LINE.findall(text)]


def in_help() -> list[str]:
    groups = [app, *app.commands.values()]
    shown = [line for group in groups for line in (group.epilog or "").splitlines()]
    return [line.split("bondgraph ", 1)[1] for line in shown if line.startswith("  bondgraph ")]


def test_there_is_something_to_run() -> None:
    assert len(in_readme()) >= 10
    assert len(in_help()) >= 2 * len(app.commands)


@pytest.mark.parametrize("line", sorted({*in_readme(), *in_help()} - ELSEWHERE))
def test_what_is_documented_runs(line: str, call: Call) -> None:
    done = call(*shlex.split(line))
    assert done.exit_code == 0, f"{line}: {done.output}"
