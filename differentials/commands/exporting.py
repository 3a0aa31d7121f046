"""``export``: a model outside the toolkit, as Python, C or a functional mock-up unit."""

import shlex
from pathlib import Path

import click

import differentials.commands.options as options
from codegen.exports import TARGETS
from codegen.fmu.binaries import PLATFORMS
from codegen.modes.steps import INTEGRATORS
from differentials.commands.names import OneOf, check_names
from differentials.commands.options import Asked
from differentials.commands.preparing import prepare
from differentials.commands.printing import print_json
from differentials.commands.subject import Subject
from differentials.exporting import write


@options.command(
    "export alsd --to python --scenario fig11 --set I_1=0.008 --out out",
    "export alsd --to c --out out",
    "export examples/oscillator.json --to c --set m=2 --set k=800 --set b=4 --initial v=1",
)
@options.subject
@click.option(
    "--to",
    "target",
    type=OneOf(tuple(TARGETS), "target"),
    metavar="TARGET",
    required=True,
    help=f"What to write: {', '.join(TARGETS)}.",
)
@options.run_options
@click.option(
    "--platforms",
    metavar="LIST",
    help=f"Of a unit: all, or some of {','.join(PLATFORMS)}; this machine's by default.",
)
@click.option(
    "--integrator",
    type=OneOf(INTEGRATORS, "integrator"),
    metavar="METHOD",
    default=INTEGRATORS[0],
    show_default=True,
    help=f"Of fixed steps: {' or '.join(INTEGRATORS)}, the last implicit, for stiff laws.",
)
@options.folder
@options.as_json
def export(
    subject: Subject,
    target: str,
    asked: Asked,
    platforms: str | None,
    integrator: str,
    out: Path,
    as_json: bool,
) -> None:
    """Write MODEL with its numbers, its start and its inputs as Python, C or an FMU."""
    if platforms is not None and not TARGETS[target].compiled:
        compiled = " and ".join(f"--to {one.name}" for one in TARGETS.values() if one.compiled)
        raise click.UsageError(f"--platforms is for {compiled}; leave it out")
    chosen = (
        platforms if platforms in (None, "all") else [one.strip() for one in platforms.split(",")]
    )
    if isinstance(chosen, list):
        check_names(chosen, list(PLATFORMS), "platform")
    paths = write(subject.name, target, prepare(subject, asked), out, chosen, integrator)
    if as_json:
        print_json({"model": subject.name, "target": target, "files": paths})
        return
    for path in paths:
        click.echo(path)
    last = paths[-1]
    told = {"folder": last.parent, "file": last.name, "path": last, "name": subject.name}
    quoted = {key: shlex.quote(str(value)) for key, value in told.items()}
    click.echo(f"\nNext: {TARGETS[target].following.format(**quoted)}")
