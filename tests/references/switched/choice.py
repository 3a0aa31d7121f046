"""Which mode begins at an instant.

Every trigger's chain of impulse, value and derivatives must not begin below zero. So, without a rule for
each kind: what conducts keeps its current's sign and what blocks its voltage's; what sticks takes no impulse,
as its level is finite beside one, and at its level the current's rate decides; what slips has the sign of its
slip. Switches are as commanded; what a voltage or current turns on stays as it is while that lets it.
"""

from __future__ import annotations

from collections.abc import Iterator
from heapq import heappop, heappush
from itertools import combinations, product

import numpy as np

from references.switched.modes import Impossible, Motion, motion
from references.switched.network import PORTS
from references.switched.pencil import Array, Layout

Mode = tuple[int, ...]

ENUMERATED = 8
"""Of no more undecided ports every combination is tried before there is said to be none."""

PIVOTS = 400

JUMPS = 20


class Choice:
    """The modes of one network, each worked out once."""

    def __init__(self, layout: Layout) -> None:
        self.ports = layout.network.of(*PORTS)
        self._layout = layout
        self._motions: dict[Mode, Motion | Impossible] = {}
        self._free = [k for k, b in enumerate(self.ports) if b.kind != "K"]
        self._at = {b.name: k for k, b in enumerate(self.ports)}

    def motion(self, mode: Mode) -> Motion | Impossible:
        """The motion in a mode."""
        if mode not in self._motions:
            named = {b.name: way for b, way in zip(self.ports, mode, strict=True)}
            self._motions[mode] = motion(self._layout, named)
        return self._motions[mode]

    def begin(self, old: Mode, y: Array) -> tuple[Mode, Array]:
        """The mode that begins with the charges and currents of y and the commands of ``old``; its y.

        What carries an impulse may be done with it: after the jump the mode is chosen again, at the same
        instant. Of several modes one with few changes, and of that what friction can stick, sticks.
        """
        for _ in range(JUMPS):
            old = self._after(old, y)
            made = self.motion(old)
            assert isinstance(made, Motion)
            y = made.Q @ made.read @ y
            if self._against(old, y) is None:
                return old, y
        raise RuntimeError(f"impulses without end: {self._told(old, y)}")

    def _after(self, old: Mode, y: Array) -> Mode:
        found = self._pivoted(old, y)
        if found is None and len(self._free) <= ENUMERATED:
            found = next((m for m in self._all(old) if self._against(m, y) is None), None)
        if found is None:
            few = len(self._free) <= ENUMERATED
            what = "no mode is consistent" if few else "no consistent mode was found"
            raise RuntimeError(f"{what}: {self._told(old, y)}")
        return self._resting(self._latched(old, found, y), y)

    def _latched(self, old: Mode, mode: Mode, y: Array) -> Mode:
        """The same with whatever a voltage or a current turns as it was, as far as that lets it."""
        kinds = [b.kind for b in self.ports]
        turned = [k for k, kind in enumerate(kinds) if kind == "G" and mode[k] != old[k]]
        for count in range(len(turned), 0, -1):
            for some in combinations(turned, count):
                new = mode
                for k in some:
                    new = self._but(new, self.ports[k].name, old[k])
                if self._against(new, y) is None:
                    return new
        return mode

    def loose(self, mode: Mode, y: Array) -> set[str]:
        """Ports that might as well be in another mode from now on, all of their chain being zero."""
        made = self.motion(mode)
        assert isinstance(made, Motion)
        idle = {
            one
            for ways, told in zip(made.ways, made.verdicts(y), strict=True)
            for one in ways
            if told == 0
        }
        return {name for name, way in idle if self._against(self._but(mode, name, way), y) is None}

    def _against(self, mode: Mode, y: Array) -> set[tuple[str, int]] | None:
        """What ports would do instead, as far as they have a say, where a mode cannot begin."""
        made = self.motion(mode)
        if isinstance(made, Impossible):
            return {one for name in made.ports for one in self._others(name, mode)}
        told = made.verdicts(y)
        wrong = [ways for ways, sign in zip(made.ways, told, strict=True) if sign < 0]
        return {one for ways in wrong for one in ways} if wrong else None

    def _others(self, name: str, mode: Mode) -> Iterator[tuple[str, int]]:
        at = self._at.get(name)
        if at in self._free:
            ways = (-1, 0, 1) if self.ports[at].kind == "F" else (0, 1)
            yield from ((name, way) for way in ways if way != mode[at])

    def _but(self, mode: Mode, name: str, way: int) -> Mode:
        at = self._at[name]
        return (*mode[:at], way, *mode[at + 1 :])

    def _pivoted(self, old: Mode, y: Array) -> Mode | None:
        """From a mode to the next by what is against it, all at once or one port at a time, best first."""
        waiting: list[tuple[int, int, Mode]] = [(0, 0, old)]
        seen = {old}
        for _ in range(PIVOTS):
            if not waiting:
                return None
            mode = heappop(waiting)[2]
            against = self._against(mode, y)
            if against is None:
                return mode
            wrong = sorted(against, key=lambda one: (self._at[one[0]], one[1]))
            together = mode
            for one in wrong:
                together = self._but(together, *one)
            for new in (*(self._but(mode, *one) for one in wrong), together):
                if new not in seen:
                    seen.add(new)
                    heappush(waiting, (len(self._against(new, y) or ()), len(seen), new))
        return None

    def _all(self, old: Mode) -> Iterator[Mode]:
        """Every mode, by the number of changes."""
        for count in range(len(self._free) + 1):
            for some in combinations(self._free, count):
                choices = [tuple(self._others(self.ports[k].name, old)) for k in some]
                for chosen in product(*choices):
                    mode = old
                    for one in chosen:
                        mode = self._but(mode, *one)
                    yield mode

    def _resting(self, mode: Mode, y: Array) -> Mode:
        """The same with whatever friction can stick of that which would never slip."""
        made = self.motion(mode)
        assert isinstance(made, Motion)
        told = made.verdicts(y)
        idle = sorted({
            name
            for ways, sign in zip(made.ways, told, strict=True)
            for name, way in ways
            if sign == 0 and way == 0 and self.ports[self._at[name]].kind == "F"
        })  # fmt: skip
        for count in range(len(idle), 0, -1):
            for some in combinations(idle, count):
                new = mode
                for name in some:
                    new = self._but(new, name, 0)
                if self._against(new, y) is None:
                    return new
        return mode

    def _told(self, mode: Mode, y: Array) -> str:
        made = self.motion(mode)
        if isinstance(made, Impossible):
            return f"{mode} is impossible by {sorted(made.ports)}"
        first = np.round(made.chains(y)[0][:, :3], 9).tolist()
        return f"{mode}: {[(sorted(w), c) for w, c in zip(made.ways, first, strict=True)]}"
