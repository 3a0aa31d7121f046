"""The communication points: exact instants, each one division, as those of controllers."""

from math import lcm

import numpy as np
import sympy as sp

from bondgraph.errors import SignalError, StructureError
from bondgraph.nodes.controllers import exact_seconds
from bondgraph.nodes.tasks import Task
from codegen.numbers.arrays import Array, read_only

LARGEST = 2**53
"""Integers up to which doubles count exactly."""


def instants(start: object, end: object, every: object) -> Array:
    """The instants ``start + k*every`` [s] up to ``end``, which is one of them.

    Raises `SignalError` for numbers of which it is none.

    >>> instants(0, 0.3, 0.1).tolist()
    [0.0, 0.1, 0.2, 0.3]
    """
    first, last, step = (
        seconds(value, what) for value, what in ((start, "start"), (end, "end"), (every, "every"))
    )
    if step <= 0 or last <= first:
        raise SignalError(
            f"communication every {step} s from {first} s to {last} s: the interval is above zero, and the "
            "end after the start"
        )
    count = (last - first) / step
    if count.q != 1:
        fewer, more = (float(first + step * whole) for whole in (count.floor(), count.ceiling()))
        raise SignalError(
            f"{last - first} s are {float(count):.6g} intervals of {step} s, no whole number; they end at "
            f"end={fewer} or end={more}"
        )
    unit = lcm(int(first.q), int(step.q))
    if max(abs(int(last * unit)), abs(int(first * unit)), unit) > LARGEST:
        raise SignalError(
            f"every {step} s from {first} s to {last} s: too many digits for exact instants; round them"
        )
    ticks = float(first * unit) + np.arange(int(count) + 1) * float(step * unit)
    return read_only(ticks / float(unit))


def seconds(value: object, what: str) -> sp.Rational:
    """As `exact_seconds`, of what a run is told: `SignalError` for what is no number of them."""
    try:
        return exact_seconds(value, what)
    except StructureError as error:
        raise SignalError(str(error)) from None


def meets(task: Task, start: sp.Rational, every: sp.Rational) -> bool:
    """Whether a task may work at a communication point: some ``a*i + b = c*k + d``, exactly.

    >>> half = sp.Rational(1, 2)
    >>> [meets(Task("c", 2, offset, 2, ()), sp.S.Zero, half) for offset in (0, 1)]
    [True, True]
    >>> meets(Task("c", 4, 1, 4, ()), sp.S.Zero, half)
    False
    """
    period, offset = (sp.Rational(part, task.unit) for part in (task.every, task.offset))
    return bool(((offset - start) / sp.gcd(period, every)).q == 1)
