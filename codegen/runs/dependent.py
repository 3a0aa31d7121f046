"""Starts told by storages that depend on others: what these hold, as values of the states."""

from collections.abc import Mapping

import numpy as np

from bondgraph.errors import SignalError
from bondgraph.reduce.sorting import field_row
from codegen.model.exact_values import at_parameters
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.tuning import TUNING


def dependent_variables(model: ClosedModel) -> tuple[str, ...]:
    """The co-energy variables of dependent linear storages, in declaration order."""
    reduction = model.equations.reduction
    ports = (reduction.structure.ports[at] for at in reduction.dependent)
    return tuple(port.received.name for port in ports if port.element.law is None)


def over_states(model: ClosedModel, initial: Mapping[str, float]) -> dict[str, float]:
    """The same start by states alone.

    States that are not named follow from the dependent variables that are; what is named too often
    shares its momentum, ``x += A^-1 F^T M (w - F x)`` for dependent variables w = F x.

    Raises `SignalError` for a variable that sources or what changes in time rule.
    """
    names = [name.name for name in model.program.states]
    own = {name: value for name, value in initial.items() if name in names}
    told = {n: v for n, v in initial.items() if n in dependent_variables(model)}
    rest = {name: value for name, value in initial.items() if name not in {*own, *told}}
    if not told:
        return dict(initial)
    rows, masses = _rows(model, tuple(told))
    values = np.array(list(told.values()))
    x = np.array([own.get(name, 0.0) for name in names])
    free = [at for at, name in enumerate(names) if name not in own]
    if free:
        left = values - rows @ x
        x[free] += np.linalg.lstsq(rows[:, free], left, rcond=TUNING.nothing)[0]
    left = values - rows @ x
    x += np.linalg.solve(model.constant.A, rows.T @ (masses @ left))
    return {**rest, **dict(zip(names, x.tolist(), strict=True))}


def _rows(model: ClosedModel, names: tuple[str, ...]) -> tuple[Array, Array]:
    """How states rule dependent variables, and the values of these storages."""
    reduction = model.equations.reduction
    ports = [
        at for at in reduction.dependent if reduction.structure.ports[at].received.name in names
    ]
    rows, masses = np.zeros((len(names), len(reduction.states))), np.zeros((len(names),) * 2)
    for at in ports:
        name = reduction.structure.ports[at].received.name
        reading, k = reduction.reading(reduction.structure.rows[at]), names.index(name)
        entries = {j: at_parameters(e, model.parameters) for j, e in reading.F.items()}
        if reading.D or reading.H or reading.K or any(e.free_symbols for e in entries.values()):
            raise SignalError(
                f"initial {name}: that depends on what sources give, or by a ratio that changes; name "
                "states instead"
            )
        for j, entry in entries.items():
            rows[k, j] = float(entry)
        for other, value in field_row(reduction, at):
            if other in ports:
                column = names.index(reduction.structure.ports[other].received.name)
                masses[k, column] = float(at_parameters(value, model.parameters))
    return rows, masses
