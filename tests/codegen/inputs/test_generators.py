"""Generators against the pieces that they stand for."""

import numpy as np
import pytest
import scipy.linalg

from codegen import Constant, Lag, Ramp, Sampled, Signal, Sine, Step
from codegen.inputs.generators import generator

SIGNALS: list[Signal] = [
    Constant(3.0),
    Step(0.2, 5.0, 1.0),
    Ramp(0.1, 4.0, 1.0),
    Sine(2.0, 7.0, 0.3, 0.5),
    Lag(Step(0.0, 5.0), 0.04),
    Lag(Ramp(0.0, 3.0), 0.1),
    Lag(Sine(1.0, 3.0), 0.05),
    Lag(Lag(Step(0.0, 5.0), 0.04), 0.04),
    Sampled([0.0, 1.0, 2.0], [0.0, 1.0, 0.5]),
]


@pytest.mark.parametrize("t", [0.25, 0.6])
def test_the_generator_gives_what_the_pieces_give(t: float) -> None:
    pieces = [signal.piece(t) for signal in SIGNALS]
    made = generator(pieces, t)
    for tau in (0.0, 0.01, 0.1, 0.35):
        g = scipy.linalg.expm(made.G * tau) @ made.start
        given = made.C @ g
        rates = made.C @ made.G @ g
        for at, piece in enumerate(pieces):
            assert given[at] == pytest.approx(piece(t + tau), rel=1e-11, abs=1e-11)
            assert rates[at] == pytest.approx(piece.derivative(t + tau), rel=1e-9, abs=1e-9)
    assert g[0] == 1.0


def test_inputs_of_one_rate_share_its_components() -> None:
    signals = [Lag(Step(0.0, 5.0), 0.04), Lag(Step(0.0, 9.0), 0.04), Constant(1.0)]
    made = generator([signal.piece(1.0) for signal in signals], 1.0)
    assert made.G.shape == (2, 2)
    assert np.linalg.matrix_rank(made.C) == 2
