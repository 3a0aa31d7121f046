"""Runs as files: tables, data sets, and pictures of any model's signals."""

import re
from pathlib import Path

import click

import bondgraph as bg
from codegen import Result
from differentials.cli.printing import with_folder, written
from differentials.cli.subject import Subject
from differentials.figures import STYLES, Curve, Figure, Panel, draw, panels

FORMATS = (".csv", ".nc", ".png", ".pdf", ".svg")
"""What a run may be written as."""


def signal_panels(result: Result) -> tuple[Panel, ...]:
    """A panel for all columns whose names begin alike, such as omega_1 and omega_2.

    Names that begin alike have, in the notation of bond graphs, the same unit.
    """
    groups: dict[str, list[str]] = {}
    for name in result.columns:
        begin = re.split(r"[_\d]", name, maxsplit=1)[0] or name
        groups.setdefault(begin, []).append(name)
    return tuple(
        Panel(
            begin,
            tuple(
                Curve(name, name.lstrip("_"), *STYLES[at % len(STYLES)])
                for at, name in enumerate(names)
            ),
        )
        for begin, names in groups.items()
    )


def figure(subject: Subject, result: Result, case: str) -> Figure:
    """The picture of a run: as in the paper for its differentials."""
    chosen = subject.differential
    shown = signal_panels(result) if chosen is None else panels(chosen)
    return Figure(subject.title, ((subject.name, case),), shown)


def save(result: Result, drawn: Figure, target: Path) -> None:
    """Write a run as what the file's ending says."""
    with_folder(target)
    match target.suffix.lower():
        case ".csv":
            result.write_csv(target)
        case ".nc":
            result.write_netcdf(target)
        case _:
            draw(drawn, (result,), target)


def save_all(name: str, drawn: Figure, results: tuple[Result, ...], out: Path) -> list[Path]:
    """Tables of all runs and their picture; without matplotlib the tables alone, and a hint."""
    out.mkdir(parents=True, exist_ok=True)
    paths = []
    for (_, case), result in zip(drawn.runs, results, strict=True):
        paths.append(out / f"{name if len(results) == 1 else case}.csv")
        result.write_csv(paths[-1])
    picture = out / f"{name}.png"
    try:
        draw(drawn, results, picture)
    except bg.MissingExtraError as error:
        click.echo(f"no picture: {error}", err=True)
    else:
        paths.append(picture)
    return paths


def told(paths: list[Path]) -> None:
    """Say which files there are now."""
    for path in paths:
        written(path, "every signal:" if path.suffix == ".csv" else "picture:")
