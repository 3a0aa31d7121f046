"""Random linear models whose rates lie twelve decades apart, and their motion in 60 digits and more.

Newton's and Kirchhoff's laws are written down by hand, as a matrix of exact fractions over the states and the
components of the input; mpmath takes its exponential. Nothing here comes from the toolkit but the graph.

Assumed: an input is ``value``, ``value + slope t``, ``value sin(omega t)`` or ``value (1 - exp(-t/T))``, with
omega and 1/T as doubles; parameters are the shortest decimals of their doubles.
"""

from dataclasses import dataclass
from fractions import Fraction

import mpmath
import networkx as nx
import numpy as np

import bondgraph as bg
from codegen import Constant, Lag, Ramp, Sine, Step
from codegen.inputs.signal import Signal

FAMILIES = ("chain", "ladder", "stiff damper", "undamped")


@dataclass(frozen=True)
class Linear:
    """A model ``z' = M z`` with the states first in z, and how to run it."""

    family: str
    graph: "nx.DiGraph[str]"
    parameters: dict[str, float]
    states: tuple[str, ...]
    start: dict[str, float]
    signal: Signal
    M: tuple[tuple[Fraction, ...], ...]
    z: tuple[Fraction, ...]
    span: float

    @property
    def turning(self) -> float:
        """The largest imaginary part of a rate [1/s], nearly."""
        M = np.array([[float(entry) for entry in row] for row in self.M])
        scale = np.ones(len(M))
        for _ in range(200):
            for i in range(len(M)):
                row = sum(abs(M[i, j]) for j in range(len(M)) if j != i)
                column = sum(abs(M[j, i]) for j in range(len(M)) if j != i)
                if row and column:
                    factor = 2.0 ** round(np.log2(np.sqrt(row / column)))
                    M[i] /= factor
                    M[:, i] *= factor
                    scale[i] *= factor
        return float(np.abs(np.linalg.eigvals(M).imag).max())

    def at(self, t: float) -> list[float]:
        """The states at a time, from a sum of the exponential's series in long numbers."""
        size = len(self.M)
        largest = float(max(abs(entry) for row in self.M for entry in row)) * max(t, 1e-300)
        with mpmath.workdps(70 + 2 * int(np.log10(1 + largest))):
            M = mpmath.matrix(size, size)
            for i, row in enumerate(self.M):
                for j, entry in enumerate(row):
                    M[i, j] = mpmath.mpf(entry.numerator) / entry.denominator
            doublings = max(0, int(np.log2(1 + largest * size)) + 4)
            M *= mpmath.mpf(t) / mpmath.mpf(2) ** doublings
            total = term = mpmath.eye(size)
            k = 0
            while k < 3 or mpmath.mnorm(term, mpmath.inf) > mpmath.eps:
                k += 1
                term = term * M / k
                total = total + term
            for _ in range(doublings):
                total = total * total
            z = mpmath.matrix([mpmath.mpf(c.numerator) / c.denominator for c in self.z])
            end = total * z
            return [float(end[i]) for i in range(len(self.states))]


def random_linear(seed: int) -> Linear:
    """One of each family in turn; rates and span each anywhere in twelve decades about 1 /s and 1 s."""
    rng = np.random.default_rng([seed, 1412])
    family = FAMILIES[seed % len(FAMILIES)]
    build = {"chain": _chain, "ladder": _ladder, "stiff damper": _stiff, "undamped": _undamped}[
        family
    ]
    graph, parameters, states, rows, driven, gain = build(rng)
    span = _decades(rng, -6, 6)
    start = {name: float(f"{rng.normal():.4g}") for name in states}
    signal, own, outputs, begin = _input(rng, span)
    size = len(states)
    M = [[*row, *([Fraction(0)] * len(own))] for row in rows]
    for k, weight in enumerate(outputs):
        M[driven][size + k] += gain * weight
    M += [[*([Fraction(0)] * size), *row] for row in own]
    z = [*(Fraction(repr(start[name])) for name in states), *begin]
    return Linear(
        family, graph, parameters, tuple(states), start, signal,
        tuple(map(tuple, M)), tuple(z), span,
    )  # fmt: skip


def _decades(rng: np.random.Generator, low: float, high: float) -> float:
    return float(f"{10 ** rng.uniform(low, high):.4g}")


def _input(
    rng: np.random.Generator, span: float
) -> tuple[Signal, list[list[Fraction]], list[Fraction], list[Fraction]]:
    """A signal; its generator, what it gives of the generator's components, and where these begin."""
    value, kind = float(f"{rng.normal():.4g}"), int(rng.integers(4))
    one, no, a = Fraction(1), Fraction(0), Fraction(repr(value))
    if kind == 0:
        return Constant(value), [[no]], [a], [one]
    if kind == 1:
        slope = float(f"{rng.normal() / span:.4g}")
        return Ramp(0.0, slope, value), [[no, no], [one, no]], [a, Fraction(slope)], [one, no]
    if kind == 2:
        frequency = _decades(rng, -6, 6)
        omega = Fraction(2 * np.pi * frequency)
        return Sine(value, frequency), [[no, omega], [-omega, no]], [a, no], [no, one]
    time = _decades(rng, -6, 6)
    rate = Fraction(1 / time)
    return Lag(Step(0.0, value), time), [[no, no], [no, -rate]], [a, -a], [one, one]


Built = tuple["nx.DiGraph[str]", dict[str, float], list[str], list[list[Fraction]], int, Fraction]


def _masses(values: list[float], joints: list[tuple[int, int, float, float]]) -> Built:
    """Masses, and joints (from, to or -1 for the ground, stiffness, damping); the force acts on the first."""
    graph: nx.DiGraph[str] = nx.DiGraph()
    parameters: dict[str, float] = {}
    states = [f"v{i}" for i in range(len(values))]
    for i, mass in enumerate(values):
        graph.add_nodes_from([bg.One(f"j{i}"), bg.I(f"m{i}", f"m{i}", flow=f"v{i}")])
        graph.add_edge(f"j{i}", f"m{i}")
        parameters[f"m{i}"] = mass
    graph.add_nodes_from([bg.Se("push", "F")])
    graph.add_edge("push", "j0")
    springs = [f"f{k}" for k, joint in enumerate(joints) if joint[2]]
    states += springs
    size = len(states)
    rows = [[Fraction(0)] * size for _ in range(size)]
    for k, (tail, head, stiffness, damping) in enumerate(joints):
        if head < 0:
            at = f"j{tail}"
        else:
            at = f"way{k}"
            graph.add_nodes_from([bg.Zero(f"gap{k}"), bg.One(at)])
            graph.add_edges_from(
                [(f"j{tail}", f"gap{k}"), (f"gap{k}", f"j{head}"), (f"gap{k}", at)]
            )
        ends = [(tail, 1)] + ([(head, -1)] if head >= 0 else [])
        if stiffness:
            graph.add_nodes_from([bg.C(f"s{k}", f"1/k{k}", effort=f"f{k}")])
            graph.add_edge(at, f"s{k}")
            parameters[f"k{k}"] = stiffness
            spring = states.index(f"f{k}")
            for i, sign in ends:
                rows[spring][i] += sign * Fraction(repr(stiffness))
                rows[i][spring] -= sign / Fraction(repr(values[i]))
        if damping:
            graph.add_nodes_from([bg.R(f"d{k}", f"b{k}")])
            graph.add_edge(at, f"d{k}")
            parameters[f"b{k}"] = damping
            for i, sign in ends:
                for j, other in ends:
                    rows[i][j] -= sign * other * Fraction(repr(damping)) / Fraction(repr(values[i]))
    return graph, parameters, states, rows, 0, 1 / Fraction(repr(values[0]))


def _mass(rng: np.random.Generator) -> float:
    return _decades(rng, -2, 2)


def _chain(rng: np.random.Generator) -> Built:
    """Masses in a row, each joint with a spring, a damper or both."""
    count = int(rng.integers(2, 5))
    values = [_mass(rng) for _ in range(count)]
    joints = []
    for i in range(count):
        kind, head = int(rng.integers(3)), i + 1 if i + 1 < count else -1
        stiffness = values[i] * _decades(rng, -6, 6) ** 2 if kind != 1 else 0.0
        damping = values[i] * _decades(rng, -6, 6) if kind != 0 else 0.0
        joints.append((i, head, float(f"{stiffness:.6g}"), float(f"{damping:.6g}")))
    return _masses(values, joints)


def _stiff(rng: np.random.Generator) -> Built:
    """Two masses that a stiff damper joins, with a slow drag on the second, and perhaps a soft spring."""
    values = [_mass(rng), _mass(rng)]
    joint = float(f"{values[0] * _decades(rng, 2, 6):.6g}")
    drag = float(f"{values[1] * _decades(rng, -6, -2):.6g}")
    spring = float(f"{values[1] * _decades(rng, -6, 0) ** 2:.6g}") if rng.integers(2) else 0.0
    return _masses(values, [(0, 1, 0.0, joint), (1, -1, spring, drag)])


def _undamped(rng: np.random.Generator) -> Built:
    """Masses and springs alone."""
    count = int(rng.integers(1, 4))
    values = [_mass(rng) for _ in range(count)]
    joints = [
        (i, i + 1 if i + 1 < count else -1, float(f"{values[i] * _decades(rng, -6, 6) ** 2:.6g}"), 0.0)
        for i in range(count)
    ]  # fmt: skip
    return _masses(values, joints)


def _ladder(rng: np.random.Generator) -> Built:
    """Capacitors to the ground, resistances between them, the first one from a source."""
    count = int(rng.integers(2, 7))
    graph: nx.DiGraph[str] = nx.DiGraph()
    parameters: dict[str, float] = {}
    rows = [[Fraction(0)] * count for _ in range(count)]
    graph.add_nodes_from([bg.Se("push", "F")])
    before, gain = "push", Fraction(0)
    for i in range(count):
        C = _decades(rng, -3, 3)
        R = float(f"{1 / (C * _decades(rng, -6, 6)):.6g}")
        parameters |= {f"C{i}": C, f"R{i}": R}
        graph.add_nodes_from([
            bg.One(f"w{i}"), bg.R(f"r{i}", f"R{i}"), bg.Zero(f"n{i}"), bg.C(f"c{i}", f"C{i}", effort=f"u{i}"),
        ])  # fmt: skip
        graph.add_edges_from([
            (before, f"w{i}"), (f"w{i}", f"r{i}"), (f"w{i}", f"n{i}"), (f"n{i}", f"c{i}"),
        ])  # fmt: skip
        before = f"n{i}"
        through = 1 / Fraction(repr(R))
        rows[i][i] -= through / Fraction(repr(C))
        if i:
            own, last = Fraction(repr(C)), Fraction(repr(parameters[f"C{i - 1}"]))
            rows[i][i - 1] += through / own
            rows[i - 1][i] += through / last
            rows[i - 1][i - 1] -= through / last
        else:
            gain = through / Fraction(repr(C))
    return graph, parameters, [f"u{i}" for i in range(count)], rows, 0, gain
