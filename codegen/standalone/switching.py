"""When an ideal switch changes over."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Switching:
    """When an ideal switch changes over: let go it gives zero, held it receives zero.

    ``on``: whether it is on while it is held. ``side``: of a one-sided switch, which is let go
    while ``side * y >= 0`` and held while ``side * u <= 0``; 0: of one that is told by the two
    guards from ``guard`` on, its conditions to turn on and off.
    """

    on: bool
    side: int
    guard: int = -1

    def word(self, sign: int) -> str:
        """What it is in a mode, held being 0: "on" or "off"."""
        return "on" if self.on == (sign == 0) else "off"

    def sign(self, on: bool) -> int:
        """The mode in which it is on, or off."""
        return 0 if on == self.on else 1
