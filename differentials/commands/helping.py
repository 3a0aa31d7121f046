"""Commands and the examples below their help: what no model is needed for."""

from collections.abc import Callable
from typing import Any

import click

Command = Callable[..., Any]

as_json = click.option("--json", "as_json", is_flag=True, help="Data for programs, as JSON.")


def examples(*lines: str) -> str:
    """Commands to be shown below a help text, one a line."""
    return "\b\nExamples:\n" + "\n".join(f"  bondgraph {line}" for line in lines)


def command(*lines: str) -> Callable[[Command], click.Command]:
    """A command with examples below its help; `COMMANDS` has what a list of commands says of it."""
    return click.command(epilog=examples(*lines))
