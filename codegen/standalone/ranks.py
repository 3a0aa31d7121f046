"""Ranks of what holds a set of ports, exact: rows are eliminated in residues modulo a prime."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from codegen.standalone.holding import HeldSet

Residues = Mapping[int, int]
"""A sparse row modulo the prime."""

Row = dict[tuple[int, int], int]
"""A row in parts; a key is the part and the place in it."""


@dataclass(frozen=True)
class SlipRows:
    """The slips ``F x + D u`` in residues, a row for each port; D is over all inputs.

    ``own``: the input each port gives. ``moved``: the inputs of the laws that each port's effort
    moves, which are solved together with it: a damper in series gives way and so lets a port hold.
    """

    F: Sequence[Residues]
    D: Sequence[Residues]
    own: Sequence[int]
    moved: Sequence[Sequence[int]]
    prime: int

    def answering(self, ports: Iterable[int]) -> list[int]:
        """The inputs that answer at once when these ports hold: their own, then those of laws."""
        chosen = list(ports)
        own = [self.own[i] for i in chosen]
        return own + sorted({j for i in chosen for j in self.moved[i]})

    def coupled(self, port: int) -> bool:
        """Whether a slip depends at once on friction, by itself or by a law that friction moves."""
        return any(j in self.D[port] for j in self.answering(range(len(self.own))))


def held_set(rows: SlipRows, ports: Sequence[int]) -> HeldSet:
    """What holds a set of sticking ports.

    Rows ``[D over what answers, F, D]`` are eliminated in the first part, what vanishes there in
    the second; and what then is left in the third is ruled by other inputs alone.
    """
    answering = rows.answering(ports)
    parts: list[Row] = []
    for i in ports:
        answers = {(0, at): rows.D[i][j] for at, j in enumerate(answering) if j in rows.D[i]}
        states = {(1, j): entry for j, entry in rows.F[i].items()}
        parts.append({**answers, **states, **{(2, j): entry for j, entry in rows.D[i].items()}})
    direct, direct_columns, null, left = _eliminated(parts, 0, rows.prime)
    kept, kept_columns, _, ruling = _eliminated(left, 1, rows.prime)
    moved, ruled = tuple(answering[len(direct) + len(null) :]), any(ruling)
    return HeldSet(moved, direct, direct_columns, null, kept, kept_columns, ruled)


Positions = tuple[int, ...]


def _eliminated(
    rows: Sequence[Row], part: int, prime: int
) -> tuple[Positions, Positions, Positions, list[Row]]:
    """Rows independent in a part, and where; the others, and what is left of them elsewhere."""
    basis: dict[int, tuple[int, Row]] = {}
    others, rests = [], []
    for at, row in enumerate(rows):
        left = dict(row)
        for column, (_, pivot) in basis.items():
            factor = left.get((part, column), 0)
            for key, entry in pivot.items() if factor else ():
                left[key] = (left.get(key, 0) - factor * entry) % prime
        left = {key: entry for key, entry in left.items() if entry}
        leading = min((column for where, column in left if where == part), default=None)
        if leading is None:
            others.append(at)
            rests.append(left)
        else:
            scale = pow(left[part, leading], -1, prime)
            basis[leading] = at, {key: entry * scale % prime for key, entry in left.items()}
    return tuple(at for at, _ in basis.values()), tuple(sorted(basis)), tuple(others), rests
