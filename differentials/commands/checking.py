"""``check``: a graph judged, with the way out of each finding."""

from collections.abc import Mapping
from dataclasses import asdict

import click

import bondgraph as bg
import differentials.commands.options as options
from differentials.commands.printing import print_json
from differentials.commands.subject import Subject


@options.command(
    "What is to be asked about a graph: doubts, hints, strokes.",
    "check alsd",
    "check examples/oscillator.json --set m=2 --set k=800 --set b=4",
    "check examples/oscillator.json --json",
)
@options.subject
@options.variants
@options.parameters
@options.as_json
def check(
    subject: Subject, halfshafts: bool, unlumped: bool, on: tuple[str, ...], off: tuple[str, ...],
    parameters: Mapping[str, float], as_json: bool,
) -> int:  # fmt: skip
    """What is to be asked about the graph of MODEL: what most likely is a mistake, what could be simpler.

    Strokes that a file's bonds have as "stroke": "tail" or "head" are judged one by one. It leaves
    with status 1 where there are doubts, so that a script can tell; hints alone are no doubts.
    """
    found = bg.check(subject.graph(halfshafts, unlumped, on, off), parameters or None)
    if as_json:
        print_json({"findings": [asdict(one) for one in found.findings],
                    "strokes": [asdict(one) for one in found.strokes]})  # fmt: skip
    else:
        click.echo(str(found))
    return int(bool(found.doubts))
