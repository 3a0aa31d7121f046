"""Inputs as the chains that the C engine's generators are made of, segment by segment."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from codegen.engine.chains import Chain, Rows, slots_of
from codegen.engine.windows import Windows
from codegen.inputs.pieces import Piece, collected
from codegen.inputs.signal import Signal
from codegen.numbers.arrays import Array


@dataclass(frozen=True)
class Segments:
    """What inputs do between breakpoints; a structure is the chains that some segments share.

    ``polynomials``: for each segment each chain's start and coefficients.
    """

    breaks: tuple[float, ...]
    structures: tuple[tuple[Chain, ...], ...]
    chains: tuple[int, ...]
    constants: Array
    polynomials: tuple[tuple[tuple[float, tuple[complex, ...]], ...], ...]
    fastest: Array

    @property
    def slots(self) -> int:
        """How many slots the largest structure has."""
        return max(sum(map(slots_of, structure)) for structure in self.structures)

    def rows(self, t: float, width: int, count: int | None = None) -> Rows:
        """All segments, whatever is asked for; ``width``: how many slots there is room for."""
        del t, count
        size = len(self.chains)
        starts, polynomials = np.zeros((size, width)), np.zeros((size, width))
        for at, row in enumerate(self.polynomials):
            first = 0
            for i, (start, polynomial) in enumerate(row):
                chain = self.structures[self.chains[at]][i]
                step = 2 if chain[1].imag else 1
                starts[at, i] = start
                for k, c in enumerate(polynomial):
                    polynomials[at, first + step * k] = c.real
                    if step == 2:
                        polynomials[at, first + step * k + 1] = c.imag
                first += slots_of(chain)
        breaks, chains = np.array(self.breaks, dtype=float), np.array(self.chains, dtype=np.intc)
        return Rows(
            -np.inf, np.inf, breaks, self.constants, starts, polynomials, chains, self.fastest
        )


def inputs_over(signals: Sequence[Signal], begin: float, end: float) -> Segments | Windows:
    """The signals from ``begin`` to ``end`` [s]: all segments, or so many at a time where there is no end."""
    if any(signal.endless for signal in signals):
        return Windows(signals, begin, end)
    return segments(signals, begin, end)


def segments(signals: Sequence[Signal], begin: float, end: float) -> Segments:
    """The signals from ``begin`` to ``end``, cut at every breakpoint between."""
    breaks = sorted({b for signal in signals for b in signal.breakpoints if begin < b <= end})
    pieces = [[_settled(signal.piece(t)) for signal in signals] for t in (begin, *breaks)]
    structures, chains = _structures(pieces)
    constants = np.zeros((len(pieces), max(len(signals), 1)))
    polynomials = []
    for at, (row, which) in enumerate(zip(pieces, chains, strict=True)):
        polynomials.append(tuple(_over(row, chain) for chain in structures[which]))
        for j, piece in enumerate(row):
            if not any(chain[:2] == (j, 0) for chain in structures[which]):
                constants[at, j] = sum(p[0].real for rate, p in piece.terms if rate == 0)
    fastest = np.array([max((piece.fastest for piece in row), default=0.0) for row in pieces])
    return Segments(
        tuple(breaks), tuple(structures), tuple(chains), constants, tuple(polynomials), fastest
    )


def _settled(piece: Piece) -> Piece:
    """A piece whose terms have different rates, and polynomials no zeros at their ends."""
    terms = []
    for rate, polynomial in collected(piece.terms):
        kept = list(polynomial)
        while kept and kept[-1] == 0:
            kept.pop()
        if kept:
            terms.append((rate, tuple(kept)))
    return Piece(piece.start, tuple(terms), piece.pace)


def _structures(
    pieces: Sequence[Sequence[Piece]],
) -> tuple[list[tuple[Chain, ...]], list[int]]:
    """The chains that segments need: those of all in one, unless that is much more than any has."""
    each = [_chains([row]) for row in pieces]
    together = _chains(pieces)
    most = max(sum(map(slots_of, one)) for one in each)
    if sum(map(slots_of, together)) <= 2 * most + 2:
        return [together], [0] * len(pieces)
    places = {one: at for at, one in enumerate(dict.fromkeys(each))}
    return list(places), [places[one] for one in each]


def _chains(rows: Sequence[Sequence[Piece]]) -> tuple[Chain, ...]:
    """The chains of all these pieces; a constant needs none."""
    depth: dict[tuple[int, complex], int] = {}
    for row in rows:
        for j, piece in enumerate(row):
            for rate, polynomial in piece.terms:
                key = (j, complex(rate))
                depth[key] = max(depth.get(key, 0), len(polynomial))
    return tuple((*key, d) for key, d in depth.items() if key[1] != 0 or d > 1)


def _over(row: Sequence[Piece], chain: Chain) -> tuple[float, tuple[complex, ...]]:
    """The start and the polynomial of a chain in a segment."""
    piece = row[chain[0]]
    found = next((p for rate, p in piece.terms if complex(rate) == chain[1]), ())
    return piece.start, tuple(complex(c) for c in found)
