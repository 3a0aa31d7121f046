"""The command line: ``python -m differentials --help``, or ``bondgraph --help``."""

import sys
from collections.abc import Sequence
from typing import NoReturn

MISSING = (
    "the command line needs click; install the optional extra: pip install bondgraph-toolkit[cli]"
)


def main(arguments: Sequence[str] | None = None, program: str = "bondgraph") -> NoReturn:
    """Run a command and leave with its status; without click say what to install, status 2."""
    try:
        import click  # noqa: F401
    except ImportError:
        print(MISSING, file=sys.stderr)
        sys.exit(2)
    from differentials.commands.app import app

    app.main(arguments, program)


if __name__ == "__main__":
    main(program="python -m differentials")
