"""Python functions that tell what the tasks of controllers set."""

import math
from collections.abc import Collection, Mapping
from numbers import Real

from bondgraph.errors import SimulationError
from codegen.numbers.arrays import Array
from codegen.program.records import Program, Step


def told_by_steps(program: Program, t: float, due: Collection[int], values: Array) -> Array:
    """Conditions and what is set at an instant, with what the functions of the clocks that are due tell.

    Raises `SimulationError` for what a function returns that is no number, or is not asked for.
    """
    found = values
    for step in program.steps:
        if step.clock in due:
            found = found.copy()
            for name, value in _called(program, step, t, values).items():
                found[step.sets[name]] = value
    return found


def _called(program: Program, step: Step, t: float, values: Array) -> dict[str, float]:
    """What one function tells, by name; what it does not tell stays."""
    node = program.equations.tasks[step.clock].name
    places = {**step.sets, **step.reads}
    given = {"t": t, **{name: float(values[at]) for name, at in places.items()}}
    told = step.function(given)
    where = f"at t = {t:.9g} the step of controller {node!r}"
    if not isinstance(told, Mapping):
        raise SimulationError(f"{where} returned {told!r}; it must return values by name")
    for name, value in told.items():
        if name not in step.sets:
            raise SimulationError(
                f"{where} returned {name!r}, which it does not set; it sets {', '.join(step.sets)}"
            )
        if not isinstance(value, Real) or not math.isfinite(value):
            raise SimulationError(
                f"{where} returned {value!r} for {name}; it must be a finite number"
            )
    return {name: float(value) for name, value in told.items()}
