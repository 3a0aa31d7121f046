"""``modes`` and ``linear``: a model for small deviations, in numbers."""

from collections.abc import Iterable, Mapping
from typing import Any

import click
import numpy as np
from numpy.typing import NDArray

import bondgraph as bg
import differentials.commands.options as options
from bondgraph.analyse.state_space import StateSpace
from differentials.aligned import table
from differentials.commands.names import check_names
from differentials.commands.options import MODE, START, Command
from differentials.commands.printing import print_json
from differentials.commands.subject import Subject, nodes_called
from differentials.identification import numbers
from differentials.model import model
from differentials.report import modes_text

SPEED = 80.0
"""Wheel speed [rad/s] at which tires are linearised."""


def _options(command: Command) -> Command:
    """What says which linear model is meant."""
    given = (
        options.subject,
        options.parameters,
        options.laws,
        options.assigned("--at", "at", START, "A signal at the operating point."),
        options.assigned("--rate", "rates", START, "How fast an input changes there, 0 by default."),
        click.option("--speed", type=click.FloatRange(min=0, min_open=True), metavar="RAD/S",
                     help=f"Wheel speed of a differential's tires, {SPEED:g} rad/s by default."),
        click.option("--stuck", multiple=True, metavar="PORT",
                     help="A friction port that sticks. May be repeated."),
        options.reads,
        options.on,
        options.assigned("--mode", "mode", MODE, "on or off of a switch, stick or slip of friction."),
        options.as_json,
    )  # fmt: skip
    for option in reversed(given):
        command = option(command)
    return command


def _linear(
    subject: Subject, parameters: Mapping[str, float], laws: Mapping[str, Any],
    at: Mapping[str, float], rates: Mapping[str, float], speed: float | None, stuck: tuple[str, ...],
    reads: tuple[str, ...], on: tuple[str, ...], mode: Mapping[str, str],
) -> StateSpace:  # fmt: skip
    if subject.differential is None:
        if speed is not None:
            raise bg.SignalError(
                "--speed is for the catalog's differentials; use --at SIGNAL=NUMBER"
            )
        equations = bg.derive(subject.graph())
        ports = [port.element.name for port in equations.ports]
        held, told = nodes_called(stuck, ports, "port"), _told(subject, ports, on, mode)
        there = bg.linearize(equations, at, laws, reads, held, mode=told, rates=rates)
        return there.numeric(parameters)
    full = model(subject.name, laws)
    subject.graph(on=on)
    check_names(parameters, (*full.parameters, *full.starts), "parameter")
    held = nodes_called(stuck, full.differential.clutches, "clutch")
    values = numbers(full, parameters, SPEED if speed is None else speed)
    nodes = nodes_called(mode, full.differential.clutches, "clutch")
    told = dict(zip(nodes, mode.values(), strict=True))
    there = bg.linearize(full.equations, at, full.laws, reads, held, mode=told, rates=rates)
    return there.numeric(values)


def _told(
    subject: Subject, ports: Iterable[Any], on: Iterable[str], mode: Mapping[str, str]
) -> dict[Any, str]:
    """Every node's mode; switches that neither --on nor --mode names are off."""
    switches = subject.switches()
    lit = dict.fromkeys(nodes_called(on, switches, "switch"), "on")
    nodes = nodes_called(mode, [*switches, *ports], "switch or port")
    told = dict(zip(nodes, mode.values(), strict=True))
    both = [name for name in lit if name in told]
    if both:
        raise bg.StructureError(f"{both[0]!r} is in --on and in --mode; keep one")
    return dict.fromkeys(switches, "off") | lit | told


@options.command(
    "modes alsd",
    "modes alsd --stuck clutch --set k=4300 --json",
    "modes examples/oscillator.json --set m=2 --set k=800 --set b=4",
)
@_options
def modes(as_json: bool, **which: Any) -> None:
    """Frequency, damping, pole and shape of every mode of MODEL."""
    found = _linear(**which)
    if not as_json:
        click.echo(modes_text(found))
        return
    print_json(
        [
            {"damped_frequency": mode.damped_frequency, "frequency": mode.frequency,
             "damping": mode.damping, "pole": mode.pole, "shape": mode.shape}
            for mode in found.modes()
        ]
    )  # fmt: skip


@options.command(
    "linear alsd --speed 20",
    "linear passive --json",
    "linear examples/oscillator.json --set m=2 --set k=800 --set b=4",
)
@_options
def linear(as_json: bool, **which: Any) -> None:
    """MODEL for small deviations: x' = P x + Q u + R u', y = F x + D u + G u', in numbers."""
    found = _linear(**which)
    names = {part: getattr(found, part) for part in ("states", "inputs", "outputs")}
    matrices: dict[str, NDArray[np.float64]] = {name: getattr(found, name) for name in "PQRFDG"}
    if as_json:
        print_json({**names, **matrices, "poles": found.poles()})
        return
    click.echo("x' = P x + Q u + R u',   y = F x + D u + G u';   what is zero is left out")
    across = {
        "P": "states",
        "Q": "inputs",
        "R": "inputs",
        "F": "states",
        "D": "inputs",
        "G": "inputs",
    }
    for name, matrix in matrices.items():
        if matrix.any():
            rows = names["states" if name in "PQR" else "outputs"]
            click.echo("\n" + _matrix(name, matrix, rows, names[across[name]]))
    poles = ", ".join(
        f"{p.real:.4g}{p.imag:+.4g}i" if p.imag else f"{p.real:.4g}" for p in found.poles()
    )
    click.echo(f"\npoles [1/s]: {poles or 'none'}")


def _matrix(
    name: str, matrix: NDArray[np.float64], rows: tuple[str, ...], columns: tuple[str, ...]
) -> str:
    """A matrix with the names of its rows and columns."""
    lines = [(name, *columns)]
    lines += [
        (row, *(f"{value:.6g}" for value in values))
        for row, values in zip(rows, matrix, strict=True)
    ]
    return table(lines)
