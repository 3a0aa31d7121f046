"""From what was typed to what is run: equations, numbers, laws, start, inputs and times."""

from collections.abc import Collection, Hashable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import bondgraph as bg
import codegen
from codegen import Result
from differentials.commands.names import check_names
from differentials.commands.options import Asked
from differentials.commands.subject import Subject, nodes_called
from differentials.control.loop import closed_loop
from differentials.control.manoeuvres import manoeuvres
from differentials.model import model
from differentials.prepared import SAMPLE, Prepared
from differentials.scenarios import named, prepared

LARGEST = 10_000_000
"""Samples of a run beyond which a typing error is more likely than a wish."""


def times(until: float, sample: float) -> NDArray[np.float64]:
    """Points in time [s] from 0 to the end, as far apart as asked for, or a little less."""
    count = until / sample
    if count > LARGEST:
        raise bg.SignalError(
            f"{count:.3g} samples; give --until {until:g} a longer --sample than {sample:g}"
        )
    return np.linspace(0.0, until, max(int(np.ceil(count * (1 - 1e-12))), 1) + 1)


def prepare(subject: Subject, asked: Asked, free: Collection[str] = ()) -> Prepared:
    """What a run of the differential or of the file's graph needs; ``free``: names that get numbers later.

    Raises `BondGraphError` for names and numbers that don't fit it.
    """
    ready = _prepared(subject, asked, free)
    return _at_rest(ready, asked, free) if asked.equilibrium else ready


def _at_rest(ready: Prepared, asked: Asked, free: Collection[str]) -> Prepared:
    """The same from where all states rest under the inputs at the start."""
    if asked.initial:
        raise bg.SignalError("--equilibrium tells all states at the start; leave --initial out")
    if free:
        raise bg.SignalError(
            "--equilibrium: each run of a sweep rests elsewhere; give --initial, or let the runs begin "
            "with an input that is held for a while"
        )
    simulator = codegen.simulator(ready.equations, ready.parameters, ready.laws)
    point = codegen.trim(simulator, {name: one(0.0) for name, one in ready.inputs.items()})
    return replace(ready, initial={name: point[name] for name in simulator.states})


def _prepared(subject: Subject, asked: Asked, free: Collection[str]) -> Prepared:
    if subject.differential is not None:
        return _from_catalog(subject, asked)
    _refuse_catalog_options(subject, asked)
    first = nodes_called(asked.on, subject.switches(), "switch")
    equations = _equations(subject, asked)
    missing = [name.name for name in equations.parameters if name.name not in asked.parameters]
    _refuse_missing(subject, [name for name in missing if name not in free])
    laws = _laws(asked, [port.element.name for port in equations.ports])
    return Prepared(
        equations, asked.parameters, laws, asked.initial, asked.inputs, _times(asked), tuple(first)
    )


def run(subject: Subject, asked: Asked, backend: str, method: str) -> Result:
    """The run itself."""
    ready, simulator = _simulator(subject, asked, backend)
    return simulator.run(
        ready.times, ready.initial, ready.inputs, method, initially_on=ready.initially_on
    )


def stream(
    subject: Subject, asked: Asked, backend: str, method: str, target: Path, signals: Sequence[str]
) -> codegen.Streamed:
    """The run itself, written to a file as it goes on: these signals, or every column if there are none."""
    ready, simulator = _simulator(subject, asked, backend)
    return simulator.stream(
        target, ready.times, ready.initial, ready.inputs, signals=signals or None, method=method,
        initially_on=ready.initially_on,
    )  # fmt: skip


def _simulator(subject: Subject, asked: Asked, backend: str) -> tuple[Prepared, codegen.Simulator]:
    """What a run needs, and what runs it."""
    ready = prepare(subject, asked)
    simulator = codegen.simulator(ready.equations, ready.parameters, ready.laws, backend)
    _check_given(subject, asked, simulator)
    return ready, simulator


def _equations(subject: Subject, asked: Asked) -> bg.StateEquations:
    """Those of a file's graph; a name in values that --input gives, and --set does not, is an input."""
    equations = bg.derive(subject.graph())
    free = {name.name for name in equations.parameters} - {*asked.parameters}
    names = [name for name in asked.inputs if name in free]
    return bg.derive(subject.graph(), inputs=names) if names else equations


def _laws(asked: Asked, nodes: Iterable[Any]) -> dict[Hashable, object]:
    """Laws by nodes, which need not be texts."""
    known = {str(node): node for node in nodes}
    return {known.get(name, name): law for name, law in asked.laws.items()}


def _times(asked: Asked) -> NDArray[np.float64]:
    until = 1.0 if asked.until is None else asked.until
    return times(until, until / 1000 if asked.sample is None else asked.sample)


def _refuse_missing(subject: Subject, missing: Sequence[str]) -> None:
    if missing:
        more = " ".join(f"--set {name}=NUMBER" for name in missing)
        raise bg.ParameterError(f"{subject.name}: no number for {', '.join(missing)}; add {more}")


def _check_given(subject: Subject, asked: Asked, simulator: codegen.Simulator) -> None:
    """Refuse starts and inputs that the model has not, and inputs of a file that nothing gives."""
    check_names(asked.initial, simulator.states, "state")
    check_names(asked.inputs, simulator.inputs, "input")
    missing = [name for name in simulator.inputs if name not in asked.inputs]
    if missing and subject.differential is None:
        raise bg.SignalError(
            f"{subject.name}: nothing gives {', '.join(missing)}; add --input {missing[0]}=SIGNAL, a law "
            f"with --law NODE=LAW or, if it is a parameter, --set {missing[0]}=NUMBER"
        )


def _from_catalog(subject: Subject, asked: Asked) -> Prepared:
    chosen = subject.differential
    assert chosen is not None
    if asked.on:
        raise bg.StructureError(f"{subject.name} has no switches; leave --on out")
    case = asked.scenario or chosen.scenario
    if case in manoeuvres:
        known: Collection[str] = closed_loop(subject.name, case, laws=asked.laws).parameters
    else:
        full = model(subject.name, asked.laws, asked.backlash)
        known = (*full.parameters, *full.starts)
    check_names(asked.parameters, tuple(known), "parameter")
    ready = prepared(subject.name, case, asked.parameters, asked.laws, asked.backlash)
    if asked.until is not None or asked.sample is not None:
        until = named(case).duration if asked.until is None else asked.until
        ready = replace(ready, times=times(until, asked.sample or SAMPLE))
    initial = {**ready.initial, **asked.initial}
    return replace(ready, initial=initial, inputs={**ready.inputs, **asked.inputs})


def _refuse_catalog_options(subject: Subject, asked: Asked) -> None:
    for given, flag in ((asked.scenario, "--scenario"), (asked.backlash, "--backlash")):
        if given:
            raise bg.SignalError(
                f"{flag} is for the catalog's differentials; {subject.name} comes from a file: use "
                "--initial, --input and --until"
            )
