"""Where a run of an export begins: a model in numbers, its states and signals there, its longest step."""

from collections.abc import Hashable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from bondgraph.declare.switching import checked_modes
from bondgraph.equations import StateEquations
from bondgraph.errors import ParameterError, StructureError
from codegen.corners.located import with_corners
from codegen.inputs.signal import Signal
from codegen.model.sources import with_first
from codegen.model.starts import by_states, told_starts
from codegen.modes.closed import ClosedModel
from codegen.modes.steps import step_at_start
from codegen.numbers.arrays import Array
from codegen.program.lower import lower
from codegen.program.records import Program, stepped_in_python
from codegen.runs.arguments import initial_values, signals_for
from codegen.supplied import supplied


def check_exported(program: Program) -> None:
    """Refuse what only Python can call."""
    if told := stepped_in_python(program):
        raise StructureError(
            f"{told}, which only runs in numpy can call; write what it does as expressions, update={{...}} "
            "and gives={...}"
        )


@dataclass(frozen=True)
class Start:
    """``states`` and ``signals`` in the program's order; ``longest``: the longest stable step there [s].

    ``on``: the switches that are on before. ``told``: the states that whoever asked gave a value.
    """

    closed: ClosedModel
    states: Array
    signals: tuple[Signal, ...]
    longest: float
    on: frozenset[Hashable] = frozenset()
    told: frozenset[str] = frozenset()


def start_of(
    equations: StateEquations,
    parameters: Mapping[str, object],
    laws: Mapping[Any, object] | None,
    initial: Mapping[str, float] | None,
    inputs: Mapping[str, object] | None,
    initially_on: Iterable[Hashable] = (),
    located: bool = True,
) -> Start:
    """Arguments as of `to_c`: states and inputs that are not named are zero.

    ``located``: whether the export locates events, and with them the corners of laws.

    Raises what `simulator` raises.
    """
    if not isinstance(parameters, Mapping):
        raise ParameterError(f"parameters must map names to numbers, not be {parameters!r}")
    equations = supplied(equations, laws, parameters)
    program = lower(equations, laws, parameters)
    program = with_corners(program) if located else program
    check_exported(program)
    closed = ClosedModel(program, equations, parameters)
    names = [symbol.name for symbol in (*program.states, *program.law_states)]
    wanted = [symbol.name for symbol in program.wanted]
    given = signals_for({**dict.fromkeys(wanted, 0.0), **(inputs or {})}, wanted)
    signals = with_first(program, given, closed.parameters)
    told = by_states(program.equations, parameters, initial or {})
    states = initial_values({**told_starts(program.equations, parameters), **told}, names)
    on = checked_modes([port.name for port in program.switches], initially_on)
    longest = step_at_start(closed, states, signals)
    return Start(closed, states, tuple(signals), longest, on, frozenset(map(str, told)))
