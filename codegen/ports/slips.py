"""What friction ports receive as exact rows, and the ranks of what holds sets of them, by residues."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import sympy as sp

from bondgraph.algebra.residues import PRIME
from bondgraph.equations import StateEquations
from bondgraph.errors import StructureError
from bondgraph.reduce.record import ReadingSum
from codegen.model.numbers import residue_rows
from codegen.program.gains import written_out
from codegen.program.records import Program
from codegen.standalone.holding import HeldSet

Residues = Mapping[int, int]
"""A sparse row modulo the prime."""


@dataclass(frozen=True)
class SlipRows:
    """The slips ``F x + D u`` in residues, a row for each friction port; D is over all inputs.

    ``own``: the input each port gives. ``moved``: the inputs of the laws that each port's effort moves,
    which are solved together with it: a damper in series gives way and so lets a port hold.
    """

    F: tuple[Residues, ...]
    D: tuple[Residues, ...]
    own: tuple[int, ...]
    moved: tuple[tuple[int, ...], ...]
    #: Ports whose slips have factors of inputs that move with the rates of states, and their names.
    bent: Mapping[int, Hashable]

    def answering(self, ports: Iterable[int]) -> list[int]:
        """The inputs that answer at once when these ports hold: their own first, then those of laws."""
        chosen = list(ports)
        own = [self.own[i] for i in chosen]
        return own + sorted({j for i in chosen for j in self.moved[i]})

    def coupled(self, port: int) -> bool:
        """Whether a slip depends at once on friction, by itself or by a law that friction moves."""
        return any(j in self.D[port] for j in self.answering(range(len(self.own))))


def slip_rows(
    program: Program, equations: StateEquations, parameters: Mapping[str, sp.Rational]
) -> SlipRows:
    """The rows of a program at these parameters."""
    readings = list(equations.readings.values())
    rows = [readings[port.reading] for port in program.friction]
    return SlipRows(
        tuple(residue_rows((row.F for row in rows), parameters)),
        tuple(residue_rows((row.D for row in rows), parameters)),
        tuple(port.input for port in program.friction),
        tuple(_moved(program, equations, port.input) for port in program.friction),
        MappingProxyType(
            {
                at: port.name
                for at, port in enumerate(program.friction)
                if _bends(equations, program.readings[port.reading])
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


Row = dict[tuple[int, int], int]
"""A row in parts; a key is the part and the place in it."""


def held_set(rows: SlipRows, ports: Sequence[int]) -> HeldSet:
    """What holds a set of sticking ports, by exact rank.

    Rows ``[D over what answers, F, D]`` are eliminated in the first part, what vanishes there in the second;
    and what then is left in the third is ruled by other inputs alone.
    """
    answering = rows.answering(ports)
    parts: list[Row] = []
    for i in ports:
        answers = {(0, at): rows.D[i][j] for at, j in enumerate(answering) if j in rows.D[i]}
        states = {(1, j): entry for j, entry in rows.F[i].items()}
        parts.append({**answers, **states, **{(2, j): entry for j, entry in rows.D[i].items()}})
    direct, direct_columns, null, left = _eliminated(parts, 0)
    for k in null:
        if ports[k] in rows.bent and any(part == 0 for part, _ in parts[k]):
            raise StructureError(
                f"{rows.bent[ports[k]]!r} and other ports that hold with it determine their efforts by a "
                "factor that moves with the rates of states; put a storage between"
            )
    kept, kept_columns, _, ruling = _eliminated(left, 1)
    moved, ruled = tuple(answering[len(direct) + len(null) :]), any(ruling)
    return HeldSet(moved, direct, direct_columns, null, kept, kept_columns, ruled)


Places = tuple[int, ...]


def _eliminated(rows: Sequence[Row], part: int) -> tuple[Places, Places, Places, list[Row]]:
    """Rows that are independent in a part, and where; the others, and what is left of them elsewhere."""
    basis: dict[int, tuple[int, Row]] = {}
    others, rests = [], []
    for at, row in enumerate(rows):
        left = dict(row)
        for column, (_, pivot) in basis.items():
            factor = left.get((part, column), 0)
            for key, entry in pivot.items() if factor else ():
                left[key] = (left.get(key, 0) - factor * entry) % PRIME
        left = {key: entry for key, entry in left.items() if entry}
        leading = min((column for where, column in left if where == part), default=None)
        if leading is None:
            others.append(at)
            rests.append(left)
        else:
            scale = pow(left[part, leading], -1, PRIME)
            basis[leading] = at, {key: entry * scale % PRIME for key, entry in left.items()}
    return tuple(at for at, _ in basis.values()), tuple(sorted(basis)), tuple(others), rests
