"""How a run of a network that switches differs from what the judge finds."""

from collections.abc import Hashable, Sequence

import networkx as nx
import numpy as np
from references.switched.network import Network
from references.switched.oracle import Oracle

import bondgraph as bg
from codegen import Result, simulator, switched_simulator
from oracles.drawings import Drawing

MOMENT, APART = 3e-6, 3e-7
"""Of the run: from complete rest a diode turns on only after a moment; events may be apart by so much."""


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
        if (off := np.abs(result[name] - values).max()) > 1e-6 * size + 1e-12:
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
    return judged_as(Drawing(network, mechanical), times)


def judged_as(drawing: Drawing, times: np.ndarray) -> Found:
    """The same, in the words of a drawing."""
    network = drawing.network
    course = Oracle(network).run(times)
    assert not course.loose, f"nothing determines what {sorted(course.loose)} do"
    names = [f"{'u' if b.kind == 'C' else 'i'}_{b.name}" for b in network.of("C", "L")]
    columns = {name: course.columns[name] for name in names}
    return columns, drawing.events(course.events)


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
