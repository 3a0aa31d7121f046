"""External inputs as plain floats."""

from collections.abc import Callable, Sequence

from codegen.inputs.pieces import Piece

Given = Callable[[float], tuple[list[float], list[float]]]
"""From the time to the inputs and their rates."""


def plainly(pieces: Sequence[Piece], rated: bool) -> Given:
    """The inputs that pieces give, and their rates where they are asked for, else zeros."""
    values = _values(pieces)
    if not rated:
        still = [0.0] * len(pieces)
        return lambda t: (values(t), still)
    slopes = _values([piece.derivative for piece in pieces])
    return lambda t: (values(t), slopes(t))


def _values(pieces: Sequence[Piece]) -> Callable[[float], list[float]]:
    """What pieces give at a time; of those that are constant it is known."""
    moving = [(at, piece) for at, piece in enumerate(pieces) if piece.level is None]
    known = [piece.level or 0.0 for piece in pieces]

    def values(t: float) -> list[float]:
        found = known.copy()
        for at, piece in moving:
            found[at] = piece(t)
        return found

    return values
