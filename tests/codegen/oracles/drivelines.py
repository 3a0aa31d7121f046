"""Random drivelines whose slips are partly or wholly ruled by sources, as bond graphs and as matrices.

Shafts are masses or turned by sources; springs, dampers and friction lie between two of them or
between one and the ground. Pulses of forces, speeds and levels last 1e-4 of the run.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import networkx as nx
import numpy as np
from references.build import bond_graph
from references.friction import Course, Driveline, Machine, Wave

import bondgraph as bg
from codegen import Result, Sampled, Signal, Sine

SPAN = 2.0
"""How long a run is [s]."""

PULSE = 1e-4 * SPAN
"""How long a pulse is [s]."""

Place = tuple[int, int | None]
"""Between two shafts, or a shaft and the ground."""


@dataclass(frozen=True)
class Random:
    """One driveline: which shafts are masses, what lies where, and what drives it."""

    masses: tuple[float, ...]
    speeds: tuple[Wave, ...]
    springs: dict[Place, float]
    dampers: dict[Place, float]
    friction: tuple[Place, ...]
    levels: tuple[Wave, ...]
    forces: tuple[Wave, ...]
    start: tuple[float, ...]

    def matrices(self) -> Driveline:
        """For the judge."""
        D_v, D_w = self._ways(list(self.dampers))
        S_v, S_w = self._ways(list(self.springs))
        W, Z = self._ways(self.friction)
        return Driveline(
            np.array(self.masses), D_v, D_w, np.array(list(self.dampers.values())),
            S_v, S_w, np.array(list(self.springs.values())), W, Z,
            self.levels, self.forces, self.speeds,
            np.concatenate([self.start, np.zeros(len(self.springs))]),
        )  # fmt: skip

    def _ways(self, places: Sequence[Place]) -> tuple[np.ndarray, np.ndarray]:
        n, rows = len(self.masses), np.zeros((len(places), len(self.masses) + len(self.speeds)))
        for row, (a, b) in zip(rows, places, strict=True):
            row[a] = 1.0
            if b is not None:
                row[b] = -1.0
        return rows[:, :n], rows[:, n:]

    def graph(self) -> nx.DiGraph:
        """A 1-junction for each shaft and each relative speed in use."""
        nodes, bonds, n = [], [], len(self.masses)
        for i, mass in enumerate(self.masses):
            nodes += [bg.One(f"n{i}"), bg.I(f"m{i}", mass, flow=f"v{i}"), bg.Se(f"p{i}", f"P{i}")]
            bonds.append(f"p{i}>n{i}>m{i}")
        for k in range(len(self.speeds)):
            nodes += [bg.One(f"n{n + k}"), bg.Sf(f"w{k}", f"W{k}")]
            bonds.append(f"w{k}>n{n + k}")
        used = dict.fromkeys([*self.springs, *self.dampers, *self.friction])
        at = {place: f"n{place[0]}" for place in used}
        for k, (a, b) in enumerate(used):
            if b is not None:
                nodes += [bg.Zero(f"z{k}"), bg.One(f"r{k}")]
                bonds.append(f"n{a}>z{k}>n{b} z{k}>r{k}")
                at[a, b] = f"r{k}"
        for k, (place, value) in enumerate(self.springs.items()):
            nodes.append(bg.C(f"c{k}", 1 / value, effort=f"F{k}"))
            bonds.append(f"{at[place]}>c{k}")
        for k, (place, value) in enumerate(self.dampers.items()):
            nodes.append(bg.R(f"b{k}", value))
            bonds.append(f"{at[place]}>b{k}")
        for k, place in enumerate(self.friction):
            nodes.append(bg.R(f"rub{k}", law=bg.DryFriction(f"L{k}"), effort=f"f{k}", flow=f"s{k}"))
            bonds.append(f"{at[place]}>rub{k}")
        return bond_graph(nodes, " ".join(bonds))

    def inputs(self) -> dict[str, Signal]:
        """The waves as signals, by the names in the graph."""
        named = {f"P{i}": wave for i, wave in enumerate(self.forces)}
        named |= {f"W{k}": wave for k, wave in enumerate(self.speeds)}
        named |= {f"L{k}": wave for k, wave in enumerate(self.levels)}
        return {name: as_signal(wave) for name, wave in named.items()}


def as_signal(wave: Wave) -> Signal:
    """The same over time as a signal of the toolkit; a wave's lines join."""
    ends = [*wave.begins[1:], 2 * SPAN]
    values = [*wave.values, wave.values[-1] + wave.slopes[-1] * (ends[-1] - wave.begins[-1])]
    line = Sampled([*wave.begins, ends[-1]], values)
    if not wave.amplitude:
        return line
    return line + Sine(wave.amplitude, wave.omega / (2 * np.pi), phase=wave.phase)


def complaints(
    line: Random, times: np.ndarray, result: Result, course: Course | None = None
) -> list[str]:
    """What in a run is not as the judge finds it: states, efforts where they are unique, events."""
    machine = Machine(line.matrices())
    course = course or machine.run(times)
    found = np.array(course.states)
    wrong = [
        f"{name}: off by {far:.3g}"
        for name, expected in _states(line, found).items()
        if (far := np.abs(result[name] - expected).max()) > 1e-8 * (1 + np.abs(expected).max())
    ]
    for at, t in enumerate(times):
        slips = machine.slips(t, found[at])
        for k, f in enumerate(machine.efforts(t, found[at], course.modes[at])):
            # Within rounding of zero either side of an event is right.
            sure = course.modes[at][k] == 0 or abs(slips[k]) > 1e-7
            if sure and abs(result[f"f{k}"][at] - f) > 1e-7 * (1 + abs(f)):
                wrong.append(f"f{k} at {t:g}: {result[f'f{k}'][at]:.9g} for {f:.9g}")
    told = sorted((round(e.time, 6), str(e.port), e.kind) for e in result.events)
    right = sorted((round(t, 6), f"rub{k}", kind) for t, k, kind in course.events)
    near = len(told) == len(right) and all(
        a[1:] == b[1:] and abs(a[0] - b[0]) < 3e-6 for a, b in zip(told, right, strict=True)
    )
    return wrong if near else [*wrong, f"events {told} for {right}"]


def _states(line: Random, found: np.ndarray) -> dict[str, np.ndarray]:
    n = len(line.masses)
    speeds = {f"v{i}": found[:, i] for i in range(n)}
    forces = {f"F{k}": c * found[:, n + k] for k, c in enumerate(line.springs.values())}
    return speeds | forces


def random_driveline(rng: np.random.Generator) -> Random:
    """No to two masses, one or two shafts turned by sources, one to three friction ports."""
    n, k = int(rng.integers(0, 3)), int(rng.integers(1, 3))
    shafts = range(n + k)
    places: list[Place] = [(a, None) for a in shafts]
    places += [(a, b) for a in shafts for b in shafts if a < b]
    springs = {p: _number(rng, 5, 60) for p in places if p[0] < n and rng.random() < 0.3}
    dampers = {p: _number(rng, 0.05, 3) for p in places if p[0] < n and rng.random() < 0.3}
    ruled = [p for p in places if p[0] >= n]
    chosen = [places[i] for i in rng.choice(len(places), size=int(rng.integers(1, 4)))]
    if rng.random() < 0.5:
        chosen[0] = ruled[int(rng.integers(len(ruled)))]
    _join(rng, n, n + k, springs, dampers, chosen)
    return Random(
        tuple(_number(rng, 0.3, 3) for _ in range(n)),
        tuple(_wave(rng, 2.0, zero=0.3) for _ in range(k)),
        springs, dampers, tuple(chosen),
        tuple(_level(rng) for _ in chosen),
        tuple(_wave(rng, 4.0, zero=0.2) for _ in range(n)),
        tuple(round(float(rng.normal()), 2) for _ in range(n)),
    )  # fmt: skip


def _join(
    rng: np.random.Generator, masses: int, shafts: int, springs: dict[Place, float],
    dampers: dict[Place, float], friction: list[Place],
) -> None:  # fmt: skip
    """Tie shafts that nothing joins to the first: masses by springs, others by friction."""
    for b in range(1, shafts):
        tied: nx.Graph[int] = nx.Graph()
        tied.add_nodes_from(range(shafts))
        joints = [*springs, *dampers, *friction]
        tied.add_edges_from((a, b) for a, b in joints if b is not None)
        if not nx.has_path(tied, 0, b):
            if masses:
                springs[0, b] = _number(rng, 5, 60)
            else:
                friction.append((0, b))


def _number(rng: np.random.Generator, least: float, most: float) -> float:
    return round(float(rng.uniform(least, most)), 3)


def _wave(rng: np.random.Generator, size: float, zero: float) -> Wave:
    """Zero, a ramp, a sine, or one of these with pulses."""
    base = float(rng.normal() * size * (rng.random() > zero))
    wave = joined(base, _pulses(rng, base, size))
    if rng.random() < 0.5:
        omega, phase = _number(rng, 1, 12), _number(rng, 0, 6)
        return Wave(wave.begins, wave.values, wave.slopes, _number(rng, 0.3, size), omega, phase)
    return wave


def _level(rng: np.random.Generator) -> Wave:
    """A level with pulses up and down, never below zero."""
    base = _number(rng, 0.3, 3)
    return joined(base, _pulses(rng, base, 1.0, least=-base))


def _pulses(
    rng: np.random.Generator, base: float, size: float, least: float = -np.inf
) -> list[tuple[float, float]]:
    """Corners (time, value) of up to three pulses, and of a slow change."""
    corners, begins = [], np.sort(rng.uniform(0.05, 0.9, size=int(rng.integers(0, 4)))) * SPAN
    for begin in begins[np.diff(begins, prepend=-1.0) > 2 * PULSE].tolist():
        top = base + max(float(rng.normal() * 3 * size), least)
        rise = 0.1 * PULSE
        corners += [
            (begin, base), (begin + rise, top), (begin + PULSE - rise, top), (begin + PULSE, base)
        ]  # fmt: skip
    return corners


def joined(first: float, corners: Sequence[tuple[float, float]]) -> Wave:
    """Lines from corner to corner, constant before and after."""
    points = [(0.0, first), *corners]
    begins, values = zip(*points, strict=True)
    slopes = [(b - a) / (t_b - t_a) for (t_a, a), (t_b, b) in pairwise(points)]
    return Wave(begins, values, (*slopes, 0.0))
