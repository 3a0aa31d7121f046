"""What friction ports receive as exact rows, and which of their parts the ports' own efforts move."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import sympy as sp

from bondgraph.equations import StateEquations
from codegen.model.numbers import at_parameters
from codegen.program.gains import written_out
from codegen.program.records import Program


@dataclass(frozen=True)
class SlipRows:
    """The slips ``F x + D u``, a row for each friction port; D is over all inputs.

    ``own``: the input each port gives. ``moved``: the inputs of the laws that each port's effort moves,
    which are solved together with it: a damper in series gives way and so lets a port hold.
    """

    F: sp.Matrix
    D: sp.Matrix
    own: tuple[int, ...]
    moved: tuple[tuple[int, ...], ...]

    def answering(self, ports: Iterable[int]) -> list[int]:
        """The inputs that answer at once when these ports hold: their own first, then those of laws."""
        chosen = list(ports)
        own = [self.own[i] for i in chosen]
        return own + sorted({j for i in chosen for j in self.moved[i]})

    def coupled(self, port: int) -> bool:
        """Whether a slip depends at once on friction, by itself or by a law that friction moves."""
        return any(self.D[port, j] != 0 for j in self.answering(range(len(self.own))))


@dataclass(frozen=True)
class Independence:
    """Which slips of a set of sticking ports are independent; rows are over the ports of the set.

    ``direct``: ports whose rows determine efforts at once. ``null``: combinations of slips that no
    effort moves at once; ``kept``: those of them, by position, that are independent in the states.
    ``share``: combinations that the states do not see either: there efforts are shared. ``ruled``:
    whether one of these is ruled by other inputs, sources or laws, which alone let the set hold.
    """

    direct: tuple[int, ...]
    null: sp.Matrix
    kept: tuple[int, ...]
    share: sp.Matrix
    ruled: bool


def slip_rows(
    program: Program, equations: StateEquations, parameters: Mapping[str, sp.Rational]
) -> SlipRows:
    """The rows of a program at these parameters, exact."""
    readings = list(equations.readings.values())
    rows = [readings[port.reading] for port in program.friction]
    F = sp.zeros(len(rows), len(program.states))
    D = sp.zeros(len(rows), len(program.inputs))
    for i, row in enumerate(rows):
        for j, entry in row.F.items():
            F[i, j] = at_parameters(entry, parameters)
        for j, entry in row.D.items():
            D[i, j] = at_parameters(entry, parameters)
    own = tuple(port.input for port in program.friction)
    return SlipRows(F, D, own, moved_laws(program, equations))


def moved_laws(program: Program, equations: StateEquations) -> tuple[tuple[int, ...], ...]:
    """For each friction port the inputs of the coupled laws that its effort moves."""
    return tuple(_moved(program, equations, port.input) for port in program.friction)


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


def independence(rows: SlipRows, ports: Sequence[int]) -> Independence:
    """What holds a set of sticking ports, by exact rank."""
    chosen = list(ports)
    D = rows.D.extract(chosen, rows.answering(chosen))
    null = _stacked([vector.T for vector in D.T.nullspace()], len(chosen))
    constrained = null * rows.F.extract(chosen, list(range(rows.F.cols)))
    kept = constrained.T.rref()[1] if constrained.rows and constrained.cols else ()
    free = constrained.T.nullspace() if constrained.rows else []
    share = _stacked([(null.T * vector).T for vector in free], len(chosen))
    ruling = share * rows.D.extract(chosen, list(range(rows.D.cols)))
    direct = tuple(D.T.rref()[1]) if D.rows and D.cols else ()
    return Independence(direct, null, tuple(kept), share, not ruling.is_zero_matrix)


def _stacked(rows: Sequence[sp.Matrix], width: int) -> sp.Matrix:
    return sp.Matrix.vstack(*rows) if rows else sp.zeros(0, width)
