"""Steps of inputs that a model cannot take: where their rate counts they are impulses."""

from collections.abc import Sequence

import numpy as np

from bondgraph.errors import SimulationError
from codegen.inputs.signal import Signal
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.program.records import Program
from codegen.tuning import TUNING


def refuse_impulses(model: ClosedModel, signals: Sequence[Signal], times: Array) -> None:
    """Refuse steps of inputs, a signal for each external one, whose rate an output shows.

    So are steps of inputs that drive a dependent storage by way of a ratio that changes. Raises
    `SimulationError` naming the input, the time and what would see the impulse.
    """
    for at, where in rated_inputs(model).items():
        step = signals[at].first_jump(float(times[0]), float(times[-1]))
        if step is not None:
            raise _impulse(model, at, where, step)


def rated_inputs(model: ClosedModel) -> dict[int, str]:
    """The external inputs whose steps are impulses somewhere, and what sees that, as a clause."""
    program, found = model.program, dict[int, str]()
    shown = _shown_rates(model)
    for at, symbol in enumerate(program.external):
        columns = [j for j, name in enumerate(program.inputs) if name.name == symbol.name]
        known = zip(program.known.inputs, program.known_uses, strict=True)
        columns += [j for j, used in known if at in used]
        rows = [i for i in program.read if any(shown[i, j] for j in columns)]
        driven = program.varying and any(j in program.layout["E"].columns for j in columns)
        if rows or driven:
            found[at] = (
                f"{program.readings[rows[0]]} shows" if rows else "a dependent storage would see"
            )
    return found


def refuse_step(
    model: ClosedModel, at: int, where: str, before: Signal, after: Signal,
    times: tuple[float, float],
) -> None:  # fmt: skip
    """Refuse that such an input steps from one signal to another at the first of these times, or between."""
    begin, end = times
    old, new = before(begin), after(begin)
    step = begin if abs(new - old) > TUNING.together * max(abs(old), abs(new)) else None
    if step is None:
        step = after.first_jump(begin, end)
    if step is not None:
        raise _impulse(model, at, where, step)


def _impulse(model: ClosedModel, at: int, where: str, t: float) -> SimulationError:
    """That such an input steps at t [s]."""
    return SimulationError(
        f"{_told(model.program, at)} steps at t = {t:g}, where {where} its rate and would be an "
        "impulse; smooth it with Lag or Ramp"
    )


def _told(program: Program, at: int) -> str:
    """An input, or what a known source is."""
    name, asked = program.external[at].name, len(program.asked)
    return f"input {name!r}" if at < asked else f"known source {program.sources[at - asked]}"


def _shown_rates(model: ClosedModel) -> Array:
    """Nonzero where a reading shows the rate of an input; where values change, where it may."""
    program = model.program
    if not program.varying:
        return model.constant.G
    rates, driven = program.layout["K"], program.layout["E"]
    shown = np.zeros(rates.shape)
    shown[list(rates.rows), list(rates.columns)] = 1.0
    for i in set(program.layout["H"].rows):
        shown[i, list(driven.columns)] = 1.0
    return shown
