"""``check``: a graph judged, with the way out of each finding."""

from collections.abc import Hashable, Mapping
from dataclasses import asdict

import click

import bondgraph as bg
import differentials.commands.options as options
from differentials.commands.printing import print_json
from differentials.commands.subject import Subject, nodes_called

ALL = "all"
"""In place of a storage's name: all of them."""


@options.command(
    "check alsd",
    "check examples/oscillator.json --set m=2 --set k=800 --set b=4",
    "check examples/oscillator.json --json",
    "check examples/oscillator.json --derivative all",
)
@options.subject
@options.variants
@options.parameters
@click.option(
    "--derivative",
    "derivative",
    multiple=True,
    metavar="STORAGE",
    help="Prefer derivative causality of this storage, or of 'all'; may be repeated.",
)
@options.as_json
def check(
    subject: Subject, halfshafts: bool, unlumped: bool, on: tuple[str, ...], off: tuple[str, ...],
    parameters: Mapping[str, float], derivative: tuple[str, ...], as_json: bool,
) -> int:  # fmt: skip
    """What is to be asked about the graph of MODEL: what most likely is a mistake, what could be simpler.

    Strokes that a file's bonds have as "stroke": "tail" or "head" are judged one by one. It leaves
    with status 1 where there are doubts, so that a script can tell; hints alone are no doubts.
    """
    graph = subject.graph(halfshafts, unlumped, on, off)
    chosen: bool | list[Hashable] = ALL in derivative and ALL not in graph
    if derivative and not chosen:
        storages = [node for node in graph if str(graph.nodes[node].get("kind")) in ("I", "C")]
        chosen = nodes_called(derivative, storages, "storage")
    found = bg.check(graph, parameters or None, derivative=chosen)
    if as_json:
        print_json({"findings": [asdict(one) for one in found.findings],
                    "strokes": [asdict(one) for one in found.strokes]})  # fmt: skip
    else:
        click.echo(str(found))
    return int(bool(found.doubts))
