"""What there is to draw: the nodes and bonds of a graph with their texts, and where strokes lie."""

from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from typing import Any

from bondgraph.causality.assign import assign_causality
from bondgraph.causality.causal_graph import CausalGraph
from bondgraph.declare.validate import validate
from bondgraph.declare.wires import WIRES
from bondgraph.drawing.readers import is_modulated, readings
from bondgraph.drawing.rich import Rich, Run, listed, named
from bondgraph.drawing.texts import bounds, does, switched, value_text
from bondgraph.errors import AlgebraicLoopError, CausalityError
from bondgraph.nodes.elements import Bond, Element
from bondgraph.nodes.kinds import Kind


@dataclass(frozen=True)
class Item:
    """A node: its kind, what is written beside it, and whether it is dependent.

    Beside a junction there is its name only, small. ``one_port``: with one bond, so no field. ``caption``:
    its name, small, where its value is written beside it. ``modulated``: whether signals or the time rule it.
    ``lines``: of a block of signals, what it does.
    """

    name: Hashable
    kind: Kind
    beside: Rich
    one_port: bool = False
    dependent: bool = False
    caption: Rich = ()
    modulated: bool = False
    lines: tuple[Rich, ...] = ()

    @property
    def block(self) -> bool:
        """Whether it is a node of signals, without power."""
        return self.kind.signals

    @property
    def symbol(self) -> str:
        """0, 1, TF, MTF, Se, ..."""
        return f"M{self.kind.symbol}" if self.modulated else self.kind.symbol

    @property
    def junction(self) -> bool:
        """Whether it is a 0- or a 1-junction."""
        return self.kind.joins


@dataclass(frozen=True)
class Link:
    """A bond from ``tail`` to ``head`` (places in `Subject.items`): effort, flow, who receives the effort.

    ``active``: it leads to a detector, so no power is in it. ``ports``: what a field's port at its tail and
    at its head is called.
    """

    tail: int
    head: int
    declared: Bond
    effort: Rich
    flow: Rich
    receiver: int | None
    active: bool = False
    ports: tuple[Rich, Rich] = ((), ())


@dataclass(frozen=True)
class Signal:
    """What an item reads of another, ``names``: an arrow from ``source`` to ``reader``."""

    source: int
    reader: int
    names: Rich


@dataclass(frozen=True)
class Subject:
    """All nodes, bonds and signals of a graph; ``remark`` says why there are no strokes, if so."""

    items: tuple[Item, ...]
    links: tuple[Link, ...]
    remark: str = ""
    signals: tuple[Signal, ...] = ()


def subject(graph: Any, values: bool, names: bool = False, signals: bool = True) -> Subject:
    """What to draw of a causal graph, or of a declared one: its causality is assigned.

    A graph whose causality is refused has no strokes but a remark. ``names``: beside values, too.

    Raises `StructureError` for what is not a bond graph.
    """
    causal, remark = _causal(graph)
    checked = causal.graph if causal else validate(graph)
    strokes = causal.strokes if causal else {}
    dependent = frozenset(causal.derivative) if causal else frozenset()
    elements: dict[Hashable, Element] = {name: checked.nodes[name]["element"] for name in checked}
    owners = {name: _drawn_as(e) for name, e in elements.items()}
    places = {owner: at for at, owner in enumerate(dict.fromkeys(owners.values()))}
    ports: dict[Hashable, list[Element]] = {owner: [] for owner in places}
    for name, owner in owners.items():
        ports[owner].append(elements[name])
    read = readings(checked, owners, checked.graph[WIRES])
    modulated = {reader for _, reader in read}
    items = tuple(
        _item(owner, own, dependent, values, names, is_modulated(own, owner in modulated))
        for owner, own in ports.items()
    )
    links = tuple(
        _link(
            elements[tail], elements[head], checked.edges[tail, head]["declared"],
            (owners[tail], owners[head]), places, strokes,
        )
        for tail, head in checked.edges
        if owners[tail] != owners[head]
    )  # fmt: skip
    arrows = tuple(
        Signal(places[source], places[reader], listed(names))
        for (source, reader), names in read.items()
    )
    return Subject(items, links, remark, arrows if signals else ())


def _drawn_as(element: Element) -> Hashable:
    """The node that stands for an element: a field's for its ports, a stop's for its parts."""
    if element.owner is not None:
        return element.owner
    return element.name if element.whole is None else element.whole


def _causal(graph: Any) -> tuple[CausalGraph | None, str]:
    """The causality, or why there is none."""
    if isinstance(graph, CausalGraph):
        return graph, ""
    checked = validate(graph)
    try:
        return assign_causality(checked), ""
    except (CausalityError, AlgebraicLoopError) as error:
        return None, f"No causal strokes: {error}"


def _item(
    owner: Hashable, ports: list[Element], dependent: frozenset[Hashable], values: bool,
    names: bool, modulated: bool,
) -> Item:  # fmt: skip
    element, name = ports[0], named(owner)
    if element.declared is not None and element.declared.signals:
        called = (
            name if element.task is None else (Run(str(owner)),)
        )  # what has instants is no signal
        return Item(owner, element.declared, called, lines=does(ports) if values else ())
    if element.whole is not None:
        beside: Rich = (bounds(ports) if values else ()) or name
        return Item(owner, Kind.STOP, beside, one_port=True, caption=_caption(names, beside, name))
    if element.kind.joins:
        return Item(owner, element.kind, name)
    held = switched(element)
    beside = (value_text(element) if values and not held else None) or name
    return Item(
        owner,
        Kind.SW if held else element.kind,
        (*name, Run(f" ({held})")) if held else beside,
        one_port=not element.kind.two_port and len(ports) == 1,
        dependent=any(port.name in dependent for port in ports),
        caption=_caption(names, beside, name),
        modulated=modulated,
    )


def _caption(names: bool, beside: Rich, name: Rich) -> Rich:
    """The name, where it is asked for and not written yet."""
    return name if names and beside != name else ()


def _link(
    first: Element, second: Element, declared: Bond, ends: tuple[Hashable, Hashable],
    places: Mapping[Hashable, int], strokes: Mapping[Bond, Hashable],
) -> Link:  # fmt: skip
    """The bond, with the variables that its one-port or a junction at its ends has names for."""
    ported = sorted((first, second), key=lambda element: element.kind.joins)
    names = [
        next((named(name) for e in ported if (name := getattr(e, which)) is not None), ())
        for which in ("effort", "flow")
    ]
    receiver = places[strokes[declared]] if strokes else None
    return Link(
        places[ends[0]], places[ends[1]], declared, names[0], names[1], receiver,
        active=first.kind.detects or second.kind.detects,
        ports=(_port(first, ends[0]), _port(second, ends[1])),
    )  # fmt: skip


def _port(element: Element, owner: Hashable) -> Rich:
    """What a field calls the port."""
    return named(str(element.name).removeprefix(f"{owner}.")) if element.owner is not None else ()
