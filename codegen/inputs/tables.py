"""Signals as one table of terms, segment by segment, and of waves that repeat, for generated C."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from bondgraph.errors import SignalError
from codegen.inputs.pieces import Piece, Term
from codegen.inputs.signal import Signal
from codegen.inputs.waves import Wave

NO_TABLE = (
    "a lag of a PWM whose duty is a signal depends on all before, which no table holds; give the model the "
    "lag, or the PWM a number as duty"
)

Row = tuple[int, int, int, float, complex]
"""An input, the place of its first coefficient, how many there are, their start [s], their rate [1/s]."""

PartRow = tuple[int, int, float]
"""The place of a part's first term, how many there are, where in its period it begins."""

WaveRow = tuple[int, int, int, float, float, float]
"""The place of a wave's first part, how many there are, its duty's place or -1; frequency [Hz], phase, and
the largest rate [1/s]."""


@dataclass(frozen=True)
class SignalTable:
    """What ``bg_signals`` of the C runtime holds: segments end at ``breaks`` [s], the last one never.

    ``begins``: where each segment's terms begin, and where the last one's end; those of ``parts`` of
    ``waves`` come behind. ``duties``: the signals that say where the parts of some waves begin.
    """

    breaks: tuple[float, ...]
    begins: tuple[int, ...]
    terms: tuple[Row, ...]
    coefficients: tuple[complex, ...]
    fastest: tuple[float, ...]
    waves: tuple[WaveRow, ...] = ()
    parts: tuple[PartRow, ...] = ()
    duties: "SignalTable | None" = None


def signal_table(signals: Sequence[Signal], begin: float, end: float) -> SignalTable:
    """The signals from ``begin`` to ``end`` [s], cut at every breakpoint between; waves as they are.

    Raises `SignalError` for a lag of a wave whose duty is a signal, which no table holds.
    """
    chained, waved = _sorted(signals)
    terms = _Terms()
    breaks = sorted({b for _, one in chained for b in one.breakpoints if begin < b <= end})
    begins, fastest = [0], []
    for t in (begin, *breaks):
        pieces = [(at, signal.piece(t)) for at, signal in chained]
        for at, piece in pieces:
            terms.add(at, piece.start, piece.terms)
        begins.append(len(terms.rows))
        fastest.append(max((piece.fastest for _, piece in pieces), default=0.0))
    waves, parts = _waves(waved, terms)
    duties = [wave.duty for _, wave in waved if wave.duty is not None]
    first, last = known_span(duties)
    return SignalTable(
        tuple(breaks), tuple(begins), tuple(terms.rows), tuple(terms.coefficients), tuple(fastest),
        waves, parts, signal_table(duties, first - 1.0, last) if duties else None,
    )  # fmt: skip


def has_table(signals: Sequence[Signal]) -> bool:
    """Whether a table can hold them."""
    parts = [part for signal in signals if signal.endless for part in signal.summands]
    return all(isinstance(part, Wave) or not part.endless for part in parts)


def known_span(signals: Sequence[Signal], begin: float = 0.0) -> tuple[float, float]:
    """The first and the last of breakpoints that are at hand, and of ``begin`` [s]."""
    ends = [b for _, signal in _sorted(signals)[0] for b in signal.breakpoints]
    first = min([begin, *ends])
    return first, max([first, *ends])


def _sorted(
    signals: Sequence[Signal],
) -> tuple[list[tuple[int, Signal]], list[tuple[int, Wave]]]:
    """What has its breakpoints at hand, and waves, each with its place."""
    chained: list[tuple[int, Signal]] = []
    waved: list[tuple[int, Wave]] = []
    for at, signal in enumerate(signals):
        for part in signal.summands if signal.endless else (signal,):
            if isinstance(part, Wave):
                waved.append((at, part))
            elif part.endless:
                raise SignalError(NO_TABLE)
            else:
                chained.append((at, part))
    return chained, waved


class _Terms:
    """Rows of terms, and their coefficients."""

    def __init__(self) -> None:
        self.rows: list[Row] = []
        self.coefficients: list[complex] = []

    def add(self, at: int, start: float, terms: Iterable[Term]) -> None:
        """The terms of a piece of an input."""
        for rate, polynomial in terms:
            first = len(self.coefficients)
            self.rows.append((at, first, len(polynomial), start, complex(rate)))
            self.coefficients += [complex(c) for c in polynomial]


def _waves(
    waved: Sequence[tuple[int, Wave]], terms: _Terms
) -> tuple[tuple[WaveRow, ...], tuple[PartRow, ...]]:
    """Rows of waves and of their parts, whose terms are added."""
    waves: list[WaveRow] = []
    parts: list[PartRow] = []
    duties = 0
    for at, wave in waved:
        first, pace = len(parts), max(Piece(0.0, form).fastest for form in wave.forms)
        for fraction, form in zip(wave.fractions, wave.forms, strict=True):
            parts.append((len(terms.rows), len(form), fraction))
            terms.add(at, 0.0, form)
        duty = -1 if wave.duty is None else duties
        duties += wave.duty is not None
        waves.append((first, len(wave.forms), duty, wave.frequency, wave.phase, pace))
    return tuple(waves), tuple(parts)
