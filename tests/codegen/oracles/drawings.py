"""Networks that switch as bond graphs: electrical or mechanical, with switches or controlled junctions."""

from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from functools import reduce

import networkx as nx
import numpy as np
from references.switched.network import SOURCES, Branch, Network, Wave

import bondgraph as bg
from codegen import Constant, Signal, Sine, Step

Node = bg.nodes.elements.Node


@dataclass(frozen=True)
class Drawing:
    """A network as a bond graph.

    Electrically a node is a 0-junction, a branch a 1-junction; mechanically, where voltages are speeds,
    a node is a 1-junction, a branch a 0-junction, C is an I and L a C, and a switch that is closed holds
    its port instead of letting it go. ``of_time``: sines without steps and commands are expressions of time,
    not inputs. ``joints``: switches drawn as controlled junctions: that of their branch, or, where one leads
    to the ground, that of its node, which is off while the switch is on.
    """

    network: Network
    mechanical: bool = False
    of_time: bool = False
    joints: frozenset[str] = frozenset()

    def graph(self) -> "nx.DiGraph[Hashable]":
        """A junction a node, one of the other kind a branch."""
        graph: nx.DiGraph[Hashable] = nx.DiGraph()
        node, way = (bg.One, bg.Zero) if self.mechanical else (bg.Zero, bg.One)
        shorted = self._shorted()
        for k in range(1, self.network.nodes + 1):
            conditions = self._conditions(shorted[k], closed=False) if k in shorted else {}
            graph.add_nodes_from([node(f"n{k}", **conditions)])
        for b in self.network.branches:
            if b in shorted.values():
                continue
            if b.name in self.joints:
                graph.add_nodes_from([way(f"{b.name}_way", **self._conditions(b))])
                self._joined(graph, b)
                continue
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
            self._joined(graph, b)
        return graph

    def _joined(self, graph: "nx.DiGraph[Hashable]", b: Branch) -> None:
        if b.tail:
            graph.add_edge(f"n{b.tail}", f"{b.name}_way")
        if b.head:
            graph.add_edge(f"{b.name}_way", f"n{b.head}")

    def _shorted(self) -> dict[int, Branch]:
        """Nodes whose junction is controlled, and the switch to the ground that each stands for."""
        grounded = [
            b for b in self.network.branches if b.name in self.joints and 0 in (b.tail, b.head)
        ]
        return {b.tail + b.head: b for b in reversed(grounded)}

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
        if b.kind in ("D", "K", "G"):
            return self._switch(b)
        flow = {"flow": f"u_{b.name}"} if b.kind == "C" else {"flow": f"i_{b.name}"}
        if (b.kind == "C") == self.mechanical:
            return bg.I(b.name, b.value, **flow)
        return bg.C(b.name, b.value, effort=flow["flow"])

    def _switch(self, b: Branch) -> Node:
        """Mechanically a closed one has no flow: it is off."""
        if b.kind != "D":
            return bg.Sw(b.name, **self._conditions(b, closed=not self.mechanical))
        on, off = f"e_{b.name}", f"-f_{b.name}"
        return (
            bg.Sw(b.name, on=f"-{on}", off=off[1:]) if self.mechanical else bg.Sw(b.name, on, off)
        )

    def _conditions(self, b: Branch, closed: bool = True) -> dict[str, str]:
        """When a switch closes and opens, or, of what is on while it is open, the other way round."""
        if b.kind == "G":
            stored = f"{'i' if self._watched(b).kind == 'L' else 'u'}_{b.watched}"
            both = f"{b.sense}*{stored} - {b.value!r}", f"{b.off!r} - {b.sense}*{stored}"
            return dict(zip(("on", "off"), both if closed else both[::-1], strict=True))
        if not self.of_time:
            return {"on": f"g_{b.name} - 1/2" if closed else f"1/2 - g_{b.name}"}
        way = (-1) ** len(b.instants) * (1 if b.on else -1) * (1 if closed else -1)
        return {"on": reduce(lambda text, at: f"{text}*(t - {at!r})", b.instants, str(way))}

    def _watched(self, b: Branch) -> Branch:
        return next(one for one in self.network.branches if one.name == b.watched)

    def _known(self, b: Branch) -> bool:
        return self.of_time and not b.wave.steps

    def inputs(self) -> dict[str, Signal]:
        """What drives the sources and commands the switches."""
        found = {
            f"u_{b.name}": _signal(b.wave) for b in self.network.of(*SOURCES) if not self._known(b)
        }
        for b in [] if self.of_time else self.network.of("K"):
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
        named = {b: self._told(b) for b in self.network.of("D", "K", "G")}
        return [name for b, (name, turned) in named.items() if b.commanded(0.0) != turned]

    def events(self, found: Sequence[tuple[float, str, str]]) -> list[tuple[float, str, str]]:
        """What the judge finds, in the toolkit's words."""
        words, ports = {"on": "off", "off": "on"}, {}
        for b in self.network.of("D", "K", "G"):
            ports[b.name] = self._told(b)
        named = [(t, *ports.get(port, (port, False)), kind) for t, port, kind in found]
        return [(t, port, words[kind] if turned else kind) for t, port, turned, kind in named]

    def _told(self, b: Branch) -> tuple[str, bool]:
        """What a switch is called, and whether it is on while the branch is open."""
        if b.name not in self.joints:
            return b.name, self.mechanical
        shorted = {one.name: f"n{k}" for k, one in self._shorted().items()}
        return (shorted[b.name], True) if b.name in shorted else (f"{b.name}_way", False)


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
