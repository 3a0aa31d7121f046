"""Commands that come to rest at zero, where a switch that is on stays on: a trap of commands of 0 and 1."""

import warnings

import numpy as np

from bondgraph.errors import ModelWarning
from codegen.model.commands import Command
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.record.result import Result


def tell_resting(model: ClosedModel, done: Result) -> None:
    """Warn whoever called what calls this of switches that are on at two samples with a command of zero."""
    for one in model.commands:
        on = done[str(one.name)] == 1
        idle = on & (_values(one, done) == 0)
        both = np.flatnonzero(idle[:-1] & idle[1:])
        if len(both):
            warnings.warn(
                f"switch {one.name!r} stays on while its command {one.on} rests at zero, from "
                f"t = {done.time[both[0]]:.9g} on: it turns off as {one.off} rises above zero. For a command "
                f"of 0 and 1 write on='{one.on} - 1/2'",
                ModelWarning,
                stacklevel=3,
            )


def _values(one: Command, done: Result) -> Array:
    """The command at each sample."""
    given = one.value(done.time, *(done[name] for name in one.signals))
    return np.broadcast_to(np.asarray(given, dtype=float), done.time.shape)
