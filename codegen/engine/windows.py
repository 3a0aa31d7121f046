"""Inputs without end as the C engine's segments: so many at a time, the next ones as a run comes to them."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from bondgraph.errors import SimulationError
from codegen.engine.chains import Chain, Rows, slots_of
from codegen.inputs.lagged import Chase
from codegen.inputs.pieces import Piece, Term
from codegen.inputs.signal import Signal
from codegen.inputs.waves import Wave
from codegen.numbers.arrays import Array

SEGMENTS = 1024
"""So many are written at a time."""

SAMPLES = 8
"""Pieces whose chains are those of all of a signal that tells no others."""


class Windows:
    """The segments of a run from ``begin`` to ``end`` [s], one part of the inputs beside the other."""

    def __init__(self, signals: Sequence[Signal], begin: float, end: float) -> None:
        self._begin, self._end, structure = begin, end, list[Chain]()
        self._inputs, self._parts, first = len(signals), list[_Part](), 0
        for at, signal in enumerate(signals):
            for part in signal.summands if signal.endless else (signal,):
                made = _Part(at, part, first, begin)
                self._parts.append(made)
                structure += made.chains
                first += sum(map(slots_of, made.chains))
        self.slots, self.structures = first, (tuple(structure),)

    def rows(self, t: float, width: int, count: int = SEGMENTS) -> Rows:
        """At most so many segments from t on; ``width``: how many slots there is room for."""
        begins, until = self._begins(t, count)
        size = len(begins)
        constants = np.zeros((size, max(self._inputs, 1)))
        starts, polynomials = np.zeros((size, width)), np.zeros((size, width))
        place = 0
        for part in self._parts:
            own = slice(place, place + len(part.chains))
            part.write(begins, constants, starts[:, own], polynomials)
            place += len(part.chains)
        fastest = np.full(size, max((part.fastest for part in self._parts), default=0.0))
        chains = np.zeros(size, dtype=np.intc)
        since = t if t > self._begin else -math.inf
        return Rows(since, until, begins[1:], constants, starts, polynomials, chains, fastest)

    def _begins(self, t: float, count: int) -> tuple[Array, float]:
        """Where segments from t on begin, and where the last one ends."""
        limit, found = math.inf, [np.zeros(0)]
        for part in self._parts:
            breaks = part.breaks(t, count)
            if len(breaks) >= count:
                limit = min(limit, float(breaks[-1]))
            found.append(breaks)
        breaks = np.unique(np.concatenate(found))
        breaks = breaks[breaks <= min(limit, self._end)]
        whole = limit > self._end and len(breaks) < count
        breaks = breaks if whole else breaks[:count]
        ends = breaks if whole else breaks[:-1]
        return np.array([t, *ends]), math.inf if whole else float(breaks[-1])


@dataclass(frozen=True)
class _Table:
    """Forms of pieces as numbers: the constant of each, and its polynomials by slot."""

    constants: Array
    polynomials: Array


class _Part:
    """A part of input ``at``, whose chains have slots from ``first`` on."""

    def __init__(self, at: int, signal: Signal, first: int, begin: float) -> None:
        self._at, self._signal, self._first = at, signal, first
        forms = self._forms(begin)
        self.fastest = max((piece.fastest for piece in forms), default=0.0)
        depth: dict[complex, int] = {}
        for piece in forms:
            for rate, polynomial in piece.terms:
                depth[complex(rate)] = max(depth.get(complex(rate), 0), len(polynomial))
        self.chains = [(at, rate, d) for rate, d in depth.items() if rate or d > 1]
        self._table = self._told([piece.terms for piece in forms])
        # Of one that has an end, once for all windows.
        listed = not signal.endless
        self._known = np.array(signal.breakpoints if listed else (), dtype=float)
        self._starts = np.array([piece.start for piece in forms] if listed else (), dtype=float)

    def _forms(self, begin: float) -> Sequence[Piece]:
        signal = self._signal
        if isinstance(signal, Wave):
            return [Piece(0.0, terms) for terms in signal.forms]
        if not signal.endless:
            return signal.pieces
        late = max(begin, signal.origin) if isinstance(signal, Chase) else begin
        times = [begin, late]
        times += [t for first in times[:] for t in islice(signal.within(first, math.inf), SAMPLES)]
        return [signal.piece(t) for t in times]

    def _told(self, forms: Sequence[Iterable[Term]]) -> _Table:
        constants = np.zeros(len(forms))
        polynomials = np.zeros((len(forms), sum(map(slots_of, self.chains))))
        for row, terms in enumerate(forms):
            for rate, polynomial in terms:
                first, depth = self._slots(complex(rate))
                if len(polynomial) > depth:
                    raise SimulationError(
                        f"{self._signal} has a term of the rate {rate:g} that none of its first pieces has"
                    )
                if not polynomial or not (rate or depth > 1):
                    constants[row] += complex(sum(polynomial)).real
                    continue
                width = 2 if complex(rate).imag else 1
                for k, c in enumerate(polynomial):
                    polynomials[row, first + width * k] += complex(c).real
                    if width == 2:
                        polynomials[row, first + width * k + 1] += complex(c).imag
        return _Table(constants, polynomials)

    def _slots(self, rate: complex) -> tuple[int, int]:
        """Where the chain of a rate has its slots, and its depth; that of a constant has none."""
        first = 0
        for chain in self.chains:
            if chain[1] == rate:
                return first, chain[2]
            first += slots_of(chain)
        return 0, 0 if rate else 1

    def breaks(self, t: float, count: int) -> Array:
        """The breakpoints after t: so many or more if there are."""
        signal = self._signal
        if isinstance(signal, Wave):
            return signal.breaks(t, count)
        if not signal.endless:
            first = int(np.searchsorted(self._known, t, side="right"))
            return self._known[first : first + count]
        return np.array([*islice(signal.within(t, math.inf), count)], dtype=float)

    def write(self, begins: Array, constants: Array, starts: Array, polynomials: Array) -> None:
        """What it is in segments that begin so."""
        signal, table = self._signal, self._table
        which: NDArray[np.intp]
        if isinstance(signal, Wave):
            which, own = signal.places(begins)
        elif not signal.endless:
            which = np.searchsorted(self._known, begins, side="right")
            own = self._starts[which]
        else:
            pieces = [signal.piece(t) for t in begins.tolist()]
            which, own = np.arange(len(begins)), np.array([piece.start for piece in pieces])
            table = self._told([piece.terms for piece in pieces])
        constants[:, self._at] += table.constants[which]
        starts[:] = own[:, None]
        width = table.polynomials.shape[1]
        polynomials[:, self._first : self._first + width] = table.polynomials[which]
