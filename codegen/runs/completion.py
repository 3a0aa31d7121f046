"""A start: how switches are, and states that were not named completed by what switches hold."""

import warnings
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from bondgraph.errors import ModelWarning
from codegen.inputs.pieces import Piece
from codegen.inputs.signal import Signal
from codegen.model.outside import outside
from codegen.model.snapshot import Mode
from codegen.modes.bounce import check_gaps
from codegen.modes.closed import ClosedModel
from codegen.modes.keeping import kept_by
from codegen.modes.trials import Sight
from codegen.numbers.arrays import Array
from codegen.runs.arguments import initial_values
from codegen.standalone.striking import completing
from codegen.tuning import TUNING

NOTHING: Mapping[str, float] = MappingProxyType({})


@dataclass(frozen=True)
class Beginning:
    """The integrated vector at the first sample, the mode before it, and the states that were completed."""

    s: Array
    mode: Mode
    completed: Mapping[str, float]
    #: What states were moved by, law states last.
    moved: Array


def beginning(
    model: ClosedModel, t: float, s: Array, pieces: Sequence[Piece], on: Collection[object],
    named: Collection[str],
) -> Beginning:  # fmt: skip
    """A run's start from the vector s, in which the states that are not ``named`` are free.

    ``on``: the switches that are on; friction completes nothing.
    """
    still = np.zeros(len(model.program.states) + len(model.program.law_states))
    mode: Mode = model.program.before(on)
    if not model.program.switches:
        return Beginning(s, mode, NOTHING, still)
    here = Sight(model, t, s, pieces)
    _, now = here.evaluated((1,) * len(mode))
    check_gaps(here, mode)
    mode = _as_told(model, model.guards(t, now), mode)
    if 0 not in mode:
        return Beginning(s, mode, NOTHING, still)
    states = [name.name for name in model.program.states]
    free = [j for j, name in enumerate(states) if name not in named]
    hold = model.hold(mode, now.numbers)
    slips = hold.slips(now.x, now.u)
    terms = np.abs(hold.slip_x) @ np.abs(now.x) + np.abs(hold.slip_u) @ np.abs(now.u)
    if not len(free) or (np.abs(slips) <= TUNING.rounding * terms).all():
        return Beginning(s, mode, NOTHING, still)
    moved = completing(hold, now.instant(t), free)
    made, by = s.copy(), still.copy()
    made[free] += moved
    by[free] = moved
    found = {
        states[j]: float(now.x[j] + change) for j, change in zip(free, moved, strict=True) if change
    }
    return Beginning(made, mode, MappingProxyType(found), by)


def started(
    model: ClosedModel, t: float, told: Mapping[str, float], signals: Sequence[Signal],
    on: Collection[object],
) -> tuple[Array, Beginning]:  # fmt: skip
    """The states with which a run begins at t [s], law states last, and where that is.

    ``told``: states by name, all others are zero; ``signals``: of all external inputs.
    """
    names = [name.name for name in (*model.program.states, *model.program.law_states)]
    states = initial_values(told, names)
    start = model.vector(t, states, np.array([signal(t) for signal in signals]))
    with np.errstate(all="ignore"):
        pieces = [signal.piece(t) for signal in signals]
        begun = beginning(model, t, start, pieces, on, {str(name) for name in told})
    return states + begun.moved, begun


def tell_completed(completed: Mapping[str, float]) -> None:
    """Warn, at the user's line, of states that were completed."""
    if completed:
        told = ", ".join(f"{name} = {value:.9g}" for name, value in completed.items())
        warnings.warn(
            f"states that initial does not name follow what switches hold at the start: {told}; name them "
            "in initial to say what is meant",
            ModelWarning,
            stacklevel=outside(),
        )


def tell_all_completed(completed: Mapping[int, Mapping[str, float]], runs: int) -> None:
    """Warn, at the user's line and once, of a sweep's runs whose starts were completed."""
    if completed:
        names = ", ".join(sorted({name for one in completed.values() for name in one}))
        warnings.warn(
            f"in {len(completed)} of {runs} runs states that initial does not name follow what switches hold "
            f"at the start: {names}; completed has their values, name them in initial to say what is meant",
            ModelWarning,
            stacklevel=outside(),
        )


def _as_told(model: ClosedModel, guards: Array, mode: Mode) -> Mode:
    """The mode with those switches changed over whose conditions say so; none takes a transition."""
    result = list(mode)
    for i, switch in enumerate(model.switching):
        if switch is not None and not switch.side and not switch.machine:
            _, at, sign = kept_by(model, mode, i)
            result[i] = 1 - mode[i] if sign * guards[at] < 0 else mode[i]
    return tuple(result)
