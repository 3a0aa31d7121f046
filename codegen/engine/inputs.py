"""Inputs as the chains that the C engine's generators are made of, segment by segment."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from codegen.engine.sizes import Engine
from codegen.inputs.pieces import Piece, collected
from codegen.inputs.signal import Signal
from codegen.numbers.arrays import Array

Chain = tuple[int, complex, int]
"""An input, a rate [1/s] and how many coefficients the polynomial at that rate has."""


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
        return max(sum(map(_slots, structure)) for structure in self.structures)


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
    most = max(sum(map(_slots, one)) for one in each)
    if sum(map(_slots, together)) <= 2 * most + 2:
        return [together], [0] * len(pieces)
    different = list(dict.fromkeys(each))
    return different, [different.index(one) for one in each]


def _chains(rows: Sequence[Sequence[Piece]]) -> tuple[Chain, ...]:
    """The chains of all these pieces; a constant needs none."""
    depth: dict[tuple[int, complex], int] = {}
    for row in rows:
        for j, piece in enumerate(row):
            for rate, polynomial in piece.terms:
                key = (j, complex(rate))
                depth[key] = max(depth.get(key, 0), len(polynomial))
    return tuple((*key, d) for key, d in depth.items() if key[1] != 0 or d > 1)


def _slots(chain: Chain) -> int:
    return chain[2] * (2 if chain[1].imag else 1)


def _over(row: Sequence[Piece], chain: Chain) -> tuple[float, tuple[complex, ...]]:
    """The start and the polynomial of a chain in a segment."""
    piece = row[chain[0]]
    found = next((p for rate, p in piece.terms if complex(rate) == chain[1]), ())
    return piece.start, tuple(complex(c) for c in found)


class Packed:
    """Segments as the engine's record, whose arrays have a row for each segment.

    ``constant``: what each input is but for its chains. ``polynomial``: coefficients of the chains by
    slot; ``owner``: the input of a slot, -1 where there is none.
    """

    def __init__(self, engine: Engine, made: Segments) -> None:
        self.record = engine.new("ex_inputs")
        ffi, sizes = engine.ffi, engine.sizes
        self._kept: list[Any] = []
        self._structures(engine, made)
        count, G = len(made.chains), sizes.G
        starts, polynomials = np.zeros((count, G)), np.zeros((count, G))
        self.constant, self.polynomial = made.constants, polynomials
        self.owner = np.full((count, G), -1)
        for at, chains in enumerate(made.polynomials):
            first = 0
            for i, (start, polynomial) in enumerate(chains):
                chain = made.structures[made.chains[at]][i]
                width = 2 if chain[1].imag else 1
                starts[at, i] = start
                self.owner[at, first : first + _slots(chain)] = chain[0]
                for k, c in enumerate(polynomial):
                    polynomials[at, first + width * k] = c.real
                    if width == 2:
                        polynomials[at, first + width * k + 1] = c.imag
                first += _slots(chain)
        for name, array, kind in (
            ("breaks", np.array(made.breaks), "double *"), ("fastest", made.fastest, "double *"),
            ("constant", made.constants, f"double(*)[{sizes.W}]"),
            ("start", starts, f"double(*)[{G}]"), ("polynomial", polynomials, f"double(*)[{G}]"),
            ("chains", np.array(made.chains, dtype=np.intc), "int *"),
        ):  # fmt: skip
            self._kept.append(array)
            setattr(self.record, name, ffi.cast(kind, array.ctypes.data))
        self.record.segments = count

    def _structures(self, engine: Engine, made: Segments) -> None:
        records = engine.ffi.new("ex_chains[]", len(made.structures))
        for record, chains in zip(records, made.structures, strict=True):
            first = np.cumsum([0, *map(_slots, chains)]).tolist()
            record.count = len(chains)
            for i, (j, rate, depth) in enumerate(chains):
                record.input[i], record.first[i], record.depth[i] = j, first[i], depth
                record.width[i] = 2 if rate.imag else 1
                record.rate[i][0], record.rate[i][1] = rate.real, rate.imag
        self._kept.append(records)
        self.record.structures = records
