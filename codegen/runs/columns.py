"""Samples as columns by name."""

from codegen.arrays import Array
from codegen.model.closed import ClosedModel
from codegen.runs.observer import Observer
from codegen.runs.snapshots import Snapshots


def named_columns(
    model: ClosedModel, times: Array, found: Snapshots
) -> tuple[dict[str, Array], Observer]:
    """The samples of what a run records, by name, and what works out all other signals."""
    program = model.program
    groups = (
        (program.states, found.x),
        (program.law_states, found.z),
        (program.inputs, found.u),
        (program.external, found.external),
        (program.readings, found.y),
    )
    columns: dict[str, Array] = {}
    for names, table in groups:
        for at, name in enumerate(names):
            columns.setdefault(name.name, table[:, at].copy())
    dx = found.rate[:, : len(program.states)]
    if not program.varying:
        dx = dx + found.du @ model.constant.R.T
    return columns, Observer(times, model, columns, found.x, dx, found.u, found.du)
