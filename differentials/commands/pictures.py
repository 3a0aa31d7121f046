"""Runs as files: tables, data sets, and pictures of any model's signals."""

import re
from collections.abc import Callable, Mapping
from pathlib import Path

import click

import bondgraph as bg
import codegen
from codegen import Result
from differentials.commands.printing import with_folder, written
from differentials.commands.subject import Subject
from differentials.control.manoeuvres import manoeuvres
from differentials.figures import Figure, draw, panels, save_picture
from differentials.loop_figures import loop_panels

FORMATS = (".csv", ".nc", ".parquet", ".mat", ".png")
"""What a run may be written as."""


def alike(names: Mapping[str, object]) -> list[list[str]]:
    """Names in groups that begin alike, and so, in the notation of bond graphs, have one unit.

    >>> alike(dict.fromkeys(["omega_1", "tau_e", "omega_2", "v"]))
    [['omega_1', 'omega_2'], ['tau_e'], ['v']]
    """
    groups: dict[str, list[str]] = {}
    for name in names:
        groups.setdefault(re.split(r"[_\d]", name, maxsplit=1)[0] or name, []).append(name)
    return list(groups.values())


def picture(subject: Subject, result: Result, case: str, path: Path) -> None:
    """Draw a run into a PNG: a differential's as the paper does, others signal by signal."""
    chosen = subject.differential
    if chosen is None:
        drawn = codegen.panels(result, alike(result.columns), title=subject.title)
        save_picture(drawn, path)
    else:
        driven = manoeuvres.get(case)
        own = panels(chosen) if driven is None else loop_panels(chosen, driven)
        shown = Figure(subject.title, ((subject.name, case),), own)
        draw(shown, (result,), path)


def save(result: Result, target: Path, paint: Callable[[Path], None]) -> None:
    """Write a run as what the file's ending says."""
    with_folder(target)
    match target.suffix.lower():
        case ".csv":
            result.write_csv(target)
        case ".nc":
            result.write_netcdf(target)
        case ".parquet":
            result.write_parquet(target)
        case ".mat":
            result.write_mat(target)
        case _:
            paint(target)


def save_all(
    name: str, tables: Mapping[str, Result], paint: Callable[[Path], None], out: Path
) -> list[Path]:
    """Tables of runs and their picture; without matplotlib the tables alone, and a hint."""
    paths = []
    for label, result in tables.items():
        paths.append(with_folder(out / f"{label}.csv"))
        result.write_csv(paths[-1])
    try:
        paint(out / f"{name}.png")
    except bg.MissingExtraError as error:
        click.echo(f"no picture: {error}", err=True)
        return paths
    return [*paths, out / f"{name}.png"]


def told(paths: list[Path]) -> None:
    """Say which files there are now."""
    for path in paths:
        written(path, "every signal:" if path.suffix == ".csv" else "picture:")
