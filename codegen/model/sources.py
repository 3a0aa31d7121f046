"""The signals of a model's known sources, expressions of time at its parameters' numbers; its delays."""

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple, NoReturn

import sympy as sp

from bondgraph.errors import ParameterError, StructureError
from bondgraph.nodes.lagging import Lagging
from codegen.inputs.known import known_signal
from codegen.inputs.signal import Signal
from codegen.inputs.signals import Constant
from codegen.model.exact_values import at_parameters
from codegen.program.records import Program
from codegen.tuning import TUNING


def source_signals(
    program: Program, parameters: Mapping[str, sp.Rational], begin: float, end: float,
    found: bool = False,
) -> list[Signal]:  # fmt: skip
    """A signal for each of the program's sources, from ``begin`` to ``end`` [s].

    ``found``: whether what delays give is among the inputs already, as in runs.

    Raises `StructureError` where it is not, which is everywhere but in runs.
    """
    if program.delayed and not found:
        _refuse_delays(program)
    return [
        known_signal(at_parameters(expr, parameters), begin, max(end, begin + TUNING.shortest))
        for expr in program.sources
    ]


def _refuse_delays(program: Program) -> NoReturn:
    """Refuse what has no past: what a delay gives is told by the run so far."""
    name = program.delayed[0]
    raise StructureError(
        f"delay {name}: what it gives is told by the past of a run, and one instant has none; "
        f"put bg.Function({name.name!r}, ...) in its place for what rests or is instantaneous, or a "
        "bg.TransferFunction that stands for it"
    )


class Lag(NamedTuple):
    """What a delay gives is so ``late`` [s], and is ``start`` before."""

    late: float
    start: float


def lags(delays: Sequence[Lagging], parameters: Mapping[str, sp.Rational]) -> tuple[Lag, ...]:
    """Of each delay in turn.

    Raises `ParameterError` for one that is not above zero, and for names without a number.
    """
    found = []
    for one in delays:
        late, start = (_number(one.given, part, parameters) for part in (one.time, one.start))
        if not late > 0 or not math.isfinite(start):
            raise ParameterError(
                f"delay {one.given}: its time is {late:g} and its start {start:g}; a delay is above zero"
            )
        found.append(Lag(late, start))
    return tuple(found)


def with_first(
    program: Program, signals: Sequence[Signal], parameters: Mapping[str, sp.Rational]
) -> list[Signal]:
    """Signals for all that is asked for, of those that are wanted: delays give what they give at first.

    Raises what `lags` raises.
    """
    delays = program.equations.delays
    told = zip(delays, lags(delays, parameters), strict=True)
    first = {one.given: Constant(lag.start) for one, lag in told}
    given = {**dict(zip(program.wanted, signals, strict=True)), **first}
    return [given[name] for name in program.asked]


def _number(name: sp.Symbol, part: sp.Expr, parameters: Mapping[str, sp.Rational]) -> float:
    """A time or a start; `ParameterError` where it lacks a number."""
    told = at_parameters(part, parameters)
    if told.free_symbols:
        missing = ", ".join(sorted(map(str, told.free_symbols)))
        raise ParameterError(f"delay {name}: missing parameter(s) {missing}; give each a number")
    return float(told)
