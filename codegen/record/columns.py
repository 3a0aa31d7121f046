"""Samples as columns by name."""

from collections.abc import Collection, Mapping, Sequence
from types import MappingProxyType

import numpy as np

from bondgraph.errors import SimulationError
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array, read_only
from codegen.program.layout import EXTERNAL, INPUTS, LAW_STATES, NAMES, READINGS, STATES
from codegen.program.records import FrictionPort, Program
from codegen.record.observer import Observer
from codegen.record.snapshots import Snapshots


def column_places(program: Program) -> dict[str, tuple[int, int]]:
    """For each column of a run its part of an instant and its place in that, in the order of columns."""
    groups = (
        (STATES, program.states, None),
        (LAW_STATES, program.law_states, None),
        (INPUTS, program.inputs, set(program.shown_inputs)),
        (EXTERNAL, program.asked, None),
        (READINGS, program.readings, set(program.shown)),
    )
    found: dict[str, tuple[int, int]] = {}
    for part, names, shown in groups:
        for at, name in enumerate(names):
            if shown is None or at in shown:
                found.setdefault(name.name, (part, at))
    return found


def named_columns(
    model: ClosedModel, times: Array, found: Snapshots
) -> tuple[Mapping[str, Array], Observer]:
    """The samples of what a run records, by name, and what works out all other signals; read-only arrays.

    Raises `SimulationError`, with the time, where one is not finite, though all that laws give is.
    """
    program = model.program
    columns = {
        name: read_only(getattr(found, NAMES[part])[:, at].copy())
        for name, (part, at) in column_places(program).items()
    }
    # What laws give may be infinite where the rates are not, as the potential of what is used up.
    infinite = np.isinf(found.u).any(axis=1) & ~np.isnan(found.u).any(axis=1)
    told = {name.name for name in (*program.states, *program.law_states)}
    _check_finite(
        times,
        {
            name: column if name in told else np.where(infinite, 0.0, column)
            for name, column in columns.items()
        },
        told,
    )
    dx = found.rate[:, : len(program.states)]
    if not program.varying:
        dx = dx + found.du @ model.constant.R.T
    known = MappingProxyType(columns)
    x, dx, u, du = map(read_only, (found.x, dx, found.u, found.du))
    return known, Observer(times, model, known, x, dx, u, du)


def table_names(program: Program) -> tuple[str, ...]:
    """The columns that a table of a run holds, switches included, in order."""
    switches = (str(port.name) for _, port in _switches(program))
    names = dict.fromkeys((*column_places(program), *switches))
    return tuple(name for name in names if name not in program.inner)


def _switches(program: Program) -> list[tuple[int, FrictionPort]]:
    """The ports that have a column, 1 while they are on, with their places."""
    return [
        (at, port)
        for at, port in enumerate(program.friction)
        if port.switch is not None and not port.slides and port.transition is None
    ]


def known_names(program: Program) -> tuple[str, ...]:
    """All that a run can be asked for by name: its columns, switches, and every signal of the graph."""
    equations = program.equations
    switches = (p.name for p in program.friction if p.switch is not None and not p.slides)
    inputs = (program.inputs[at] for at in program.shown_inputs)
    readings = (program.readings[at] for at in program.shown)
    signals = (*equations.signals, *equations.held)
    names = (*program.states, *program.law_states, *inputs, *program.asked, *readings, *switches)
    return tuple(dict.fromkeys(map(str, (*names, *signals))))


def _check_finite(times: Array, columns: Mapping[str, Array], states: Collection[str]) -> None:
    """Refuse numbers that are not finite, by the first that is none."""
    wrong = {name: ~np.isfinite(column) for name, column in columns.items()}
    first = {name: int(np.argmax(flags)) for name, flags in wrong.items() if flags.any()}
    if first:
        name = min(first, key=lambda one: first[one])
        at = first[name]
        grown = any(not np.isfinite(columns[one][at]) for one in states if one in columns)
        if np.isnan(columns[name][at]) and not grown:
            raise SimulationError(
                f"at t = {times[at]:.9g} {name} has no value: a law that it comes from is asked for one "
                "where it has none"
            )
        raise SimulationError(
            f"at t = {times[at]:.9g} {name} is not finite: it has grown past the largest number in double "
            "precision; run it for a shorter time, or in larger units"
        )


def listed_columns(
    columns: Mapping[str, Array], program: Program
) -> tuple[Mapping[str, Array], Mapping[str, Array]]:
    """What a table of a run holds; and what parts of nodes of signals have, which has to be asked for."""
    inner = program.inner
    shown = {name: column for name, column in columns.items() if name not in inner}
    rest = {name: column for name, column in columns.items() if name in inner}
    return MappingProxyType(shown), MappingProxyType(rest)


def with_switches(
    columns: Mapping[str, Array], program: Program, modes: Sequence[Mode]
) -> Mapping[str, Array]:
    """The columns, and one for each switch: 1 while it is on, 0 while it is off."""
    found = dict(columns)
    for at, port in _switches(program):
        assert port.switch is not None
        told = {sign: float(port.switch.is_on(sign)) for sign in (-1, 0, 1)}
        found[str(port.name)] = read_only(np.array([told[mode[at]] for mode in modes]))
    return MappingProxyType(found)
