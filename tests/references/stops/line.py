"""Bodies on a line, what pulls and drives them, and the stops between them, as matrices.

    M v' = p(t) - C v - K x + G^T f,    x' = v,    gap = G x - b >= 0

Some bodies are moved by sources: their rows have no M. Sources are constants and sines, whose generators
are states, too: all in all ``X' = A X`` with X = (positions, speeds of free bodies, generators).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Place = tuple[int, int | None]
"""Between two bodies, or a body and the ground."""


@dataclass(frozen=True)
class Wave:
    """A constant and a sine."""

    constant: float = 0.0
    amplitude: float = 0.0
    omega: float = 0.0
    phase: float = 0.0


@dataclass(frozen=True)
class Bound:
    """A stop: ``way * (x_a - x_b)`` does not fall below ``way * at``; ``bounce``: its restitution."""

    name: str
    place: Place
    at: float
    way: int = 1
    bounce: float = 0.0


@dataclass(frozen=True)
class Line:
    """Free bodies first, then those that sources move; springs have a stiffness and a stretch at first."""

    masses: tuple[float, ...]
    positions: tuple[float, ...]
    speeds: tuple[float, ...]
    stops: tuple[Bound, ...] = ()
    forces: tuple[Wave, ...] = ()
    driven: tuple[Wave, ...] = ()
    springs: dict[Place, tuple[float, float]] = field(default_factory=dict)
    dampers: dict[Place, float] = field(default_factory=dict)

    @cached_property
    def matrices(self) -> Matrices:
        """The equations of motion."""
        return Matrices(self)


class Matrices:
    """X' = A X without contacts; ``gaps`` and ``rates``: rows of gaps and their speeds; ``push``: what
    unit forces of stops do to X'."""

    def __init__(self, line: Line) -> None:
        self.n, self.all = len(line.masses), len(line.masses) + len(line.driven)
        waves = [*(line.forces or [Wave()] * self.n), *line.driven]
        self._one = self.all + self.n
        self.size = self._one + 1 + 2 * len(waves)
        self.A = np.zeros((self.size, self.size))
        self.start = np.zeros(self.size)
        self.start[: self.all], self.start[self.all : self._one] = line.positions, line.speeds
        self.start[self._one] = 1.0
        self.inverse = 1 / np.array(line.masses)
        speed = np.zeros((self.all, self.size))
        speed[: self.n, self.all : self._one] = np.eye(self.n)
        force = np.zeros((self.n, self.size))
        for k, wave in enumerate(waves):
            row = (force if k < self.n else speed)[k]
            row += self._wave(wave, self._one + 1 + 2 * k)
        place = np.eye(self.all, self.size)
        for (a, b), (stiffness, stretch) in line.springs.items():
            way = self._way(a, b)
            pull = stiffness * (way @ place)
            pull[self._one] += stiffness * (stretch - way @ self.start[: self.all])
            force -= np.outer(way[: self.n], pull)
        for (a, b), damping in line.dampers.items():
            way = self._way(a, b)
            force -= damping * np.outer(way[: self.n], way @ speed)
        self.A[: self.all] = speed
        self.A[self.all : self._one] = self.inverse[:, None] * force
        self._contacts(line.stops, place, speed)

    def _contacts(self, stops: Sequence[Bound], place: Array, speed: Array) -> None:
        ways = np.array([s.way * self._way(*s.place) for s in stops]).reshape(-1, self.all)
        self.gaps = ways @ place
        self.gaps[:, self._one] -= [s.way * s.at for s in stops]
        self.rates = ways @ speed
        self.push = np.zeros((self.size, len(stops)))
        self.push[self.all : self._one] = self.inverse[:, None] * ways[:, : self.n].T
        self.shares = self.rates @ self.push
        """Speeds of gaps by unit impulses, symmetric."""

    def _wave(self, wave: Wave, at: int) -> Array:
        """The row of a wave whose sine and cosine are states from ``at`` on."""
        row = np.zeros(self.size)
        row[self._one], row[at] = wave.constant, wave.amplitude
        self.A[at, at + 1], self.A[at + 1, at] = wave.omega, -wave.omega
        self.start[at], self.start[at + 1] = np.sin(wave.phase), np.cos(wave.phase)
        return row

    def _way(self, a: int, b: int | None) -> Array:
        way = np.zeros(self.all)
        way[a] = 1.0
        if b is not None:
            way[b] = -1.0
        return way
