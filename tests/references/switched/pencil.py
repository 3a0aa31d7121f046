"""Kirchhoff's laws in one mode: ``E y' = A y``, square and regular, and what the laws leave free.

y: node voltages, currents of the branches that are not resistances, voltages of capacitors, three numbers for
each source (its level, its sine, the cosine), and 1. E has ones for capacitors, coils and sources.

The pencil of positive C, L, R is regular unless branches that have no voltage of their own (V, what conducts,
what sticks) close a loop, or branches whose current is given (I, what blocks, what slips) cut nodes off. In a
loop one current is free: the pencil has it at zero; cut off, one voltage is. Then a law is left over, which
the mode has to keep: voltages of sources round the loop, or currents into the nodes, that add up to zero.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise

import networkx as nx
import numpy as np
from numpy.typing import NDArray

from references.switched.network import PORTS, SOURCES, Branch, Network

Array = NDArray[np.float64]
State = Mapping[str, int]
"""What each port does: D, K, G 1 on, 0 off; F 0 sticks, 1 or -1 the sign of its voltage."""


@dataclass(frozen=True)
class Pencil:
    """``E y' = A y``; ``free``, columns that may be added to y; ``left_over``, rows that y makes zero."""

    E: Array
    A: Array
    free: Array
    left_over: Array
    unruled: frozenset[str]
    """The ports in loops and cuts."""


class Layout:
    """What stands where in y."""

    def __init__(self, network: Network) -> None:
        self.network = network
        n = network.nodes
        flows = [b.name for b in network.of("C", "L", "V", *PORTS)]
        self.current = {name: n + k for k, name in enumerate(flows)}
        n += len(flows)
        self.charge = {b.name: n + k for k, b in enumerate(network.of("C"))}
        n += len(self.charge)
        #: What is before follows; the sources, from here on, drive.
        self.driven = n
        self.source = {b.name: n + 3 * k for k, b in enumerate(network.of(*SOURCES))}
        self.one = n + 3 * len(self.source)
        self.size = self.one + 1

    def voltage(self, b: Branch) -> Array:
        """The row of a branch's voltage, tail above head."""
        row = np.zeros(self.size)
        for node, way in ((b.tail, 1.0), (b.head, -1.0)):
            if node:
                row[node - 1] += way
        return row

    def wave(self, b: Branch) -> Array:
        """The row of a source's value."""
        row, at = np.zeros(self.size), self.source[b.name]
        row[[at, at + 1]] = 1.0
        return row

    def flow(self, b: Branch) -> Array:
        """The row of a branch's current."""
        row = np.zeros(self.size)
        if b.kind == "R":
            return self.voltage(b) / b.value
        if b.kind == "S":
            return (self.voltage(b) + self.wave(b)) / b.more
        if b.kind == "I":
            return self.wave(b)
        row[self.current[b.name]] = 1.0
        return row

    def stored(self, name: str) -> Array:
        """The row of a capacitor's voltage or a coil's current."""
        row = np.zeros(self.size)
        row[(self.charge if name in self.charge else self.current)[name]] = 1.0
        return row

    def start(self) -> Array:
        """Charges and currents before the run, and 1."""
        y = np.zeros(self.size)
        y[self.one] = 1.0
        for b in self.network.of("C", "L"):
            y[(self.charge if b.kind == "C" else self.current)[b.name]] = b.start
        return y

    def drive(self, y: Array, t: float) -> Array:
        """The same with every source as it is from an instant on."""
        y = y.copy()
        for b in self.network.of(*SOURCES):
            at, angle = self.source[b.name], 2 * np.pi * b.wave.frequency * t + b.wave.phase
            sine = b.wave.amplitude * np.array([np.sin(angle), np.cos(angle)])
            y[at], y[at + 1 : at + 3] = b.wave.level(t), sine
        return y


def pencil(layout: Layout, state: State) -> Pencil:
    """The pencil of one mode."""
    size = layout.size
    E, A = np.zeros((size, size)), np.zeros((size, size))
    for b in layout.network.branches:
        row = layout.flow(b)
        for node, way in ((b.tail, 1.0), (b.head, -1.0)):
            if node:
                A[node - 1] += way * row
        if b.name in layout.current:
            at = layout.current[b.name]
            E[at], A[at] = _law(layout, b, state)
        if b.kind == "C":
            at = layout.charge[b.name]
            E[at, at], A[at] = 1.0, layout.flow(b) / b.value
        if b.kind in SOURCES:
            at, omega = layout.source[b.name], 2 * np.pi * b.wave.frequency
            E[range(at, at + 3), range(at, at + 3)] = 1.0
            A[at + 1, at + 2], A[at + 2, at + 1] = omega, -omega
    E[layout.one, layout.one] = 1.0
    free, left_over, ports = [], [], set()
    for at, pin, column, names in (*_loops(layout, state), *_cuts(layout, state)):
        left_over.append(A[at].copy())
        A[at] = pin
        free.append(column)
        ports |= names
    rows = np.array(left_over).reshape(-1, size)
    return Pencil(E, A, np.array(free).reshape(-1, size).T, rows, frozenset(ports))


def _law(layout: Layout, b: Branch, state: State) -> tuple[Array, Array]:
    """What a branch with a current of its own obeys, as a row of E and one of A."""
    none, across, flow = np.zeros(layout.size), layout.voltage(b), layout.flow(b)
    if b.kind == "L":
        return flow, across / b.value
    if b.kind == "C":
        across[layout.charge[b.name]] = -1.0
        return none, across
    if b.kind == "V":
        return none, across + layout.wave(b)
    if b.kind == "F":
        flow[layout.one] = -state[b.name] * b.value
        return none, flow if state[b.name] else across
    return none, across - b.more * flow if state[b.name] else flow


def _rigid(b: Branch, state: State) -> bool:
    """Whether a branch's voltage is given and its current is not."""
    if b.kind == "F":
        return state[b.name] == 0
    return b.kind == "V" or (b.kind in "DKG" and state[b.name] == 1 and not b.more)


def _given(b: Branch, state: State) -> bool:
    """Whether a branch's current is given and its voltage is not."""
    if b.kind == "F":
        return state[b.name] != 0
    return b.kind == "I" or (b.kind in "DKG" and state[b.name] == 0)


Free = tuple[int, Array, Array, set[str]]
"""A row to replace, by what; the direction that is free; the ports concerned."""


def _loops(layout: Layout, state: State) -> Iterator[Free]:
    forest: nx.Graph[int] = nx.Graph()
    forest.add_nodes_from(range(layout.network.nodes + 1))
    for b in layout.network.of("V", *PORTS):
        if not _rigid(b, state):
            continue
        if not nx.has_path(forest, b.tail, b.head):
            forest.add_edge(b.tail, b.head, branch=b)
            continue
        column, names = layout.flow(b), {b.name}
        path = nx.shortest_path(forest, b.head, b.tail)
        for here, there in pairwise(path):
            passed: Branch = forest.edges[here, there]["branch"]
            column += layout.flow(passed) * (1.0 if passed.tail == here else -1.0)
            names.add(passed.name)
        yield layout.current[b.name], layout.flow(b), column, names


def _cuts(layout: Layout, state: State) -> Iterator[Free]:
    whole: nx.Graph[int] = nx.Graph()
    whole.add_nodes_from(range(layout.network.nodes + 1))
    given = [b for b in layout.network.branches if _given(b, state)]
    rest = [b for b in layout.network.branches if not _given(b, state)]
    whole.add_edges_from((b.tail, b.head) for b in rest)
    for nodes in nx.connected_components(whole):
        if 0 in nodes:
            continue
        column = np.zeros(layout.size)
        column[[node - 1 for node in nodes]] = 1.0
        names = {b.name for b in given if (b.tail in nodes) != (b.head in nodes)}
        pin = np.zeros(layout.size)
        pin[min(nodes) - 1] = 1.0
        yield min(nodes) - 1, pin, column, names
