"""What friction ports receive as exact rows, by residues."""

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import sympy as sp

from bondgraph.algebra.residues import PRIME
from bondgraph.equations import StateEquations
from bondgraph.errors import StructureError
from bondgraph.reduce.record import ReadingSum
from codegen.model.exactly import residue_rows
from codegen.program.gains import written_out
from codegen.program.records import Program
from codegen.standalone.holding import HeldSet
from codegen.standalone.ranks import SlipRows, held_set


@dataclass(frozen=True)
class ExactSlips(SlipRows):
    """Those of a model; ``bent``: ports whose factors of inputs move with the rates of states."""

    bent: Mapping[int, Hashable]

    def held(self, ports: Sequence[int]) -> HeldSet:
        """What holds a set of sticking ports; `StructureError` where that would need what is not known."""
        found = held_set(self, ports)
        for port in (ports[k] for k in found.null):
            if port in self.bent and any(j in self.D[port] for j in self.answering(ports)):
                raise StructureError(
                    f"{self.bent[port]!r} and other ports that hold with it determine their efforts by a "
                    "factor that moves with the rates of states; put a storage between"
                )
        return found


def slip_rows(
    program: Program, equations: StateEquations, parameters: Mapping[str, sp.Rational]
) -> ExactSlips:
    """The rows of a program at these parameters."""
    readings = list(equations.readings.values())
    rows = [readings[port.received] for port in program.friction]
    return ExactSlips(
        tuple(residue_rows((row.F for row in rows), parameters)),
        tuple(residue_rows((row.D for row in rows), parameters)),
        tuple(port.input for port in program.friction),
        tuple(_moved(program, equations, port.input) for port in program.friction),
        PRIME,
        MappingProxyType(
            {
                at: port.name
                for at, port in enumerate(program.friction)
                if _bends(equations, program.readings[port.received])
            }
        ),
    )


def _bends(equations: StateEquations, received: sp.Symbol) -> bool:
    """Whether a slip has factors of inputs that move with the rates of states.

    By itself such a port holds at once; a set of ports that does not would need what is not known.
    """
    motion = equations.reduction.motion
    if motion is None:
        return False
    for column, factor in equations.readings[received].D.items():
        part = ReadingSum()
        motion.add_rate(part, factor, equations.inputs[column])
        if part.H or part.K:
            return True
    return False


def _moved(program: Program, equations: StateEquations, column: int) -> tuple[int, ...]:
    """The coupled laws that an input moves, through the readings they use or by its name."""
    laws = dict(zip(program.coupled.inputs, written_out(program.coupled.values), strict=True))
    reached, waiting = {column}, [column]
    while waiting:
        name = program.inputs[(at := waiting.pop())]
        seen = {name} | {s for s, row in equations.readings.items() if row.D.get(at, 0) != 0}
        for given, law in laws.items():
            if given not in reached and seen & law.free_symbols:
                reached.add(given)
                waiting.append(given)
    return tuple(sorted(reached - {column}))
