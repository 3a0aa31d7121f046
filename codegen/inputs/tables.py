"""Signals as one table of terms, segment by segment, for generated C."""

from collections.abc import Sequence
from dataclasses import dataclass

from codegen.inputs.signal import Signal

Row = tuple[int, int, int, float, complex]
"""An input, the place of its first coefficient, how many there are, their start [s], their rate [1/s]."""


@dataclass(frozen=True)
class SignalTable:
    """What ``bg_signals`` of the C runtime holds: segments end at ``breaks`` [s], the last one never.

    ``begins``: where each segment's terms begin, and where the last one's end.
    """

    breaks: tuple[float, ...]
    begins: tuple[int, ...]
    terms: tuple[Row, ...]
    coefficients: tuple[complex, ...]
    fastest: tuple[float, ...]


def signal_table(signals: Sequence[Signal], begin: float, end: float) -> SignalTable:
    """The signals from ``begin`` to ``end`` [s], cut at every breakpoint between."""
    breaks = sorted({b for signal in signals for b in signal.breakpoints if begin < b <= end})
    begins, fastest = [0], []
    terms: list[Row] = []
    coefficients: list[complex] = []
    for t in (begin, *breaks):
        pieces = [signal.piece(t) for signal in signals]
        for at, piece in enumerate(pieces):
            for rate, polynomial in piece.terms:
                terms.append((at, len(coefficients), len(polynomial), piece.start, complex(rate)))
                coefficients += [complex(c) for c in polynomial]
        begins.append(len(terms))
        fastest.append(max((piece.fastest for piece in pieces), default=0.0))
    return SignalTable(
        tuple(breaks), tuple(begins), tuple(terms), tuple(coefficients), tuple(fastest)
    )
