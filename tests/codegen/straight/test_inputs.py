"""Inputs as plain floats are what their pieces give."""

import pytest

from codegen.inputs.pieces import Piece, constant_piece
from codegen.straight.inputs import plainly

PIECES = [constant_piece(0.0, 2.5), Piece(0.5, ((0, (1.0, -3.0)),)), constant_piece(1.0, -0.0),
          Piece(0.0, ((2j, (1.5,)), (-1, (0.0, 2.0))))]  # fmt: skip


@pytest.mark.parametrize("t", [0.0, 0.7, 3.0])
def test_they_are_what_pieces_give(t: float) -> None:
    values, slopes = plainly(PIECES, rated=True)(t)
    assert values == [piece(t) for piece in PIECES]
    assert slopes == [piece.derivative(t) for piece in PIECES]
    assert plainly(PIECES, rated=False)(t) == (values, [0.0] * len(PIECES))
    assert values[1] == pytest.approx(1 - 3 * (t - 0.5))
