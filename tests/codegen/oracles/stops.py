"""Models with stops, and closed forms of what they do."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import sqrt

import networkx as nx
import numpy as np
from references.build import bond_graph

import bondgraph as bg
from codegen import Constant, Result, Signal, Step, simulator

G = 9.81
"""[m/s^2], of all that falls here."""


@dataclass(frozen=True)
class Stopped:
    """A model with stops and a run of it."""

    graph: "nx.DiGraph"
    numbers: Mapping[str, float]
    initial: Mapping[str, float]
    times: np.ndarray
    inputs: Mapping[str, Signal] = field(default_factory=dict)

    @property
    def equations(self) -> bg.StateEquations:
        return bg.derive(self.graph)

    def run(self, backend: str, method: str = "auto") -> Result:
        ready = simulator(self.equations, self.numbers, backend=backend)
        done = ready.run(self.times, self.initial, self.inputs, method)
        assert done.backend == backend
        return done


def ball(restitution: object, **bounds: object) -> "nx.DiGraph":
    """A mass that falls on a stop."""
    nodes = [
        bg.Se("weight", "-g*m"), bg.One("ball"), bg.I("m", "m", flow="v"),
        bg.Stop("floor", restitution=restitution, **bounds),
    ]  # fmt: skip
    return bond_graph(nodes, "weight>ball>m ball>floor")


def dropped(restitution: float, height: float = 1.0, end: float = 6.0) -> Stopped:
    """The ball from rest at a height."""
    numbers = {"m": 2.0, "g": G, "e": restitution}
    return Stopped(ball("e"), numbers, {"q_floor": height}, np.linspace(0.0, end, 61))


def bounces(restitution: float, height: float, count: int) -> np.ndarray:
    """When it bounces: sqrt(2 h/g), and 2 e^k v/g after one another."""
    v = sqrt(2 * G * height)
    flights = 2 * v * restitution ** np.arange(1, count) / G
    return v / G + np.concatenate([[0.0], np.cumsum(flights)])


def flight(restitution: float, height: float, times: np.ndarray) -> np.ndarray:
    """How high the ball is at these times, as long as it has bounced fewer than a hundred times."""
    hits, v = bounces(restitution, height, 100), sqrt(2 * G * height)
    found = height - G * times**2 / 2
    for k in range(99):
        now = (times >= hits[k]) & (times < hits[k + 1])
        since = times[now] - hits[k]
        found[now] = v * restitution ** (k + 1) * since - G * since**2 / 2
    return found


def cradle(balls: int, restitution: object = 1) -> "nx.DiGraph":
    """Equal balls in a row; ``q_s<i>`` is the gap behind ball i."""
    nodes, bonds = [], []
    for i in range(balls):
        nodes += [bg.One(f"b{i}"), bg.I(f"m{i}", "m", flow=f"v{i}")]
        bonds.append(f"b{i}>m{i}")
    for i in range(balls - 1):
        nodes += [bg.Zero(f"z{i}"), bg.Stop(f"s{i}", restitution=restitution)]
        bonds.append(f"b{i + 1}>z{i}>b{i} z{i}>s{i}")
    return bond_graph(nodes, " ".join(bonds))


def struck(balls: int, moving: int, restitution: object = 1) -> Stopped:
    """The first so many balls, together, meet the others, which touch, at 1/2 s."""
    gaps = {f"q_s{i}": 0.5 * (i == moving - 1) for i in range(balls - 1)}
    speeds = {f"v{i}": float(i < moving) for i in range(balls)}
    times = np.linspace(0.0, 1.0, 10)
    return Stopped(cradle(balls, restitution), {"m": 1.0}, gaps | speeds, times)


def turned_body() -> Stopped:
    """A body of mass 1 whose ends, v + a w and v - a w, meet two stops at once, one of them much faster."""
    nodes = [
        bg.One("v"), bg.I("m", 1, flow="v_m"), bg.One("w"), bg.I("J", "J", flow="w_J"),
        bg.Zero("z1"), bg.Zero("z2"), bg.TF("t1", "a"), bg.TF("t2", "-a"),
        bg.Stop("s1", restitution="1/2"), bg.Stop("s2", restitution="1/2"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "v>m w>J v>z1>s1 w>t1>z1 v>z2>s2 w>t2>z2")
    initial = {"v_m": -1.0, "w_J": -8.0, "q_s1": 0.18, "q_s2": 0.02}
    return Stopped(graph, {"a": 0.1, "J": 0.05}, initial, np.array([0.0, 0.05, 0.2]))


def rotor() -> Stopped:
    """A rotor driven through a clutch with dry friction onto a stop and back from it."""
    nodes = [
        bg.Se("drive", "T"), bg.One("engine"), bg.I("J_e", "1/2", flow="w_e"), bg.Zero("z"),
        bg.One("slip"), bg.R("clutch", law=bg.DryFriction("L")), bg.One("rotor"),
        bg.I("J_r", "1/5", flow="w_r"), bg.Stop("end", low=None, high=1, restitution="e"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "drive>engine>J_e engine>z>slip>clutch z>rotor>J_r rotor>end")
    torque = Constant(1.0) + Step(2.0, -3.0)
    return Stopped(graph, {"L": 2.0, "e": 0.6}, {}, np.linspace(0.0, 3.0, 32), {"T": torque})


def solenoid() -> Stopped:
    """An armature between two stops, pulled by a coil that a switch and a diode feed."""
    nodes = [
        bg.Se("src", "E"), bg.One("s"), bg.Sw("q", on="sin(w*t) - 0.2"), bg.Zero("n"),
        bg.Sw("d", on="-e_d", off="f_d"), bg.One("l"), bg.I("L", "L", flow="i"), bg.R("R", "R"),
        bg.GY("k", "K"), bg.One("arm"), bg.I("m", "m", flow="v"), bg.R("b", "b"),
        bg.Se("pull", "-F"), bg.Stop("gap", low=0, high="1/500", restitution="3/10"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "src>s>q s>n>d n>l>L l>R l>k>arm>m arm>b pull>arm>gap")
    numbers = {"L": 5e-3, "R": 4.0, "K": 2.0, "m": 0.02, "b": 0.05, "w": 9000.0}
    inputs = {"E": Constant(24.0), "F": Constant(2.0) + Step(0.02, 20.0)}
    # The last sample is while the armature flies.
    return Stopped(graph, numbers, {}, np.linspace(0.0, 0.0215, 44), inputs)
