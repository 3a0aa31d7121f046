"""A sweep's runs in which a switch stays on while its command rests at zero."""

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from bondgraph.algebra.atoms import normal
from bondgraph.errors import ModelWarning
from codegen.family import Family
from codegen.inputs.signal import Signal
from codegen.inputs.signals import as_signal
from codegen.inputs.swept import Swept, settled
from codegen.model.commands import Command, commands
from codegen.model.exact_values import exact_parameters
from codegen.model.resting import Rest, first_rests, rests
from codegen.numbers.arrays import Array
from codegen.sweeps.design import Table
from codegen.sweeps.job import Job

TOGETHER = 1_000_000
"""So many values of a command are looked at together."""


@dataclass(frozen=True)
class Resting:
    """A switch that rests so in ``runs``, first in the run of this index."""

    rest: Rest
    first: int
    runs: int

    def told(self, of: int) -> str:
        """For people, of so many runs."""
        one = self.rest.command
        return (
            f"in {self.runs} of {of} runs switch {one.name!r} stays on while its command {one.on} rests at "
            f"zero, first in run {self.first} from t = {self.rest.time:.9g} on: {self.rest.way_out}"
        )


def tell_all_resting(job: Job, runs: Table) -> None:
    """Warn whoever called what calls this, once for each switch."""
    for one in resting(job, runs):
        warnings.warn(one.told(len(runs)), ModelWarning, stacklevel=3)


def resting(job: Job, runs: Table) -> list[Resting]:
    """The switches that rest in any run, from their inputs alone; swept numbers are constants of commands."""
    if not isinstance(job.model, Family):
        return []
    exact = exact_parameters(job.model.parameters)
    kept = {name: value for name, value in exact.items() if name not in job.names}
    told = commands(job.model.equations, kept)
    times = [
        _by_function(job, runs, one) if callable(job.inputs) else _alike(job, runs, one)
        for one in told
    ]
    return [
        Resting(Rest(one, float(own[at[0]])), int(at[0]), len(at))
        for one, own in zip(told, times, strict=True)
        if len(at := np.flatnonzero(np.isfinite(own)))
    ]


def _alike(job: Job, runs: Table, one: Command) -> Array:
    """When the switch comes to rest in each run, where inputs differ in their sizes alone."""
    told: Any = job.inputs
    given = _named(told or {})
    units, columns = dict[str, Signal](), dict[str, str]()
    for name in one.signals:
        value = Swept(name) if name in job.names else given.get(name)
        if value is None:
            return np.full(len(runs), np.nan)
        columns |= {name: value.name} if isinstance(value, Swept) else {}
        units[name] = value.signal if isinstance(value, Swept) else as_signal(value, name)
    # Of runs with the same numbers one is looked at.
    table = np.column_stack([np.zeros(len(runs)), *(runs.column(columns[n]) for n in columns)])
    rows, place = np.unique(table, axis=0, return_inverse=True)
    found = []
    for part in np.array_split(rows, max(len(rows) * len(job.time) // TOGETHER, 1)):
        sizes = dict(zip(columns, part.T[1:], strict=True))
        sized = {name: (units[name], sizes.get(name, np.ones(len(part)))) for name in one.signals}
        times = first_rests(one, sized, job.time, one.name in job.initially_on)
        found.append(np.broadcast_to(times, len(part)))
    return np.concatenate(found)[place.reshape(-1)]


def _by_function(job: Job, runs: Table, one: Command) -> Array:
    """When it does, where a function gives the inputs of each run; a run without any fails by itself."""
    found, time = np.full(len(runs), np.nan), job.time
    for at in range(len(runs)):
        values = dict(zip(runs.names, runs.row(at), strict=True))
        try:
            given: Any = job.inputs
            own = {**_named(settled(given(values) or {}, values)), **values}
            signals = {name: as_signal(own[name], name) for name in one.signals}
        except Exception:  # noqa: BLE001 - the caller's code, told by whoever does the run
            continue
        for rest in rests((one,), signals, time, job.initially_on):
            found[at] = rest.time
    return found


def _named(given: Mapping[str, Any]) -> dict[str, Any]:
    """Inputs by their names as the model has them."""
    return {str(normal(name)): one for name, one in given.items()}
