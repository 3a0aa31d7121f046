"""Networks that switch as bond graphs, and how a run of one differs from what the judge finds."""

from collections.abc import Hashable, Sequence
from dataclasses import dataclass

import networkx as nx
import numpy as np
from references.switched.network import SOURCES, Branch, Network, Wave
from references.switched.oracle import Oracle

import bondgraph as bg
from codegen import Constant, Result, Signal, Sine, Step, simulator, switched_simulator

MOMENT, APART = 3e-6, 3e-7
"""Of the run: from complete rest a diode turns on only after a moment; events may be apart by so much."""

Node = bg.declare.elements.Node


@dataclass(frozen=True)
class Drawing:
    """A network as a bond graph.

    Electrically a node is a 0-junction, a branch a 1-junction; mechanically, where voltages are speeds,
    a node is a 1-junction, a branch a 0-junction, C is an I and L a C, and a switch that is closed holds
    its port instead of letting it go. ``of_time``: sines without steps are expressions of time, not inputs.
    """

    network: Network
    mechanical: bool = False
    of_time: bool = False

    def graph(self) -> "nx.DiGraph[Hashable]":
        """A junction a node, one of the other kind a branch."""
        graph: nx.DiGraph[Hashable] = nx.DiGraph()
        node, way = (bg.One, bg.Zero) if self.mechanical else (bg.Zero, bg.One)
        graph.add_nodes_from(node(f"n{k}") for k in range(1, self.network.nodes + 1))
        for b in self.network.branches:
            graph.add_nodes_from([way(f"{b.name}_way"), self._element(b)])
            # A diode's bond points into it, a source's out of it: from ground by way of it to its head.
            ends = (b.name, f"{b.name}_way")
            if b.kind == "F" and not self.mechanical:
                # Its effort is a current here.
                graph.add_nodes_from([bg.GY(f"{b.name}_turned", 1)])
                nx.add_path(graph, (f"{b.name}_way", f"{b.name}_turned", b.name))
            else:
                graph.add_edge(*(ends if b.kind in SOURCES else ends[::-1]))
            if b.more:
                graph.add_nodes_from([self._resistance(f"{b.name}_r", b.more)])
                graph.add_edge(f"{b.name}_way", f"{b.name}_r")
            if b.tail:
                graph.add_edge(f"n{b.tail}", f"{b.name}_way")
            if b.head:
                graph.add_edge(f"{b.name}_way", f"n{b.head}")
        return graph

    def _resistance(self, name: str, value: float) -> Node:
        return bg.R(name, f"1/{value!r}" if self.mechanical else value)

    def _element(self, b: Branch) -> Node:
        if b.kind in SOURCES:
            effort = (b.kind == "I") == self.mechanical
            value = _expression(b.wave) if self._known(b) else f"u_{b.name}"
            return (bg.Se if effort else bg.Sf)(b.name, value)
        if b.kind == "R":
            return self._resistance(b.name, b.value)
        if b.kind == "F":
            return bg.R(b.name, law=bg.DryFriction(b.value))
        if b.kind in ("D", "K"):
            return self._switch(b)
        flow = {"flow": f"u_{b.name}"} if b.kind == "C" else {"flow": f"i_{b.name}"}
        if (b.kind == "C") == self.mechanical:
            return bg.I(b.name, b.value, **flow)
        return bg.C(b.name, b.value, effort=flow["flow"])

    def _switch(self, b: Branch) -> Node:
        """Mechanically a closed one has no flow: it is off."""
        if b.kind == "K":
            return bg.Sw(b.name, on=f"1/2 - g_{b.name}" if self.mechanical else f"g_{b.name} - 1/2")
        on, off = f"e_{b.name}", f"-f_{b.name}"
        return (
            bg.Sw(b.name, on=f"-{on}", off=off[1:]) if self.mechanical else bg.Sw(b.name, on, off)
        )

    def _known(self, b: Branch) -> bool:
        return self.of_time and not b.wave.steps

    def inputs(self) -> dict[str, Signal]:
        """What drives the sources and commands the switches."""
        found = {
            f"u_{b.name}": _signal(b.wave) for b in self.network.of(*SOURCES) if not self._known(b)
        }
        for b in self.network.of("K"):
            size = -1.0 if b.on else 1.0
            steps = tuple((at, size * (-1.0) ** k) for k, at in enumerate(b.instants))
            found[f"g_{b.name}"] = _signal(Wave(float(b.on), steps))
        return found

    def initial(self) -> dict[str, float]:
        """Every charge and current: what is not named would be as the others need it to be."""
        storages = self.network.of("C", "L")
        return {f"{'u' if b.kind == 'C' else 'i'}_{b.name}": b.start for b in storages}

    def initially_on(self) -> list[Hashable]:
        """Switches that are on at first, in the toolkit's sense."""
        return [b.name for b in self.network.of("D", "K") if b.commanded(0.0) != self.mechanical]

    def events(self, found: Sequence[tuple[float, str, str]]) -> list[tuple[float, str, str]]:
        """What the judge finds, in the toolkit's words."""
        words = {"on": "off", "off": "on"} if self.mechanical else {}
        return [(t, port, words.get(kind, kind)) for t, port, kind in found]


def _signal(wave: Wave) -> Signal:
    signal: Signal = Constant(wave.constant)
    for at, by in wave.steps:
        signal = signal + Step(at, by)
    if wave.amplitude:
        signal = signal + Sine(wave.amplitude, wave.frequency, phase=wave.phase)
    return signal


def _expression(wave: Wave) -> str:
    turns = f"{2 * np.pi * wave.frequency!r}"
    return f"{wave.constant!r} + {wave.amplitude!r}*sin({turns}*t + {wave.phase!r})"


def as_graph(network: Network, mechanical: bool = False) -> "nx.DiGraph[Hashable]":
    """A network as a bond graph."""
    return Drawing(network, mechanical).graph()


Found = tuple[dict[str, np.ndarray], Sequence[tuple[float, str, str]]]
"""Voltages of capacitors and currents of coils by name, and events in the toolkit's words."""


def complaints(found: Found, result: Result, span: float = 3.0) -> list[str]:
    """What in a run is not as the judge finds it: events, voltages of capacitors, currents of coils."""
    expected, right = found[0], [event for event in found[1] if event[0] > MOMENT * span]
    events = sorted((e.time, str(e.port), e.kind) for e in result.events if e.time > MOMENT * span)
    wrong = []
    told = sorted(event[1:] for event in events)
    if told != sorted(tuple(event[1:]) for event in right):
        wrong.append(f"events {events} for {right}")
    elif far := _apart(events, right, APART * span):
        wrong.append(f"events at {far}")
    size = max((np.abs(column).max() for column in expected.values()), default=0.0)
    for name, values in expected.items():
        if (off := np.abs(result[name] - values).max()) > 1e-6 * size:
            wrong.append(f"{name}: off by {off:.3g}")
    return wrong


def _apart(
    events: Sequence[tuple[float, str, str]], right: Sequence[tuple[float, str, str]], most: float
) -> list[float]:
    """When a port does at another time what it ought to do, port by port."""
    pairs = zip(
        *(sorted(all_, key=lambda e: (e[1], e[0])) for all_ in (events, right)), strict=True
    )
    return [t for (t, p, kind), (s, q, k) in pairs if abs(t - s) > most or (p, kind) != (q, k)]


def judged(network: Network, times: np.ndarray, mechanical: bool = False) -> Found:
    """What the judge finds in a network that leaves no port's mode open."""
    course = Oracle(network).run(times)
    assert not course.loose, f"nothing determines what {sorted(course.loose)} do"
    names = [f"{'u' if b.kind == 'C' else 'i'}_{b.name}" for b in network.of("C", "L")]
    columns = {name: course.columns[name] for name in names}
    return columns, Drawing(network, mechanical).events(course.events)


def switched(network: Network, times: np.ndarray, mechanical: bool = False) -> Result:
    """A run of it by the toolkit."""
    drawing = Drawing(network, mechanical)
    graph, start, inputs = drawing.graph(), drawing.initial(), drawing.inputs()
    if not network.of("D", "K"):
        still = simulator(bg.derive(graph), {})
        known = {name: value for name, value in start.items() if name in still.states}
        return still.run(times, known, inputs)
    on = drawing.initially_on()
    return switched_simulator(graph, {}).run(times, start, inputs, initially_on=on)
