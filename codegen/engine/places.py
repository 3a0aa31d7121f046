"""Where the C engine finds the modes that have been worked out, as many as there is room for."""

from typing import Any

import numpy as np

from codegen.engine.sizes import DIGITS, Engine
from codegen.model.snapshot import Mode

MOST_ROOM = 1 << 29
"""Bytes that the modes of a model may take at a time."""

FEW_ROOM = 1 << 27
"""Bytes of those of one run, beyond which steps to located events are quicker than working out more."""

FEWEST = 16
"""Modes that there must be room for: what C has in hand is among those it asked for last."""


class Places:
    """A place for every mode, in the order in which they were met: ``known``.

    Where there is room for no more, those that C asked for longest ago are forgotten, a quarter at a time.
    They keep their places, and are worked out again if a run comes back to them.
    """

    def __init__(self, engine: Engine, record: Any, most: int = MOST_ROOM) -> None:
        self.known: list[Mode] = []
        size = engine.ffi.sizeof("ex_mode")
        self.most: int = most // size
        self.few: int = max(FEW_ROOM // size, FEWEST)
        self._engine, self._record = engine, record
        self._at: dict[Mode, int] = {}
        self._made: dict[int, Any] = {}
        words, first = engine.sizes.numbers["WORDS"], 32
        self._keys = np.zeros((first, words), dtype=np.uint64)
        self._places = np.zeros(first, dtype=np.uintp)
        self._asked = np.zeros(first, dtype=np.uint64)
        self._point()

    @property
    def kept(self) -> int:
        """How many there are now."""
        return len(self._made)

    def made(self) -> list[tuple[Mode, Any]]:
        """The modes that are kept, with their records."""
        return [(self.known[at], made) for at, made in self._made.items()]

    def record_of(self, mode: Mode) -> Any:
        """The record of a mode; None where it is not kept."""
        at = self._at.get(mode)
        return None if at is None else self._made.get(at)

    def put(self, mode: Mode, made: Any) -> None:
        """Tell C of a mode that it knows not, or no more."""
        if len(self._made) >= self.most:
            self._forget()
        at = self._at.get(mode)
        if at is None:
            at = self._new(mode)
        self._made[at] = made
        self._places[at] = int(self._engine.ffi.cast("uintptr_t", made))

    def _new(self, mode: Mode) -> int:
        at = len(self.known)
        if at == len(self._keys):
            self._keys, self._places, self._asked = (
                np.concatenate([one, np.zeros_like(one)])
                for one in (self._keys, self._places, self._asked)
            )
            self._point()
        for i, sign in enumerate(mode):
            self._keys[at, i // DIGITS] |= np.uint64(sign % 3 << i % DIGITS * 2)
        self._at[mode] = at
        self.known.append(mode)
        self._record.count = len(self.known)
        return at

    def _forget(self) -> None:
        oldest = sorted(self._made, key=lambda at: int(self._asked[at]))
        for at in oldest[: max(1, len(oldest) // 4)]:
            self._places[at] = 0
            del self._made[at]

    def _point(self) -> None:
        ffi = self._engine.ffi
        self._record.keys = ffi.cast("ex_key *", self._keys.ctypes.data)
        self._record.modes = ffi.cast("ex_mode **", self._places.ctypes.data)
        self._record.used = ffi.cast("unsigned long long *", self._asked.ctypes.data)
