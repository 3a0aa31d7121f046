"""The command line: ``python -m differentials --help``."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn

import bondgraph as bg
from differentials import commands
from differentials.exporting import TARGETS
from differentials.figures import figures
from differentials.topologies import catalog

EXAMPLES = """\
examples:
  python -m differentials list
  python -m differentials show superposition_tvd
  python -m differentials simulate alsd --scenario fig11 --set k=4300 --out out
  python -m differentials figures --out out
  python -m differentials export alsd --to fmu3 --scenario fig11 --set I_1=0.008 --out out
"""


class Parser(argparse.ArgumentParser):
    """A parser whose complaints are one line."""

    def error(self, message: str) -> NoReturn:
        """Say what is wrong and where help is, and leave with status 2."""
        self.exit(2, f"{self.prog}: {message} (see {self.prog} --help)\n")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; 0 if it did what it says, 2 with one line on standard error if it can't."""
    options = _parser().parse_args(arguments)
    try:
        _run(options)
    except (bg.BondGraphError, OSError) as error:
        print(f"python -m differentials {options.command}: {error}", file=sys.stderr)
        return 2
    return 0


def _run(options: argparse.Namespace) -> None:
    match options.command:
        case "list":
            commands.list_all()
        case "show":
            commands.show(options.name, options.halfshafts, not options.unlumped)
        case "simulate":
            changed = dict(options.set)
            commands.run(options.name, options.scenario, changed, options.backlash, options.out)
        case "export":
            commands.write_export(
                options.name, options.to, options.scenario, dict(options.set), options.out
            )
        case "figures":
            commands.draw_figures(options.figure, options.out)
        case _:
            commands.demo(options.out)


def _assignment(text: str) -> tuple[str, float]:
    """``k=4300`` as a name and a number."""
    name, equals, value = text.partition("=")
    try:
        if name and equals:
            return name, float(value)
    except ValueError:
        pass
    raise argparse.ArgumentTypeError(f"{text!r} is not NAME=NUMBER, as in k=4300")


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="python -m differentials",
        description="The differentials of Deur, Hancock and Assadian (IMECE2008-69248): equations, "
        "simulations, figures.",
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    added = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    added.add_parser("list", help="the differentials and the scenarios there are")
    show = _command(added, "show", "equations, causality, parameters and modes of a differential")
    show.add_argument("name", metavar="NAME", help=f"one of {', '.join(catalog)}")
    show.add_argument("--halfshafts", action="store_true", help="the full model's equations")
    show.add_argument("--unlumped", action="store_true", help="every inertia an element of its own")
    simulate = _command(added, "simulate", "run a scenario; writes a table and a picture")
    exported = _command(
        added, "export", "write a differential in a scenario as Python, C or an FMU"
    )
    exported.add_argument("--to", required=True, choices=TARGETS, help="what to write")
    for command in (simulate, exported):
        command.add_argument("name", metavar="NAME", help=f"one of {', '.join(catalog)}")
        command.add_argument("--scenario", help="a name that `list` shows (the differential's own)")
        command.add_argument(
            "--set", action="append", default=[], type=_assignment, metavar="NAME=NUMBER",
            help="another value for a parameter, in SI units; may be repeated (`show` lists them)",
        )  # fmt: skip
    simulate.add_argument("--backlash", action="store_true", help="with play (parameter gap, rad)")
    drawn = _command(added, "figures", "run and draw the paper's Figs. 11 to 14")
    drawn.add_argument("figure", nargs="*", metavar="FIGURE", help=f"some of {', '.join(figures)}")
    demo = _command(added, "demo", "a tour: equations, causality, modes, two simulations")
    for command in (simulate, exported, drawn, demo):
        command.add_argument(
            "--out", type=Path, default=Path("out"), metavar="DIR", help="folder for files (out)"
        )
    return parser


def _command(added: "argparse._SubParsersAction[Parser]", name: str, text: str) -> Parser:
    return added.add_parser(name, help=text, description=f"{text[0].upper()}{text[1:]}.")


if __name__ == "__main__":
    sys.exit(main())
