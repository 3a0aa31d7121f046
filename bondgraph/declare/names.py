"""Rules that hold between elements: names that must differ, and parts that must belong together."""

import re
from collections.abc import Hashable, Iterable, Sequence
from typing import Any

import networkx as nx
import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.errors import StructureError, nearest
from bondgraph.nodes.elements import Element
from bondgraph.nodes.laws import DryFriction, ExpressionLaw, Law


def check_names(elements: Sequence[Element]) -> None:
    """Refuse one name for two things: two quantities, a quantity and a value, two sets of assumptions."""
    owners: dict[sp.Symbol, Element] = {}
    for element in elements:
        for name in _owned(element):
            _check_owner(owners, name, element)
    signals = set(owners) | {name for element in elements for name in named_by(element)}
    _check_reads(elements, signals)
    if TIME in signals:
        owner = next(element for element in elements if TIME in named_by(element))
        raise StructureError(
            f"node {owner.name!r}: 't' is the time; give its variable another name"
        )
    _check_own_names(elements)
    _check_assumptions(elements, signals)


def _owned(element: Element) -> Iterable[sp.Symbol]:
    """The quantities that this element alone imposes or keeps: its input and its law's state."""
    own = [element.given] if element.given is not None else []
    if (
        isinstance(element.law, DryFriction)
        and element.gives is None
        and element.effort is not None
    ):
        own.append(element.effort)
    if element.switch is not None:
        own += [name for name in (element.effort, element.flow) if name is not None]
    if element.integral is not None:
        own.append(element.integral)
    if isinstance(element.law, ExpressionLaw) and element.law.state is not None:
        own.append(element.law.state)
    return own


def _check_owner(owners: dict[sp.Symbol, Element], name: sp.Symbol, element: Element) -> None:
    other = owners.setdefault(name, element)
    shared_input = all(one.kind.supplies and one.law is None for one in (other, element))
    if other is not element and not shared_input:
        raise StructureError(
            f"nodes {other.name!r} and {element.name!r} both impose a variable {name}; "
            "two names may be equal only where the quantities are"
        )


def named_by(element: Element) -> tuple[sp.Symbol, ...]:
    """The signals an element names: its effort, its flow, and the state its law or itself owns."""
    named = [n for n in (element.effort, element.flow, element.integral) if n is not None]
    if isinstance(element.law, ExpressionLaw) and element.law.state is not None:
        named.append(element.law.state)
    return tuple(named)


def energy_name(element: Element, taken: set[str]) -> sp.Symbol:
    """A name for a storage's momentum or displacement, as laws name theirs; it is taken from then on."""
    text = re.sub(r"\W", "_", f"{element.kind.letter}_{element.name}")
    while text in taken:
        text += "_"
    taken.add(text)
    return sp.Symbol(text)


def _check_reads(elements: Sequence[Element], signals: set[sp.Symbol]) -> None:
    """Refuse a controller that reads a signal which its ``reads``, where it has them, leave out."""
    for element in elements:
        if (task := element.task) is None or not task.reads:
            continue
        used = {name for one in task.resets for name in one.value.free_symbols}
        missing = (used & signals) - {*task.reads, *task.states}
        if missing:
            listed = ", ".join(sorted(map(str, missing)))
            raise StructureError(
                f"node {element.name!r}: its expressions read {listed}, which its reads leave out; add "
                "what is meant, or leave reads out"
            )


def _check_own_names(elements: Sequence[Element]) -> None:
    """Refuse a value that is nothing but the element's own variable: it was meant as a parameter."""
    for element in elements:
        if element.value is not None and element.value in named_by(element):
            raise StructureError(
                f"node {element.name!r}: its value is {element.value}, the name of its own variable; "
                "a parameter needs a name of its own"
            )


def _check_assumptions(elements: Sequence[Element], signals: set[sp.Symbol]) -> None:
    seen: dict[str, sp.Symbol] = {name.name: name for name in signals}
    for element in elements:
        used: set[sp.Symbol] = set()
        for part in read_in(element):
            used |= part.free_symbols
        for name in sorted(used, key=str):
            if seen.setdefault(name.name, name) != name:
                raise StructureError(
                    f"node {element.name!r}: the symbol {name} is used elsewhere with different "
                    "assumptions; use one symbol for one name, or plain text"
                )


def read_in(element: Element) -> list[Law | sp.Expr]:
    """What an element reads names in."""
    told: list[Law | sp.Expr | None] = [element.value, element.law]
    resets = () if element.task is None else element.task.resets
    if element.switch is not None:
        told += [element.switch.on, element.switch.off]
        resets = element.switch.resets
    told += [part for one in resets for part in (one.state, one.value)]
    if element.late is not None:
        told += [element.late.value, element.late.time, element.late.start]
    return [part for part in told if part is not None]


def check_one_whole(graph: "nx.DiGraph[Hashable]") -> None:
    """Refuse parts that share neither a bond nor a signal: most often a bond was forgotten.

    A signal is shared where a law or value reads it, or where both have an input of its name.
    """
    joined: nx.Graph[Any] = nx.Graph()
    joined.add_nodes_from(("node", name) for name in graph)
    joined.add_edges_from((("node", tail), ("node", head)) for tail, head in graph.edges)
    owned: set[sp.Symbol] = set()
    for name in graph:
        owned |= set(named_by(graph.nodes[name]["element"]))
    for name in graph:
        element = graph.nodes[name]["element"]
        if element.owner is not None:
            joined.add_edge(("node", name), ("field", element.owner))
        if element.whole is not None:
            joined.add_edge(("node", name), ("whole", element.whole))
        used = {symbol for part in read_in(element) for symbol in part.free_symbols & owned}
        for _, entry in element.row:
            used |= entry.free_symbols & owned
        joined.add_edges_from((("node", name), ("signal", s)) for s in {*used, *named_by(element)})
    parts = [
        [name for kind, name in part if kind == "node"] for part in nx.connected_components(joined)
    ]
    if len(parts) > 1:
        position = {name: at for at, name in enumerate(graph)}
        first, second, *_ = sorted(parts, key=lambda part: min(position[name] for name in part))
        names = [min(part, key=position.__getitem__) for part in (first, second)]
        meant = _misspelt(graph, owned, second, first) or _misspelt(graph, owned, first, second)
        raise StructureError(
            f"the part of node {names[0]!r} and the part of node {names[1]!r} share neither a bond "
            f"nor a signal; {meant}bond them, or derive each on its own"
        )


def _misspelt(
    graph: "nx.DiGraph[Hashable]", owned: set[sp.Symbol], part: Iterable[Hashable],
    other: Iterable[Hashable],
) -> str:  # fmt: skip
    """What a signal of one part reads, which is none, but nearly one of the other, in words."""
    known = [name.name for node in other for name in named_by(graph.nodes[node]["element"])]
    for node in part:
        element = graph.nodes[node]["element"]
        read = {s.name for told in read_in(element) for s in told.free_symbols - owned}
        for name in sorted(read) if element.whole is not None else ():
            if question := nearest(name, known):
                return f"{element.whole!r} reads {name}{question}; "
    return ""
