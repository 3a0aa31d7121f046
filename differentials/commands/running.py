"""``simulate``: one run of a model, its events, and its signals as files."""

from functools import partial
from pathlib import Path

import click

import differentials.commands.options as options
from codegen import Result
from codegen.runs.methods import CHOICES
from codegen.streaming.files import ENDINGS
from differentials.commands.names import FileOf, OneOf
from differentials.commands.options import Asked
from differentials.commands.pictures import FORMATS, picture, save, save_all, told
from differentials.commands.preparing import run
from differentials.commands.preparing import stream as streamed
from differentials.commands.printing import print_json, with_folder, written
from differentials.commands.subject import Subject
from differentials.report import events_text


@options.command(
    "simulate alsd --scenario fig11 --set k=4300 --out out",
    "simulate alsd -o alsd.csv --json",
    "simulate examples/oscillator.json --set m=2 --set k=800 --set b=4 "
    "--input 'F=step(0.1, 10)' --until 2 -o oscillator.csv",
    "simulate alsd --sample 1e-5 -o alsd.parquet --stream --signal omega_1 --signal omega_2",
)
@options.subject
@options.run_options
@options.backend
@click.option(
    "--method",
    type=OneOf(CHOICES, "method"),
    default="auto",
    show_default=True,
    metavar="NAME",
    help=f"How to integrate: {', '.join(CHOICES)}.",
)
@click.option(
    "-o",
    "target",
    type=FileOf(*FORMATS),
    metavar="FILE",
    help="Write only this file: a table (.csv, .nc, .parquet, .mat) or a picture (.png).",
)
@click.option(
    "--stream",
    is_flag=True,
    help="Write the table of -o (.csv, .parquet) while the run goes on, and its events beside it: memory "
    "does not grow with samples. Until it is whole, its name tells that it is partial.",
)
@click.option(
    "--signal", "signals", multiple=True, metavar="NAME",
    help="With --stream: a signal to write; all columns if none is named. May be repeated.",
)  # fmt: skip
@options.folder
@options.as_json
def simulate(
    subject: Subject, asked: Asked, backend: str, method: str, target: Path | None, stream: bool,
    signals: tuple[str, ...], out: Path, as_json: bool,
) -> None:  # fmt: skip
    """Run MODEL; print its events, write every signal as a table, and a picture.

    A differential runs through a scenario, which --set, --initial, --input, --until and --sample change. A
    file's graph starts at --initial under --input.
    """
    _refuse_apart(target, stream, signals)
    if stream and target is not None:
        _stream(subject, asked, backend, method, target, signals, as_json)
        return
    result = run(subject, asked, backend, method)
    chosen = subject.differential
    case = asked.scenario or (chosen.scenario if chosen else "run")
    paint = partial(picture, subject, result, case)
    if target is not None:
        save(result, target, paint)
        paths = [target]
    else:
        name = f"{subject.name}_{case}"
        paths = save_all(name, {name: result}, paint, out)
    if as_json:
        print_json(_data(subject, case, asked, result) | {"files": paths})
        return
    changes = "".join(f", {name} = {value:g}" for name, value in asked.parameters.items())
    click.echo(f"{subject.name}, {case}{changes}\n\n{events_text(result)}\n")
    if target is None:
        told(paths)
    else:
        written(target)


def _refuse_apart(target: Path | None, stream: bool, signals: tuple[str, ...]) -> None:
    """Refuse options without those that they go with."""
    if signals and not stream:
        raise click.UsageError("--signal goes with --stream; without it every signal is written")
    if stream and (target is None or target.suffix.lower() not in ENDINGS):
        raise click.UsageError(f"--stream needs -o FILE, which ends in {' or '.join(ENDINGS)}")


def _stream(
    subject: Subject, asked: Asked, backend: str, method: str, target: Path,
    signals: tuple[str, ...], as_json: bool,
) -> None:  # fmt: skip
    """Run into files, and tell what is in them."""
    done = streamed(subject, asked, backend, method, with_folder(target), signals)
    chosen = subject.differential
    case = asked.scenario or (chosen.scenario if chosen else "run")
    paths = [path for path in (done.path, done.events_path) if path is not None]
    if as_json:
        print_json({
            "model": subject.name,
            "scenario": case if chosen else None,
            "parameters": asked.parameters,
            "samples": done.samples,
            "events": done.events,
            "final": done.final,
            "files": paths,
        })  # fmt: skip
        return
    click.echo(f"{subject.name}, {case}\n\n{done.samples} samples, {done.events} events\n")
    for path in paths:
        written(path)


def _data(subject: Subject, case: str, asked: Asked, result: Result) -> dict[str, object]:
    """What a run gave: its events, and every signal at its end."""
    return {
        "model": subject.name,
        "scenario": case if subject.differential else None,
        "parameters": asked.parameters,
        "until": result.time[-1],
        "samples": len(result.time),
        "events": [event._asdict() for event in result.events],
        "final": {name: column[-1] for name, column in result.columns.items()},
    }
