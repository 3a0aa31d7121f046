"""``draw`` and ``convert``: the graph itself, as a picture or a file."""

from pathlib import Path
from typing import Literal

import click

import bondgraph as bg
import differentials.commands.options as options
from differentials.commands.names import FileOf
from differentials.commands.printing import with_folder, written
from differentials.commands.subject import ENDINGS, Subject


@options.command(
    "draw alsd",
    "draw alsd -o alsd.svg",
    "draw alsd --names --numbers --layout horizontal -o alsd.svg",
    "draw examples/oscillator.json -o oscillator.svg",
)
@options.subject
@options.variants
@click.option("--powers", is_flag=True, help="With the names of efforts and flows.")
@click.option("--no-values", is_flag=True, help="Without the elements' values.")
@click.option("--names", is_flag=True, help="With the elements' names beside their values.")
@click.option("--numbers", is_flag=True, help="With the bonds' numbers.")
@click.option("--no-signals", is_flag=True, help="Without what elements read of each other.")
@click.option(
    "--layout",
    type=click.Choice(["horizontal", "vertical"]),
    help="From left to right, as chains are drawn, or from top to bottom.",
)
@click.option(
    "-o",
    "target",
    type=FileOf(".svg", ".png", ".pdf"),
    metavar="FILE",
    help="A picture to write: .svg, .png or .pdf; by default it is drawn as text.",
)
def draw(
    subject: Subject, halfshafts: bool, unlumped: bool, on: tuple[str, ...], off: tuple[str, ...],
    powers: bool, no_values: bool, names: bool, numbers: bool, no_signals: bool,
    layout: Literal["horizontal", "vertical"] | None, target: Path | None,
) -> None:  # fmt: skip
    """The bond graph of MODEL with its causal strokes, in the terminal or as a picture."""
    shown = bg.assign_causality(subject.graph(halfshafts, unlumped, on, off))
    drawn = bg.drawing(
        shown, powers=powers, values=not no_values, names=names, numbers=numbers,
        signals=not no_signals, layout=layout,
    )  # fmt: skip
    if target is None:
        click.echo(drawn.text())
    else:
        drawn.save(with_folder(target))
        written(target)


@options.command(
    "convert alsd -o alsd.json",
    "convert alsd --halfshafts -o alsd.graphml",
    "convert examples/oscillator.json -o oscillator.graphml",
)
@options.subject
@options.models
@click.option(
    "-o",
    "target",
    type=FileOf(*ENDINGS),
    metavar="FILE",
    required=True,
    help="The file to write: .json or .graphml.",
)
def convert(subject: Subject, halfshafts: bool, unlumped: bool, target: Path) -> None:
    """MODEL as a file, to be changed and read again: JSON or GraphML."""
    as_it_is = subject.file is not None and not (halfshafts or unlumped)
    declared = subject.file if as_it_is else subject.graph(halfshafts, unlumped)
    write = bg.write_json if target.suffix.lower() == ".json" else bg.write_graphml
    write(declared, with_folder(target))
    written(target)
