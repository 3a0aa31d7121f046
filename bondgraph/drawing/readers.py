"""Which element reads what of which other: the signals of a graph, and what they modulate."""

from collections.abc import Hashable, Iterable, Mapping, Sequence

import networkx as nx
import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.declare.names import named_by
from bondgraph.declare.wiring import Wire
from bondgraph.nodes.elements import Element

Reading = tuple[Hashable, Hashable]
"""Who has a signal, and who reads it."""


def readings(
    graph: "nx.DiGraph[Hashable]", owners: Mapping[Hashable, Hashable], wires: Iterable[Wire] = ()
) -> dict[Reading, tuple[sp.Symbol, ...]]:
    """The signals that nodes read of others, in order: what has them, what reads them, their names.

    ``owners``: the node that stands for an element. Of several elements that name a signal it is a
    detector's, else a junction's, a storage's, the first one's; a wire tells whose it is. What an element,
    other than a source, reads of its own bond is no signal, whoever names it.
    """
    elements = [graph.nodes[name]["element"] for name in graph]
    homes: dict[sp.Symbol, Element] = {}
    for element in sorted(elements, key=_rank):
        for name in named_by(element):
            homes.setdefault(name, element)
    told = {(wire.reader, name): wire.source for wire in wires for name in wire.names}
    found: dict[Reading, tuple[sp.Symbol, ...]] = {}
    for element in elements:
        reader = owners[element.name]
        own = {name for e in elements if owners[e.name] == reader for name in named_by(e)}
        if not element.kind.supplies:
            own |= _at_its_bond(graph, element)
        for name in sorted(reads(element) - own, key=str):
            if name in homes and owners[homes[name].name] != reader:
                source = told.get((reader, name.name), owners[homes[name].name])
                found[source, reader] = (*found.get((source, reader), ()), name)
    return {pair: tuple(dict.fromkeys(names)) for pair, names in found.items()}


def reads(element: Element) -> set[sp.Symbol]:
    """Every name in what an element is or does by: its value, law, conditions and what it sets."""
    parts: list[sp.Expr] = [entry for _, entry in element.row]
    parts += [] if element.value is None else [element.value]
    if element.switch is not None:
        parts += [element.switch.on, element.switch.off, element.switch.restitution]
        parts += [one.value for one in element.switch.resets]
    if element.task is not None:
        parts += [one.value for one in element.task.resets]
        parts += element.task.reads
    if element.late is not None:
        parts += [element.late.value, element.late.time, element.late.start]
    found: set[sp.Symbol] = set()
    for part in parts:
        found |= part.free_symbols
    return found if element.law is None else found | element.law.free_symbols


def is_modulated(ports: Sequence[Element], reader: bool) -> bool:
    """Whether a transformer, gyrator, source or resistance is ruled by a signal; the time is one, too.

    ``reader``: whether it reads what another has. A source that the time alone rules is as it is.
    """
    kind = ports[0].kind
    passes = kind.two_port or kind.resists
    if not (passes or kind.supplies):
        return False
    return reader or (passes and any(TIME in reads(port) for port in ports))


def _rank(element: Element) -> int:
    """Which of the elements that name a signal has it."""
    kind = element.kind
    return next(at for at, one in enumerate((kind.detects, kind.joins, kind.stores, True)) if one)


def _at_its_bond(graph: "nx.DiGraph[Hashable]", element: Element) -> set[sp.Symbol]:
    """What the junctions that a one-port is at have in common, by whatever name."""
    found: set[sp.Symbol] = set()
    if not element.one_port:
        return found
    for junction in nx.all_neighbors(graph, element.name):
        common = graph.nodes[junction]["element"].kind.common
        if common:
            near: Iterable[Hashable] = (junction, *nx.all_neighbors(graph, junction))
            own = (graph.nodes[one]["element"].variable(common) for one in near)
            found |= {name for name in own if name is not None}
    return found
