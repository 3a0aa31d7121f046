"""Random chains of masses with springs, dampers and friction, as graphs and as matrices."""

from dataclasses import dataclass, field

import networkx as nx
import numpy as np
from references.build import bond_graph

import bondgraph as bg
from codegen import Constant, Lag, Ramp, Signal, Sine, Step

Place = tuple[int, int | None]
"""Between mass i and mass j, or between mass i and the ground."""


def way(place: Place, count: int) -> np.ndarray:
    """The row that gives the relative velocity at a place: v_i - v_j, or v_i."""
    row = np.zeros(count)
    row[place[0]] = 1.0
    if place[1] is not None:
        row[place[1]] = -1.0
    return row


@dataclass
class Chain:
    """M v' = p - C v - S^T k S q - W^T f with |f| within levels, f at level sign(W v) where it slips."""

    masses: np.ndarray
    springs: dict[Place, float]
    dampers: dict[Place, float]
    friction: list[Place]
    levels: list[Signal]
    ratios: list[float]
    pushes: list[Signal]
    start: np.ndarray
    places: list[Place] = field(init=False)

    def __post_init__(self) -> None:
        n = len(self.masses)
        self.places = [(i, None) for i in range(n)] + [(i, i + 1) for i in range(n - 1)]

    @property
    def W(self) -> np.ndarray:
        """Slips from velocities, a row for each friction port."""
        return np.array([way(place, len(self.masses)) for place in self.friction])

    def quadratic(self, values: dict[Place, float]) -> np.ndarray:
        """The matrix of dampers or springs."""
        result = np.zeros((len(self.masses), len(self.masses)))
        for place, value in values.items():
            row = way(place, len(self.masses))
            result += value * np.outer(row, row)
        return result

    def level(self, t: float) -> np.ndarray:
        """Friction levels at one time."""
        return np.array([level(t) for level in self.levels])

    def push(self, t: float) -> np.ndarray:
        """Forces on the masses at one time."""
        return np.array([push(t) for push in self.pushes])

    def graph(self) -> nx.DiGraph:
        """The chain as a bond graph: a 1-junction for each mass and each relative velocity in use."""
        nodes, bonds = [], []
        for i, mass in enumerate(self.masses.tolist()):
            nodes += [bg.One(f"n{i}"), bg.I(f"m{i}", mass, flow=f"v{i}"), bg.Se(f"p{i}", f"P{i}")]
            bonds.append(f"p{i}>n{i}>m{i}")
        for at, (i, j) in enumerate(self.places):
            node = f"n{i}"
            if j is not None and (i, j) in {*self.springs, *self.dampers, *self.friction}:
                nodes += [bg.Zero(f"z{at}"), bg.One(f"r{at}")]
                bonds.append(f"n{i}>z{at}>n{j} z{at}>r{at}")
                node = f"r{at}"
            if (i, j) in self.springs:
                nodes.append(bg.C(f"c{at}", 1 / self.springs[i, j], effort=f"F{at}"))
                bonds.append(f"{node}>c{at}")
            if (i, j) in self.dampers:
                nodes.append(bg.R(f"b{at}", self.dampers[i, j]))
                bonds.append(f"{node}>b{at}")
        for at, place in enumerate(self.friction):
            law = bg.DryFriction(f"L{at}", 1, self.ratios[at])
            number = self.places.index(place)
            nodes.append(bg.R(f"rub{at}", law=law, effort=f"f{at}", flow=f"s{at}"))
            bonds.append(
                f"{'n' if place[1] is None else 'r'}{place[0] if place[1] is None else number}>rub{at}"
            )
        return bond_graph(nodes, " ".join(bonds))


def long_chain(masses: int) -> tuple[bg.StateEquations, dict[str, float]]:
    """Masses on the ground by dampers and in line by springs, the first pushed, the last rubbing."""
    nodes, bonds = (
        [bg.Se("p", "P"), bg.R("rub", law=bg.DryFriction("L"))],
        [f"p>j0 j{masses - 1}>rub"],
    )
    for k in range(masses):
        nodes += [bg.One(f"j{k}"), bg.I(f"m{k}", f"m_{k}", flow=f"v_{k}"), bg.R(f"r{k}", "b"),
                  bg.Zero(f"z{k}"), bg.C(f"c{k}", "1/k", effort=f"F_{k}")]  # fmt: skip
        bonds.append(f"j{k}>m{k} j{k}>r{k} j{k}>z{k}>c{k}")
        bonds += [f"z{k - 1}>j{k}"] if k else []
    numbers = {f"m_{k}": 1 + k / masses for k in range(masses)} | {"b": 0.1, "k": 100.0, "L": 1.0}
    return bg.derive(bond_graph(nodes, " ".join(bonds))), numbers


def random_chain(rng: np.random.Generator, breakaway: bool = False) -> Chain:
    """Two to four masses, one to three friction ports anywhere, pushes and levels of several shapes."""
    n = int(rng.integers(2, 5))
    places: list[Place] = [(i, None) for i in range(n)] + [(i, i + 1) for i in range(n - 1)]
    pairs = places[n:]
    springs = {p: float(rng.uniform(5, 60)) for p in places if rng.random() < 0.4 or p in pairs[:1]}
    dampers = {p: float(rng.uniform(0.05, 3)) for p in places if rng.random() < 0.3}
    friction = _friction(rng, places, n)
    joined = {*springs, *dampers, *friction}
    for pair in pairs:
        if pair not in joined:
            springs[pair] = float(rng.uniform(5, 60))
    return Chain(
        rng.uniform(0.3, 3, n), springs, dampers, friction,
        levels=[_level(rng) for _ in friction],
        ratios=[round(float(rng.uniform(1, 1.6)), 2) if breakaway else 1.0 for _ in friction],
        pushes=[_push(rng) for _ in range(n)], start=np.round(rng.normal(size=n), 2) * rng.integers(0, 2),
    )  # fmt: skip


def _friction(rng: np.random.Generator, places: list[Place], n: int) -> list[Place]:
    """One to three places, some of them twice; at most one way of holding more than needed."""
    while True:
        chosen = [places[i] for i in rng.choice(len(places), size=int(rng.integers(1, 4)))]
        if np.linalg.matrix_rank(np.array([way(place, n) for place in chosen])) >= len(chosen) - 1:
            return chosen


def _level(rng: np.random.Generator) -> Signal:
    L = float(rng.uniform(0.3, 3))
    shapes = [Constant(L), Constant(L), Constant(0.0), Step(float(rng.uniform(0.2, 1.5)), L / 3, L),
              Step(float(rng.uniform(0.2, 1.5)), L), Ramp(0.3, -L / 2, L, end=1.9),
              Lag(Step(0.4, L), 0.1)]  # fmt: skip
    return shapes[int(rng.integers(len(shapes)))]


def _push(rng: np.random.Generator) -> Signal:
    P = float(rng.normal() * 3)
    shapes = [Constant(0.0), Constant(P), Step(float(rng.uniform(0.1, 1.5)), P),
              Sine(P, float(rng.uniform(0.3, 2))), Lag(Step(0.5, P), 0.2), Ramp(0.2, P, end=1.2)]  # fmt: skip
    return shapes[int(rng.integers(len(shapes)))]
