"""Kirchhoff networks with diodes, switches and dry friction, in numbers.

Mechanically a node is a body, its voltage a speed: C is a mass, L a spring, R a damper, D a freewheel, K a
dog clutch, F a Coulomb friction between two bodies, V an imposed speed, I an imposed force.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import exp, log, sqrt

PORTS = ("D", "K", "G", "F")
"""Kinds of branches that switch."""

SOURCES = ("S", "V", "I")
"""Kinds of branches that a wave drives."""


@dataclass(frozen=True)
class Wave:
    """A constant, steps ``(instant, by how much)``, and ``amplitude sin(2 pi frequency t + phase)``."""

    constant: float = 0.0
    steps: tuple[tuple[float, float], ...] = ()
    amplitude: float = 0.0
    frequency: float = 0.0
    phase: float = 0.0

    def level(self, t: float) -> float:
        """The constant and the steps up to an instant, its own among them."""
        return self.constant + sum(by for at, by in self.steps if at <= t)

    @property
    def size(self) -> float:
        """No value is farther from zero."""
        return abs(self.constant) + sum(abs(by) for _, by in self.steps) + abs(self.amplitude)


@dataclass(frozen=True)
class Branch:
    """One element from node to node; node 0 is the ground. Currents count from tail to head.

    ==== =====================================================================================
    C, L ``value``; ``start``: its voltage, or its current, before the run
    R    ``value``
    D    a diode, conducting from tail to head, behind a resistance ``more``, which may be zero
    K    a switch, ``on`` at first, changing over at each of ``instants``
    G    a switch that a capacitor's voltage or a coil's current turns on above ``value``, and off below
         ``off``: that of the branch ``watched``, times ``sense``
    F    friction: it slips with the current ``value * sign(voltage)``, or has no voltage
    S    a source that lifts its head above its tail by ``wave``, behind a resistance ``more``
    V    the same without a resistance
    I    a source that drives the current ``wave``
    ==== =====================================================================================
    """

    kind: str
    name: str
    tail: int
    head: int
    value: float = 0.0
    more: float = 0.0
    wave: Wave = Wave()
    start: float = 0.0
    on: bool = False
    instants: tuple[float, ...] = ()
    watched: str = ""
    off: float = 0.0
    sense: int = 1

    def commanded(self, t: float) -> bool:
        """Whether a switch is on from an instant on."""
        return self.on ^ (sum(at <= t for at in self.instants) % 2 == 1)


@dataclass(frozen=True)
class Network:
    """Nodes 1 to ``nodes`` and the branches between them."""

    nodes: int
    branches: tuple[Branch, ...]

    def of(self, *kinds: str) -> list[Branch]:
        """The branches of some kinds, in their order."""
        return [branch for branch in self.branches if branch.kind in kinds]

    @property
    def breaks(self) -> list[float]:
        """Every instant at which a wave steps or a switch is told to change over."""
        steps = {at for b in self.branches for at, _ in b.wave.steps}
        return sorted(steps | {at for b in self.of("K") for at in b.instants})


def joined(*branches: Branch) -> Network:
    """The network of some branches."""
    return Network(max(max(b.tail, b.head) for b in branches), branches)


@dataclass(frozen=True)
class Units:
    """What one of a network's own units is in those it was given in: a voltage, a resistance, a time."""

    volt: float
    ohm: float
    second: float

    @property
    def ampere(self) -> float:
        """A current."""
        return self.volt / self.ohm


def units(network: Network) -> Units:
    """Units in which a network's values are near one, and no source or start is larger."""
    ohms = [b.value for b in network.of("R")] + [b.more for b in network.of("S", "D") if b.more]
    C, L = ([b.value for b in network.of(kind)] for kind in "CL")
    ohm = _mean(ohms) if ohms or not (C and L) else sqrt(_mean(L) / _mean(C))
    second = _mean([value * ohm for value in C] + [value / ohm for value in L])
    volts = [b.wave.size for b in network.of("S", "V")] + [abs(b.start) for b in network.of("C")]
    amperes = [b.wave.size for b in network.of("I")] + [abs(b.start) for b in network.of("L")]
    amperes += [b.value for b in network.of("F")]
    return Units(max([*volts, *(ohm * i for i in amperes)], default=1.0) or 1.0, ohm, second)


def _mean(values: list[float]) -> float:
    return exp(sum(map(log, values)) / len(values)) if values else 1.0


def measured(network: Network, by: Units) -> Network:
    """The network in other units."""
    coils = {b.name for b in network.of("L")}
    return replace(network, branches=tuple(_branch(b, by, coils) for b in network.branches))


def _branch(b: Branch, by: Units, coils: set[str]) -> Branch:
    watched = by.ampere if b.watched in coils else by.volt
    value = {
        "G": watched,
        "C": by.second / by.ohm,
        "L": by.second * by.ohm,
        "R": by.ohm,
        "F": by.ampere,
    }
    size = by.ampere if b.kind == "I" else by.volt
    wave = Wave(
        b.wave.constant / size, tuple((at / by.second, step / size) for at, step in b.wave.steps),
        b.wave.amplitude / size, b.wave.frequency * by.second, b.wave.phase,
    )  # fmt: skip
    return replace(
        b, value=b.value / value.get(b.kind, 1.0), more=b.more / by.ohm, wave=wave,
        start=b.start / (by.ampere if b.kind == "L" else by.volt),
        instants=tuple(at / by.second for at in b.instants), off=b.off / watched,
    )  # fmt: skip
