"""Inputs as the outputs of one linear system: ``w = C g``, ``g' = G g``, for as long as their pieces last."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from codegen.inputs.pieces import Piece, moved
from codegen.numbers.arrays import Array


class Chain(NamedTuple):
    """The components of one rate: where they begin and how many there are."""

    first: int
    rate: complex
    depth: int


@dataclass(frozen=True)
class Generator:
    """``w = C g``, ``g' = G g`` from ``start`` at one time on; the first component of g is 1 for ever."""

    G: Array
    C: Array
    start: Array
    chains: tuple[Chain, ...]

    def at(self, elapsed: Array) -> Array:
        """g at times after the start, a row each."""
        found = np.zeros((len(elapsed), len(self.start)))
        for first, rate, depth in self.chains:
            width = 2 if rate.imag else 1
            value = np.exp(rate * elapsed)
            for k in range(depth):
                at = first + k * width
                found[:, at] = value.real
                if width == 2:
                    found[:, at + 1] = value.imag
                value = value * elapsed / (k + 1)
        return found


def generator(pieces: Sequence[Piece], t: float) -> Generator:
    """The generator of these pieces from t on: components ``tau^k/k! exp(rate tau)``, shared by rate.

    >>> from codegen.inputs.pieces import constant_piece
    >>> ramp = Piece(0.0, ((0, (1.0, 2.0)),))
    >>> made = generator([constant_piece(0.0, 5.0), ramp], 3.0)
    >>> made.G, made.C @ made.start
    (array([[0., 0.],
           [1., 0.]]), array([5., 7.]))
    """
    here = [moved(piece, t) for piece in pieces]
    depth: dict[complex, int] = {0j: 1}
    for piece in here:
        for rate, polynomial in piece.terms:
            depth[complex(rate)] = max(depth.get(complex(rate), 0), len(polynomial))
    place: dict[complex, int] = {}
    size = 0
    for rate, count in depth.items():
        place[rate] = size
        size += count * (2 if rate.imag else 1)
    G, C, start = np.zeros((size, size)), np.zeros((len(pieces), size)), np.zeros(size)
    for rate, count in depth.items():
        _add_chain(G, place[rate], rate, count)
        start[place[rate]] = 1.0
    for row, piece in enumerate(here):
        for rate, polynomial in piece.terms:
            first, width = place[complex(rate)], 2 if complex(rate).imag else 1
            for k, c in enumerate(polynomial):
                at, value = first + k * width, complex(c) * math.factorial(k)
                C[row, at] += value.real
                if width == 2:
                    C[row, at + 1] -= value.imag
    chains = tuple(Chain(place[rate], rate, count) for rate, count in depth.items())
    return Generator(G, C, start, chains)


def _add_chain(G: Array, first: int, rate: complex, count: int) -> None:
    """The block of one rate: real and imaginary part of each component where the rate is complex."""
    width = 2 if rate.imag else 1
    for k in range(count):
        at = first + k * width
        block = np.array([[rate.real, -rate.imag], [rate.imag, rate.real]])[:width, :width]
        G[at : at + width, at : at + width] = block
        if k:
            G[at : at + width, at - width : at] = np.eye(width)
