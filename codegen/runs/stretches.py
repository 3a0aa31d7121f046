"""What the exact stretches of a run are made of: modes as linear systems, worked out once."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from codegen.inputs.generators import Generator, generator
from codegen.inputs.pieces import Piece, Term, are_same, moved
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.numbers.latest import Latest, room_for
from codegen.program.affine import AffineMap
from codegen.runs.watched import Watched, inputs_of, watched

Told = tuple[tuple[Term, ...], ...]
"""What inputs do from one time on: equal where they do the same from another."""


@dataclass(frozen=True)
class Driving:
    """Pieces of inputs from one time [s] on, and the system that gives them."""

    pieces: tuple[Piece, ...]
    begin: float
    told: Told
    made: Generator

    def at(self, t: float) -> Array:
        """The system's components at a time."""
        if t == self.begin or len(self.made.start) == 1:
            return self.made.start
        return np.asarray(self.made.at(np.array([t - self.begin]))[0], dtype=float)


class Stretches:
    """The systems of a run by mode and by what inputs do; those that were not asked for longest go."""

    def __init__(self, model: ClosedModel) -> None:
        self._model = model
        self._used = Latest[Mode, tuple[int, ...]]()
        self._driving = Latest[tuple[int, ...], Driving]()
        self._generators = Latest[Told, Generator]()
        self._systems = Latest[tuple[Mode, Told], Watched](room_for(8 * model.size**2))

    def system(
        self, affine: AffineMap, mode: Mode, pieces: Sequence[Piece], t: float, rest: Array | None
    ) -> tuple[Watched, Array]:
        """An affine mode from t on as ``z' = M z``, and the part of z that the inputs are.

        ``rest``: what a sticking port's slip must stay below where only sources rule it.
        """
        model = self._model
        used = self._used.of(mode, lambda: tuple(inputs_of(model, affine, mode, model.size)))
        driving = self._driven(used, pieces, t)

        def made() -> Watched:
            return watched(model, affine, driving.made, mode, rest, used)

        found = self._systems.of((mode, driving.told), made) if rest is None else made()
        return found, driving.at(t)

    def _driven(self, used: tuple[int, ...], pieces: Sequence[Piece], t: float) -> Driving:
        """What these inputs do, told from where their pieces were first met."""
        here = tuple(pieces[i] for i in used)

        def made() -> Driving:
            told = tuple(moved(piece, t).terms for piece in here)
            made = self._generators.of(told, lambda: generator([Piece(t, one) for one in told], t))
            return Driving(here, t, told, made)

        found = self._driving.of(used, made)
        if not are_same(here, found.pieces):
            self._driving.drop(used)
            found = self._driving.of(used, made)
        return found
