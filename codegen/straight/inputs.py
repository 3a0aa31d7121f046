"""External inputs as plain floats."""

from collections.abc import Callable, Sequence

from codegen.inputs.pieces import Piece

Given = Callable[[float], tuple[list[float], list[float]]]
"""From the time to the inputs and their rates."""


def plainly(pieces: Sequence[Piece], rated: bool) -> Given:
    """The inputs that pieces give, and their rates where they are asked for, else zeros."""
    still = [0.0] * len(pieces)
    slopes = [piece.derivative for piece in pieces] if rated else []
    if all(piece.level is not None for piece in pieces):
        known = [piece(0.0) for piece in pieces], still
        return lambda t: known
    if not rated:
        return lambda t: ([piece(t) for piece in pieces], still)
    return lambda t: ([piece(t) for piece in pieces], [slope(t) for slope in slopes])
