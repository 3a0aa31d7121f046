"""How tests of the command line call it, and what they share."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

from differentials.commands.app import app

EXAMPLES = Path(__file__).parents[3] / "examples"

Call = Callable[..., Result]


@pytest.fixture
def call(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Call:
    """Runs a command in an empty folder that has the example graphs beside it."""
    (tmp_path / "examples").symlink_to(EXAMPLES)
    monkeypatch.chdir(tmp_path)

    def called(*arguments: str) -> Result:
        return CliRunner().invoke(app, arguments, catch_exceptions=False)

    return called


@pytest.fixture
def data(call: Call) -> Callable[..., Any]:
    """Runs a command with ``--json`` that must succeed, and gives what it printed."""

    def read(*arguments: str) -> Any:
        done = call(*arguments, "--json")
        assert (done.exit_code, done.stderr) == (0, ""), done.output
        return json.loads(done.stdout)

    return read
