"""How the states of a friction mode move by themselves: the same for all modes with the same rates."""

import hashlib
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy

from codegen.numbers.arrays import Array
from codegen.numbers.latest import Latest, room_for
from codegen.program.affine import AffineMap
from codegen.program.layout import RATE


@dataclass(frozen=True)
class Motion:
    """``rate``: of s, by s; ``fastest`` [1/s]: the largest of its rates, or a bound on it."""

    rate: Array
    fastest: float

    @cached_property
    def weight(self) -> Array:
        """What balances the rates, so that they have about one size by rows and columns."""
        scale = scipy.linalg.matrix_balance(self.rate, permute=False, separate=True)[1][0]
        return np.asarray(1 / scale)

    @cached_property
    def spectrum(self) -> Array:
        """A row for each rate [1/s]: its magnitude, and how fast it decays."""
        found = np.linalg.eigvals(self.rate)
        return np.column_stack([np.abs(found), -found.real])


class Motions:
    """The latest motions of a model whose integrated vector is so long."""

    def __init__(self, size: int) -> None:
        self._size = size
        self._kept = Latest[bytes, Motion](room_for(size * size))

    def of(self, affine: AffineMap) -> Motion:
        """That of a mode: of one that slips the other way, if it has the same rates."""
        rate = np.ascontiguousarray(affine.rows(RATE)[:, : self._size])
        key = hashlib.blake2b(rate.tobytes(), digest_size=16).digest()
        return self._kept.of(key, lambda: Motion(rate.copy(), affine.fastest))
