"""`Kind`: a model of one kind, a run of it, and what that run is by hand."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property

import networkx as nx
import numpy as np

import bondgraph as bg
from codegen import Signal
from differentials.commands.signals import law, signal

Array = np.ndarray
Known = Callable[[Array, Mapping[str, Array]], Mapping[str, Array]]
"""Signals in closed form, at times [s]; some by other signals of the same run."""


@dataclass(frozen=True, eq=False)
class Kind:
    """A graph and a run of it from 0 to ``end`` [s]; ``inputs`` as the command line takes them.

    ``later``: laws of open ports, put in after the graph is derived, as the command line takes them.
    ``known``: what the run is by hand. ``rest``: inputs and a start for a steady state; None where there
    is none at all. ``mode``: what ports do at ``at`` [s], in the words of events. ``ends``: nodes that
    have impulses, so that fixed steps and samples beside them are of either side. ``read``: the inputs
    that values read. ``loop``: whether nonlinear laws are left to be solved at once.
    """

    name: str
    graph: nx.DiGraph
    numbers: Mapping[str, float]
    inputs: Mapping[str, str]
    known: Known
    end: float
    initial: Mapping[str, float] = field(default_factory=dict)
    later: Mapping[str, str] = field(default_factory=dict)
    on: tuple[str, ...] = ()
    at: float = 0.0
    mode: Mapping[str, str] = field(default_factory=dict)
    rest: Mapping[str, Mapping[str, float]] | None = None
    read: tuple[str, ...] = ()
    loop: bool = False

    @cached_property
    def equations(self) -> bg.StateEquations:
        return bg.derive(self.graph, inputs=self.read)

    @property
    def signals(self) -> dict[str, Signal]:
        return {name: signal(text) for name, text in self.inputs.items()}

    @property
    def laws(self) -> dict[str, object]:
        return {name: law(text) for name, text in self.later.items()}

    @property
    def switches(self) -> list[str]:
        found = self.equations.switches
        return [str(one.name) for one in found if one.switch.transition is None]

    def times(self, samples: int = 51) -> Array:
        return np.linspace(0.0, self.end, samples)


def stepwise(times: Array, *parts: tuple[float, Callable[[Array], Array]]) -> Array:
    """A function in pieces: each counts from its time on, and is given the time since then."""
    found = np.zeros_like(times)
    for begin, part in parts:
        after = times >= begin
        found[after] = part(times[after] - begin)
    return found


def relaxed(times: Array, start: float, tau: float, edges: list[tuple[float, float]]) -> Array:
    """A first-order lag from a start: from each time on it goes to that edge's level."""
    parts, value = [], start
    for (begin, level), (end, _) in zip(edges, [*edges[1:], (np.inf, 0.0)], strict=True):
        parts.append((begin, lambda t, v=value, to=level: to + (v - to) * np.exp(-t / tau)))
        value = level + (value - level) * np.exp(-(end - begin) / tau)
    return stepwise(times, *parts)
