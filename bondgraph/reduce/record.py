"""`Reading`: a signal over states, inputs and their rates; and the sum in which one is gathered."""

from dataclasses import dataclass
from typing import Any

import sympy as sp

from bondgraph.algebra.exact import FixedRow, Row, add_scaled, fixed


@dataclass(frozen=True)
class Reading:
    """One signal as ``F x + D u + H x' + K u'``: sparse rows over the states and the inputs.

    The rows are copies of those given, and read-only.
    """

    F: FixedRow
    D: FixedRow
    H: FixedRow
    K: FixedRow

    def __post_init__(self) -> None:
        for name in "FDHK":
            object.__setattr__(self, name, fixed(getattr(self, name)))

    def __reduce__(self) -> tuple[Any, ...]:
        """Copied and pickled by its rows, as read-only mappings by themselves cannot be."""
        return Reading, tuple(map(dict, self.parts))

    @property
    def parts(self) -> tuple[FixedRow, FixedRow, FixedRow, FixedRow]:
        """F, D, H and K."""
        return self.F, self.D, self.H, self.K


class ReadingSum:
    """A sum of readings in the making: what is added to it changes it, until `whole` tells what it is.

    ``start``: what it begins with; left out, nothing.
    """

    F: Row
    D: Row
    H: Row
    K: Row

    def __init__(self, start: Reading | None = None) -> None:
        rows = (({},) * 4) if start is None else start.parts
        self.F, self.D, self.H, self.K = map(dict, rows)

    def add(self, other: Reading, factor: sp.Expr) -> None:
        """Add a multiple of a reading."""
        if factor == 0:
            return
        for mine, theirs in zip((self.F, self.D, self.H, self.K), other.parts, strict=True):
            add_scaled(mine, theirs, factor)

    def whole(self) -> Reading:
        """The sum so far."""
        return Reading(self.F, self.D, self.H, self.K)
