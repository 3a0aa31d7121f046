"""Commands that come to rest at zero, where a switch that is on stays on: a trap of commands of 0 and 1."""

import warnings

import numpy as np
import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.errors import ModelWarning
from bondgraph.reduce.switch_port import SwitchPort
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.record.result import Result


def tell_resting(model: ClosedModel, done: Result) -> None:
    """Warn whoever called what calls this of switches that are on at two samples with a command of zero."""
    for one in model.equations.switches:
        if one.guard != "commanded" or one.off != -one.on:
            continue
        on = done[str(one.name)] == 1
        idle = on & (_command(model, one, done) == 0)
        both = np.flatnonzero(idle[:-1] & idle[1:])
        if len(both):
            warnings.warn(
                f"switch {one.name!r} stays on while its command {one.on} rests at zero, from "
                f"t = {done.time[both[0]]:.9g} on: it turns off as {one.off} rises above zero. For a command "
                f"of 0 and 1 write on='{one.on} - 1/2'",
                ModelWarning,
                stacklevel=3,
            )


def _command(model: ClosedModel, one: SwitchPort, done: Result) -> Array:
    """The command at each sample."""
    names = sorted(one.on.free_symbols - {TIME} - {sp.Symbol(n) for n in model.parameters}, key=str)
    command = one.on.subs({sp.Symbol(n): value for n, value in model.parameters.items()})
    given = sp.lambdify([TIME, *names], command, "numpy")(
        done.time, *(done[name.name] for name in names)
    )
    return np.broadcast_to(np.asarray(given, dtype=float), done.time.shape)
