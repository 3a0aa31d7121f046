"""Random bodies with up to six stops, some of which touch at the start."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import networkx as nx
import numpy as np
from references.stops.line import Bound, Line, Place, Wave


def random_line(rng: np.random.Generator) -> Line:
    """One to four bodies, perhaps one more that a source moves, and up to six stops; some touch at first."""
    n, k = int(rng.integers(1, 5)), int(rng.random() < 0.2)
    unit = rng.random() < 0.25
    masses = tuple(1.0 if unit else _number(rng, 0.3, 3) for _ in range(n))
    positions = tuple(np.round(np.cumsum(rng.uniform(0.3, 1.2, size=n + k)), 3).tolist())
    places: list[Place] = [(a, None) for a in range(n)]
    places += [(a, b) for a in range(n) for b in range(a + 1, n + k)]
    stops = _stops(rng, places, positions)
    springs = {
        p: (_number(rng, 2, 40), _number(rng, -0.3, 0.3)) for p in places if rng.random() < 0.3
    }
    dampers = {p: _number(rng, 0.05, 1.5) for p in places if rng.random() < 0.2}
    _join(rng, n + k, [*springs, *(s.place for s in stops)], dampers)
    forces = tuple(_wave(rng, 4.0) for _ in range(n))
    return Line(
        masses, positions, tuple(round(float(rng.normal() * 1.5), 2) for _ in range(n)), stops,
        forces, tuple(replace(_wave(rng, 0.7), constant=0.0) for _ in range(k)), springs, dampers,
    )  # fmt: skip


def _stops(
    rng: np.random.Generator, places: Sequence[Place], positions: Sequence[float]
) -> tuple[Bound, ...]:
    """Up to six bounds, neighbours first; one bounce for all of them or each its own."""
    neighbours = [p for p in places if p[1] == p[0] + 1] + [(0, None)]
    chosen = [p for p in neighbours if rng.random() < 0.8]
    chosen += [places[i] for i in rng.permutation(len(places))[: int(rng.integers(1, 3))]]
    common = _bounce(rng) if rng.random() < 0.4 else None
    made: list[Bound] = []
    for k, place in enumerate(dict.fromkeys(chosen)):
        a, b = place
        here = positions[a] - (0.0 if b is None else positions[b])
        bounce = _bounce(rng) if common is None else common
        touching = rng.random() < 0.15
        low = round(here - (0.0 if touching else _number(rng, 0.02, 0.8)), 6)
        high = round(here + _number(rng, 0.02, 0.8), 6)
        shape = rng.random()
        if shape < 0.5:
            # What touches begins exactly so.
            made.append(Bound(f"s{k}", place, here if touching else low, 1, bounce))
        elif shape < 0.75:
            made.append(Bound(f"s{k}", place, here if touching else high, -1, bounce))
        elif len(made) < 5:
            made.append(Bound(f"s{k}.low", place, here if touching else low, 1, bounce))
            made.append(Bound(f"s{k}.high", place, high, -1, bounce))
        if len(made) >= 6:
            break
    return tuple(made)


def _join(
    rng: np.random.Generator, bodies: int, joints: Sequence[Place], dampers: dict[Place, float]
) -> None:
    """Damp what nothing joins to the first body, so that all is one graph."""
    for b in range(1, bodies):
        tied: nx.Graph[int] = nx.Graph()
        tied.add_nodes_from(range(bodies))
        tied.add_edges_from((p, q) for p, q in (*joints, *dampers) if q is not None)
        if not nx.has_path(tied, 0, b):
            dampers[0, b] = _number(rng, 0.05, 0.5)


def _bounce(rng: np.random.Generator) -> float:
    drawn = rng.random()
    return 0.0 if drawn < 0.35 else 1.0 if drawn < 0.5 else _number(rng, 0.2, 0.95)


def _wave(rng: np.random.Generator, size: float) -> Wave:
    """Nothing, a constant, or a sine about one."""
    drawn = rng.random()
    if drawn < 0.2:
        return Wave()
    constant = round(float(rng.normal() * size), 2)
    if drawn < 0.6:
        return Wave(constant)
    return Wave(constant, _number(rng, 0.3, size), _number(rng, 1, 10), _number(rng, 0, 6))


def _number(rng: np.random.Generator, least: float, most: float) -> float:
    return round(float(rng.uniform(least, most)), 3)
