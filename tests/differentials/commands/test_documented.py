"""Every command that a help text shows can be typed as it stands; `tests/docs` runs those of the pages."""

import shlex
from collections.abc import Callable

import pytest
from click.testing import Result

from differentials.commands.app import app

Call = Callable[..., Result]

ELSEWHERE = {"demo --out out", "figures --out out", "figures fig11"}
"""What `test_tours` runs."""


def in_help() -> list[str]:
    groups = [app, *app.commands.values()]
    shown = [line for group in groups for line in (group.epilog or "").splitlines()]
    return [line.split("bondgraph ", 1)[1] for line in shown if line.startswith("  bondgraph ")]


def test_there_is_something_to_run() -> None:
    assert len(in_help()) >= 2 * len(app.commands)


@pytest.mark.parametrize("line", sorted({*in_help()} - ELSEWHERE))
def test_what_is_documented_runs(line: str, call: Call) -> None:
    done = call(*shlex.split(line))
    assert done.exit_code == 0, f"{line}: {done.output}"
