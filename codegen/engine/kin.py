"""Modes in which the same ports stick, and friction slips other ways: their records differ in few columns."""

from functools import cached_property
from typing import Any

from codegen.engine.places import Places
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.numbers.latest import Latest
from codegen.standalone.arrays import Places as Columns

Held = tuple[bool, ...]


class Kin:
    """A record of each of the latest sets of ports that stick.

    There is none of models with switches, whose impulses are told by modes, nor where a state rules a
    level, so that the rates of states differ as well.
    """

    def __init__(self, places: Places, model: ClosedModel) -> None:
        self._places, self._model = places, model
        self._latest = Latest[Held, Mode]()

    @cached_property
    def columns(self) -> Columns:
        """In which they differ, of maps over [s, w, w', 1]."""
        return self._model.maps.turning(len(self._model.program.external))

    def of(self, mode: Mode) -> Any:
        """A record that is kept of such a mode; None if there is none."""
        held = tuple(sign == 0 for sign in mode)
        found = self._places.record_of(self._latest.of(held, lambda: mode))
        if found is None:
            self._latest.put(held, mode)
        return found if found is not None and found.supported and self.are_alike else None

    @cached_property
    def are_alike(self) -> bool:
        """Whether records of kin are copies but for a few columns."""
        program = self._model.program
        if program.switched or not program.friction:
            return False
        return bool((self.columns >= self._model.size).all())
