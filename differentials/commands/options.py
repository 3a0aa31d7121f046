"""Options that several commands share, and the examples below their help."""

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import click

import bondgraph as bg
from codegen.simulate import BACKENDS
from differentials.commands.helping import Command as Command
from differentials.commands.helping import as_json as as_json
from differentials.commands.helping import command as command
from differentials.commands.names import Assigned, OneOf
from differentials.commands.signals import law, signal, table_file
from differentials.commands.subject import TABLES, SubjectType, tables_given
from differentials.scenarios import named_cases

NUMBER = Assigned("NAME=NUMBER", "k=4300", float)
START = Assigned("STATE=NUMBER", "omega_1=80", float)
SIGNAL = Assigned("INPUT=SIGNAL", "tau_e=step(0.1, 350)", signal)
LAW = Assigned("NODE=LAW", "clutch=friction(1000)", law, lambda ctx: {"tables": tables_given(ctx)})
TABLE = Assigned("NAME=FILE[,...]", "map=map.csv,method=pchip", table_file)
MODE = Assigned("NODE=MODE", "dog=off", str)


def _pairs(ctx: Any, param: Any, given: tuple[tuple[str, Any], ...]) -> dict[str, Any]:
    """Assignments as a mapping; a name given twice is refused."""
    for at, (name, _) in enumerate(given):
        if name in dict(given[:at]):
            raise click.UsageError(f"{name} is given twice; keep one", ctx)
    return dict(given)


def assigned(flag: str, name: str, kind: Assigned, text: str) -> Callable[[Command], Command]:
    """An option that may be repeated and becomes a mapping."""
    return click.option(
        flag, name, multiple=True, type=kind, metavar=kind.name, callback=_pairs,
        help=f"{text} May be repeated.",
    )  # fmt: skip


def _tables(ctx: Any, param: Any, given: tuple[tuple[str, Any], ...]) -> None:
    """Read the tables, and keep them for what is read after them."""
    ctx.meta[TABLES] = tuple(
        bg.LookupTable.read(name, path, **choices)
        for name, (path, choices) in _pairs(ctx, param, given).items()
    )


def subject(run: Command) -> Command:
    """What the command is about, and the tables that its values and laws may call."""
    argument = click.argument("subject", type=SubjectType(), metavar="MODEL")
    tables = click.option(
        "--table", multiple=True, type=TABLE, metavar=TABLE.name, callback=_tables, is_eager=True,
        expose_value=False,
        help="A lookup table in a CSV file, which values and laws may call: x and z in two columns, or a "
        "grid; then ,method=linear|pchip|akima|bicubic and ,outside=hold|extend|refuse. May be repeated.",
    )  # fmt: skip
    return argument(tables(run))


parameters = assigned(
    "--set", "parameters", NUMBER, "A parameter's value, in SI units (`bondgraph show` lists them)."
)
laws = assigned(
    "--law", "laws", LAW,
    "What closes an open port: an expression, or friction(level[, curve[, breakaway]]).",
)  # fmt: skip
on = click.option(
    "--on",
    multiple=True,
    metavar="SWITCH",
    help="A switch that is on: at first in a run, else in the mode that is meant. May be repeated.",
)
off = click.option(
    "--off",
    multiple=True,
    metavar="SWITCH",
    help="A switch that is off, as all are that --on does not name. May be repeated.",
)
reads = click.option(
    "--reads", multiple=True, metavar="NAME",
    help="A name in values that is an input: the opening of a valve. May be repeated.",
)  # fmt: skip
scenario = click.option(
    "--scenario", type=OneOf(tuple(named_cases()), "scenario"), metavar="NAME",
    help="A scenario that `bondgraph list` shows; by default the differential's own.",
)  # fmt: skip
backend = click.option(
    "--backend", type=OneOf(BACKENDS, "backend"), default="numpy", show_default=True, metavar="NAME",
    help="numpy, or c: compiled, faster.",
)  # fmt: skip
folder = click.option(
    "--out", type=click.Path(file_okay=False, path_type=Path), default=Path("out"), metavar="DIR",
    show_default=True, help="A folder for files.",
)  # fmt: skip


def models(run: Command) -> Command:
    """Which of a differential's models is meant."""
    unlumped = click.option("--unlumped", is_flag=True, help="Every inertia an element of its own.")
    full = click.option("--halfshafts", is_flag=True, help="The full model, with halfshafts.")
    return full(unlumped(run))


def variants(run: Command) -> Command:
    """Which of a differential's models, or which mode of a file's switches, is meant."""
    return models(on(off(run)))


@dataclass(frozen=True)
class Asked:
    """What the options of a run say."""

    scenario: str | None
    parameters: Mapping[str, float]
    laws: Mapping[str, Any]
    initial: Mapping[str, float]
    equilibrium: bool
    inputs: Mapping[str, Any]
    until: float | None
    sample: float | None
    backlash: bool
    on: tuple[str, ...]


_RUN = (
    scenario,
    parameters,
    assigned("--initial", "initial", START, "A state at the start; a file's others start at 0."),
    click.option("--equilibrium", is_flag=True,
                 help="Begin where all states rest under the inputs at the start."),
    assigned(
        "--input", "inputs", SIGNAL,
        "A number, or step(time, value), ramp(time, slope), sine(amplitude, frequency), "
        "lag(signal, time_constant), pulse(begin, end, value), square(frequency, low, high), "
        "sawtooth(frequency, low, high), pwm(frequency, duty), constant(value), or a sum; or two columns of "
        "a file, @FILE:TIME,VALUE, then :linear, :held or :pchip.",
    ),
    laws,
    click.option("--until", type=click.FloatRange(min=0, min_open=True), metavar="SECONDS",
                 help="The end of the run: the scenario's, 1 s for a file."),
    click.option("--sample", type=click.FloatRange(min=0, min_open=True), metavar="SECONDS",
                 help="Time between samples: 1 ms, a thousandth of the run for a file."),
    click.option("--backlash", is_flag=True, help="With play in the shafts (parameter gap, rad)."),
    on,
)  # fmt: skip


def run_options(run: Command) -> Command:
    """The options that say what is run; the command gets them together as ``asked``."""

    @functools.wraps(run)
    def collected(**given: Any) -> Any:
        asked = Asked(**{part.name: given.pop(part.name) for part in fields(Asked)})
        return run(asked=asked, **given)

    wrapped: Command = collected
    for option in reversed(_RUN):
        wrapped = option(wrapped)
    return wrapped
