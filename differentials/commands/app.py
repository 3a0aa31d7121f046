"""The commands together, and what becomes of errors and warnings: one line each, and a status."""

import sys
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any, NoReturn

import click

import bondgraph as bg
from differentials.commands.helping import examples
from differentials.commands.homes import COMMANDS, Homes

FAILED, REFUSED = 1, 2
"""Status where something went wrong on the way, and where the command can't be meant so."""


class App(click.Group):
    """A group that lists its commands as they were added, and whose complaints are one line."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """The commands from the first look to the last use."""
        return list(self.commands)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """What each does in short, as its home says; none has to be imported for that."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, home.short) for name, home in COMMANDS.items()])

    def main(
        self,
        args: Sequence[str] | None = None,
        prog_name: str | None = None,
        *rest: Any,
        **more: Any,
    ) -> NoReturn:
        """Run a command and leave: 0 if it did what it says, 1 if something failed, 2 if it was refused."""
        given = list(sys.argv[1:] if args is None else args)
        more["standalone_mode"] = False
        program = prog_name or self.name or ""
        where = next((f"{program} {one}" for one in given if one in self.commands), program)
        try:
            with _doubts_told(where):
                status = super().main(given, program, *rest, **more)
        except click.exceptions.NoArgsIsHelpError as error:
            error.show()
            status = REFUSED
        except click.UsageError as error:
            path = error.ctx.command_path if error.ctx else where
            _complain(path, f"{error.format_message().rstrip('.')} (see {path} --help)")
            status = REFUSED
        except click.ClickException as error:
            _complain(where, error.format_message())
            status = FAILED
        except bg.WriteError as error:
            _complain(where, _with_notes(str(error), error))
            status = FAILED
        except bg.BondGraphError as error:
            _complain(where, _with_notes(str(error), error))
            status = REFUSED
        except OSError as error:
            _complain(where, str(error))
            status = FAILED
        except click.Abort as error:
            _complain(where, _with_notes("interrupted", error.__cause__ or error.__context__))
            status = FAILED
        sys.exit(status if isinstance(status, int) else 0)


def _with_notes(text: str, error: BaseException | None) -> str:
    """What is said of an error, and what it was given on its way: what is left of files."""
    notes = list[str]()
    while error is not None:
        notes += getattr(error, "__notes__", ())
        error = error.__cause__
    return "; ".join([text, *notes])


@contextmanager
def _doubts_told(where: str) -> Iterator[None]:
    """Warnings of models in one line each, and each once; what Python's own switch -W says goes first."""
    told: set[str] = set()
    with warnings.catch_warnings():
        plain = warnings.showwarning

        def show(message: Warning | str, category: type[Warning], *place: Any, **more: Any) -> None:
            if not issubclass(category, bg.ModelWarning):
                plain(message, category, *place, **more)
            elif str(message) not in told:
                told.add(str(message))
                _complain(where, f"warning: {message}")

        warnings.showwarning = show
        if not sys.warnoptions:
            warnings.simplefilter("always", bg.ModelWarning)
        yield


def _complain(where: str, message: str) -> None:
    click.echo(f"{where}: {' '.join(message.split())}", err=True)


@click.group(
    "bondgraph",
    cls=App,
    commands=Homes(),
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110},
    epilog=examples(
        "list", "show superposition_tvd", "simulate alsd --scenario fig11 --set k=4300 --out out",
        "sweep alsd --grid k=4300:17200:3 --peak tau_k1 --workers 0", "figures --out out",
        "export alsd --to c --scenario fig11 --set I_1=0.008 --out out",
    ),
)  # fmt: skip
@click.version_option(package_name="bondgraph-toolkit", prog_name="bondgraph")
def app() -> None:
    """Bond graphs: their equations, drawings, runs and exports.

    MODEL is one of the differentials of Deur, Hancock and Assadian (IMECE2008-69248) that `bondgraph
    list` shows, or a graph in a .json or .graphml file. All numbers are in SI units.
    """
