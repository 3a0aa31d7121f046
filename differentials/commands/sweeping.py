"""``sweep``: a model over a grid of its numbers."""

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import click

import bondgraph as bg
import codegen
import differentials.commands.options as options
from bondgraph.writing import write_bytes
from codegen.record.files import write_mat, write_parquet
from codegen.record.tables import write_columns
from differentials.aligned import table
from differentials.commands.grids import (
    FORM,
    GRID,
    RUBBING,
    STOPPING,
    SWITCHING,
    measure_options,
    measures,
)
from differentials.commands.names import FileOf, check_names
from differentials.commands.options import Asked
from differentials.commands.preparing import prepare
from differentials.commands.printing import print_json, with_folder, written
from differentials.commands.subject import Subject
from differentials.prepared import Prepared

SHOWN = 50
"""Rows of a table on the screen."""


@options.command(
    "sweep alsd --grid k=4300:17200:3 --peak tau_k1 --first clutch:stick --workers 0",
    "sweep alsd --grid k=4300,8600 --grid b=0:4:2 --final omega_1 --store runs -o sweep.csv",
    "sweep examples/oscillator.json --set m=2 --set b=4 --grid k=200:800:4 --initial v=1 "
    "--input F=0 --peak F_k --workers 0 --json",
)
@options.subject
@options.assigned(
    "--grid",
    "grid",
    GRID,
    "Numbers of a parameter, an initial state or a constant "
    "input: FROM:TO:COUNT, FROM:TO:COUNT:log or a list A,B,C.",
)
@measure_options
@options.run_options
@options.backend
@click.option(
    "--workers",
    type=click.IntRange(min=0),
    metavar="COUNT",
    help="Processes to run in, one for each core by default; 0: none but this one.",
)
@click.option(
    "--store",
    type=click.Path(file_okay=False, path_type=Path),
    metavar="DIR",
    help="Keep finished runs here; the same command goes on where it was.",
)
@click.option(
    "-o",
    "target",
    type=FileOf(".csv", ".nc", ".parquet", ".mat"),
    metavar="FILE",
    help="Write the table as .csv, .parquet or .mat, or as a data set with an axis for each name (.nc).",
)
@options.as_json
def sweep(
    subject: Subject, grid: Mapping[str, list[float]], asked: Asked,
    backend: str, workers: int | None, store: Path | None, target: Path | None, as_json: bool,
    **measured: tuple[str, ...],
) -> None:  # fmt: skip
    """Run MODEL once for each combination of numbers, and keep what is measured.

    All other options are those of `bondgraph simulate`. Failed runs are told on standard error, and the
    status is 1.
    """
    if not grid:
        raise click.UsageError(f"give at least one --grid {FORM}, as in --grid k=4300:17200:5")
    ready = prepare(subject, asked, grid)
    family = codegen.Family(ready.equations, _with_swept(ready, grid), ready.laws, backend)
    check_names(
        grid, (*family.parameters, *family.states, *family.inputs), "parameter, state or input"
    )
    kept = _measures(family, ready, measured)
    found = _swept(family, grid, ready, kept, workers, store)
    if target is not None:
        _save(found, target)
    if as_json:
        print_json(_data(found) | {"files": [target] if target else []})
    else:
        click.echo(_text(found))
        if target is not None:
            written(target)
    for failure in found.failed:
        numbers = ", ".join(f"{name} = {value:g}" for name, value in failure.values.items())
        click.echo(f"run {failure.run} ({numbers}) failed: {failure.message}", err=True)
    if found.failed:
        click.get_current_context().exit(1)


def _with_swept(ready: Prepared, grid: Mapping[str, list[float]]) -> dict[str, object]:
    """The numbers, with the first of each parameter that only the grid gives."""
    free = {name.name for name in ready.equations.parameters}
    swept = {name: values[0] for name, values in grid.items() if name in free}
    return {**swept, **ready.parameters}


def _measures(
    family: codegen.Family, ready: Prepared, measured: Mapping[str, tuple[str, ...]]
) -> dict[str, Any]:
    signals = [*map(str, ready.equations.signals), *map(str, ready.equations.integrals)]
    ports: dict[Any, Sequence[str]] = {
        one.name: STOPPING if one.switch.stops else SWITCHING
        for one in ready.equations.plain_switches
    }
    taken = [one.switch.transition for one in ready.equations.switches]
    for machine in ready.equations.machines:
        ports[machine.name] = [t.words for t in taken if t and t.machine == machine]
    known = dict.fromkeys((*family.states, *family.inputs, *signals, *map(str, ports)))
    declared = {**ready.equations.laws, **ready.laws}
    rubbing = [node for node, law in declared.items() if isinstance(law, bg.DryFriction)]
    return measures(measured, known, {**dict.fromkeys(rubbing, RUBBING), **ports})


def _swept(
    family: codegen.Family, grid: Mapping[str, list[float]], ready: Prepared, kept: dict[str, Any],
    workers: int | None, store: Path | None,
) -> codegen.Sweep:  # fmt: skip
    try:
        return codegen.sweep(
            family, codegen.Grid(grid), ready.times, kept,
            {name: value for name, value in ready.initial.items() if name not in grid},
            {name: value for name, value in ready.inputs.items() if name not in grid},
            workers=workers, store=store, progress=sys.stderr.isatty(),
            initially_on=ready.initially_on,
        )  # fmt: skip
    except codegen.SweepInterrupted as stopped:
        way = "the same command goes on there" if store else "with --store DIR they would be kept"
        raise click.ClickException(f"interrupted: {stopped}; {way}") from None


def _save(found: codegen.Sweep, target: Path) -> None:
    with_folder(target)
    columns = found.table()
    names, arrays = [*columns], [*columns.values()]
    match target.suffix.lower():
        case ".nc":
            write_bytes(target, bytes(found.to_xarray().to_netcdf(engine="scipy")))
        case ".parquet":
            write_parquet(target, names, arrays, {})
        case ".mat":
            write_mat(target, names, arrays, {})
        case _:
            write_columns(target, names, arrays)


def _data(found: codegen.Sweep) -> dict[str, object]:
    """The table as a list of runs."""
    columns = found.table()
    rows = zip(*columns.values(), strict=True)
    return {
        "runs": [dict(zip(columns, row, strict=True)) for row in rows],
        "failed": [failure._asdict() for failure in found.failed],
    }


def _text(found: codegen.Sweep) -> str:
    columns = found.table()
    rows = [tuple(columns)]
    rows += [tuple(f"{value:.6g}" for value in row) for row in zip(*columns.values(), strict=True)]
    more = len(rows) - 1 - SHOWN
    text = table(rows[: SHOWN + 1])
    return f"{text}\n... and {more} more; -o FILE.csv writes all" if more > 0 else text
