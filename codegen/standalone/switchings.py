"""When switches change over, and the ways to try: from the one at hand to those farther off."""

import math
from collections.abc import Generator, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

from codegen.standalone.arrays import Mode

Broken = frozenset[int]
"""Ports that contradict a mode."""

ALL_WAYS = 12
"""With more switches than these, further ways are those of few changes only."""

FEW = 2
"""So many changes at once, of more switches."""

TURNS = 50
"""So often for each switch those that contradict change over, before all ways are tried .."""

MOST_TURNS = 1000
""".. and in all; the same for the first that contradicts."""


@dataclass(frozen=True)
class Switching:
    """When an ideal switch changes over: let go it gives zero, held it receives zero.

    ``on``: whether it is on while it is held. ``side``: of a one-sided switch, which is let go
    while ``side * y >= 0`` and held while ``side * u <= 0``; 0: of one that is told by the two
    guards from ``guard`` on, its conditions to turn on and off. ``slides``: of one way in which dry
    friction slips that gives a flow: held it slips. ``place``: of a stop the place in s of its
    displacement; ``guard`` is its gap then, which changes by ``opening`` with that, and the next
    its restitution. It is on while it is apart, and where the gap is closed it has the two sides
    of a one-sided switch. ``bound``: whether it is declared as a stop, which touches and is apart.
    ``machine``: of a transition of a state machine, taken as it turns on, which, from 1 on.
    """

    on: bool
    side: int
    guard: int = -1
    slides: bool = False
    place: int = -1
    opening: int = 0
    bound: bool = False
    machine: int = 0

    @property
    def stops(self) -> bool:
        """Whether it is a stop."""
        return self.place >= 0

    @property
    def guards(self) -> tuple[str, ...]:
        """What its guards tell."""
        if self.stops:
            return "gap", "restitution"
        return () if self.side else ("on", "off")

    @property
    def words(self) -> tuple[str, str]:
        """What it is while it is on, and while it is off."""
        if self.slides:
            return ("slip", "stick") if self.on else ("stick", "slip")
        return ("apart", "touch") if self.bound else ("on", "off")

    def word(self, sign: int) -> str:
        """What it is in a mode, held being 0: "on" or "off", of friction "slip" or "stick"."""
        return self.words[self.on != (sign == 0)]

    def is_on(self, sign: int) -> bool:
        """Whether it is on in a mode."""
        return self.on == (sign == 0)

    def condition(self, sign: int) -> int:
        """The guard that changes it over in a mode."""
        return self.guard + (self.on == (sign == 0))

    def sign(self, on: bool) -> int:
        """The mode in which it is on, or off."""
        return 0 if on == self.on else 1


@dataclass(frozen=True)
class Reset:
    """What a state becomes as a port changes over, or at an impact of a stop.

    ``port``: its place; ``sign``: the mode that it comes to; ``place``: of the state in s;
    ``value``: of what it becomes, among the guards. Of a task, which has instants of its own,
    ``port`` is -1 less its place among the clocks. Those of transitions happen at the begin of a
    run, too.
    """

    port: int
    sign: int
    place: int
    value: int


@dataclass(frozen=True)
class Clock:
    """The instants ``(k*every + offset)/unit`` [s], k = 0, 1, ..., all three whole numbers.

    Each is one division, rounded once: the same doubles wherever they are worked out.

    >>> clock = Clock(1.0, 0.0, 100.0)
    >>> clock.following(0.28), clock.following(0.29), clock.strikes(0.29), clock.following(-3.0)
    (0.29, 0.3, True, 0.0)
    >>> clock.latest(0.295), clock.latest(0.29), clock.latest(-3.0)
    (0.29, 0.29, -inf)
    """

    every: float
    offset: float
    unit: float

    def instant(self, k: float) -> float:
        """Instant number k."""
        return (k * self.every + self.offset) / self.unit

    def following(self, t: float) -> float:
        """The first instant after t."""
        k = max(math.floor((t * self.unit - self.offset) / self.every) - 1.0, 0.0)
        while self.instant(k) <= t:
            k += 1.0
        return self.instant(k)

    def latest(self, t: float) -> float:
        """The last instant up to t; before the first minus infinity."""
        k = math.floor((t * self.unit - self.offset) / self.every) + 1.0
        while k >= 0 and self.instant(k) > t:
            k -= 1.0
        return self.instant(k) if k >= 0 else -math.inf

    def strikes(self, t: float) -> bool:
        """Whether t is one of its instants."""
        k = math.floor((t * self.unit - self.offset) / self.every + 0.5)
        return k >= 0 and self.instant(k) == t


def flipped(mode: Mode, ports: Iterable[int]) -> Mode:
    """The mode with these switches changed over.

    >>> flipped((1, 0, -1), [0, 1])
    (0, 1, -1)
    """
    changed = set(ports)
    return tuple(1 - sign if i in changed else sign for i, sign in enumerate(mode))


def first_taken(switching: Sequence[Switching | None], before: Mode, mode: Mode) -> Mode:
    """The mode in which of each machine's transitions that turn on the first alone does.

    >>> one = Switching(True, 0, 0, machine=1)
    >>> first_taken((one, one, one), (1, 0, 1), (0, 0, 0))
    (0, 0, 1)
    """
    taken, late = set[int](), list[int]()
    for i, one in enumerate(switching):
        if one is not None and one.machine and one.is_on(mode[i]) and mode[i] != before[i]:
            late += [i] if one.machine in taken else []
            taken.add(one.machine)
    return flipped(mode, late) if late else mode


def way_of(mode: Mode, port: int) -> int:
    """Which way friction slips that gives a flow, ``port`` being its way forwards; 0: it sticks."""
    return (mode[port] == 0) - (mode[port + 1] == 0)


def switchings(
    first: Mode, switches: list[int], guarded: Broken = frozenset()
) -> Generator[Mode, Broken, None]:
    """Modes to try, each once; after each the switches that contradict it are sent.

    First all that contradict change over, until that has been tried; then the first of them
    (Murty's rule, which ends where the modes' conditions are a linear complementarity problem with
    positive minors: Cottle, Pang, Stone 1992, section 4.2); then all, by how many changes they are
    away. ``guarded``: switches with conditions of their own. As they are is as good as changed over
    while none holds, so those that contradict no mode change over last.
    """
    contradicted: set[int] = set()
    seen: set[Mode] = set()
    mode, last, broken = first, first, frozenset[int]()
    for every in (True, False):
        for _ in range(min(TURNS * len(switches), MOST_TURNS) or 1):
            if mode in seen:
                break
            seen.add(mode)
            broken = yield mode
            contradicted |= broken
            if not broken:
                break
            mode, last = flipped(mode, broken if every else [min(broken)]), mode
        if not broken:
            break
        mode = flipped(last, [min(broken)])
    for changed in _changes(switches, guarded, contradicted):
        mode = flipped(first, changed)
        if mode not in seen:
            seen.add(mode)
            contradicted |= yield mode


def _changes(
    switches: list[int], guarded: Broken, contradicted: set[int]
) -> Iterator[tuple[int, ...]]:
    """Switches to change over, few first; last of all those guarded that have not contradicted."""
    most = len(switches) if len(switches) <= ALL_WAYS else FEW
    for last_of_all in (False, True):
        for count in range(1, most + 1):
            for changed in combinations(switches, count):
                if last_of_all or contradicted.issuperset(guarded.intersection(changed)):
                    yield changed
