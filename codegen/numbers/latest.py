"""What was worked out last, so many of it: what a run keeps does not grow with its length."""

from collections.abc import Callable, Hashable
from typing import Generic, TypeVar

Key = TypeVar("Key", bound=Hashable)
Value = TypeVar("Value")

ROOM = 1 << 22
"""Numbers that all entries of one kind may have together."""

FEWEST, MOST = 8, 256
"""Entries that are kept at the least, however large, and at the most."""


class Latest(Generic[Key, Value]):
    """The latest entries asked for, by key; the one that was not asked for longest goes first.

    >>> squares = Latest[int, int](2)
    >>> [squares.of(k, lambda: k * k) for k in (3, 4, 3, 5)], 3 in squares, 4 in squares
    ([9, 16, 9, 25], True, False)
    """

    def __init__(self, most: int = MOST) -> None:
        self._most, self._kept = most, dict[Key, Value]()

    def __contains__(self, key: Key) -> bool:
        return key in self._kept

    def __len__(self) -> int:
        return len(self._kept)

    def of(self, key: Key, make: Callable[[], Value]) -> Value:
        """What belongs to a key; it is made where it is not kept."""
        kept = self._kept
        if key in kept:
            found = kept.pop(key)
        else:
            found = make()
            while len(kept) >= self._most:
                del kept[next(iter(kept))]
        kept[key] = found
        return found

    def put(self, key: Key, value: Value) -> None:
        """Keep this for a key, in place of what was kept."""
        self.drop(key)
        self.of(key, lambda: value)

    def get(self, key: Key) -> Value | None:
        """What belongs to a key, if it is kept."""
        found = self._kept.pop(key, None)
        if found is not None:
            self._kept[key] = found
        return found

    def drop(self, key: Key) -> None:
        """Forget what belongs to a key."""
        self._kept.pop(key, None)


def room_for(size: int) -> int:
    """How many entries of so many numbers are kept.

    >>> room_for(10), room_for(200_000), room_for(10**9)
    (256, 20, 8)
    """
    return min(MOST, max(FEWEST, ROOM // max(size, 1)))
