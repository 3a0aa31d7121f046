"""Affine maps of friction modes as the columns of the C engine's records."""

from typing import Any

import numpy as np

from codegen.engine.sizes import Engine, view
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.numbers.thin import thin
from codegen.program.affine import AffineMap
from codegen.program.layout import CAPS, INPUTS, RATE, RATES_OF_INPUTS, READINGS, SHOT, STATES
from codegen.standalone.holding import Hold

ALL = slice(None)
"""Every column."""


class Filling:
    """Writes what maps over [s, w, w', 1] say into records, whole or only some of their columns.

    ``moved``: rows over states, inputs and rates of inputs, how fast slips change by them.
    """

    def __init__(
        self, engine: Engine, model: ClosedModel, moved: tuple[Array, Array, Array]
    ) -> None:
        self._engine, self._model = engine, model
        self._pushing = [thin(part) for part in moved]
        n, w, W = model.size, len(model.program.external), engine.sizes.W
        #: Where columns of maps stand in records, which have some for an input where there is none.
        self._places = np.r_[: n + w, n + W : n + W + w, engine.sizes.numbers["L"] - 1]

    def rows(self, field: Any, rows: Array, columns: Any = ALL, first: int = 0) -> None:
        """Write rows into a table that stands by columns, from row ``first`` of it on."""
        table = view(self._engine, field, len(field), -1)
        table[self._places[columns], first : first + len(rows)] = rows.T

    def shot(self, made: Any, affine: AffineMap, columns: Any = ALL) -> None:
        """Everything at an instant; the map has only the columns that are written."""
        size = self._engine.sizes.numbers
        at, lengths = 0, (size["X"], size["U"], *[size["PORTS"]] * 4, size["N"])
        for rows, length in zip(self._parts(affine), lengths, strict=True):
            self.rows(made.shot, rows, columns, at)
            at += length

    def left(self, made: Any, held: Hold, affine: AffineMap, columns: Any = ALL) -> None:
        """The slips that a mode's ports take from states."""
        rest = held.slip_x @ affine.rows(STATES) + held.slip_u @ affine.rows(INPUTS)
        made.held = len(rest)
        self.rows(made.left, rest, columns)

    def _parts(self, affine: AffineMap) -> list[Array]:
        """The rows of each part of the engine's snapshot, in their order."""
        model = self._model
        x, u, du = (affine.rows(part) for part in (STATES, INPUTS, RATES_OF_INPUTS))
        pushes = sum(by @ part for by, part in zip(self._pushing, (x, u, du), strict=True))
        efforts, slips = u[model.friction_inputs], affine.rows(READINGS)[model.friction_readings]
        found = {
            "x": x, "u": u, "slip": slips, "effort": efforts, "cap": affine.rows(CAPS), "push": pushes,
            "rate": affine.rows(RATE),
        }  # fmt: skip
        return [found[part] for part in SHOT]
