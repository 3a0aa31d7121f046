"""What there is to draw: the nodes and bonds of a graph with their texts, and where strokes lie."""

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from bondgraph.causality.assign import assign_causality
from bondgraph.causality.causal_graph import CausalGraph
from bondgraph.declare.elements import OTHER, Bond, Element, Switch
from bondgraph.declare.kinds import Kind
from bondgraph.declare.laws import ExpressionLaw
from bondgraph.declare.validate import validate
from bondgraph.drawing.rich import MOST, Rich, Run, formula, joined, length, named
from bondgraph.errors import AlgebraicLoopError, CausalityError


@dataclass(frozen=True)
class Item:
    """A node: its kind, what is written beside it, and whether it is dependent.

    Beside a junction there is its name only, small. ``one_port``: with one bond, so no field.
    """

    name: Hashable
    kind: Kind
    beside: Rich
    one_port: bool = False
    dependent: bool = False

    @property
    def symbol(self) -> str:
        """0, 1, TF, Se, ..."""
        return self.kind.symbol

    @property
    def junction(self) -> bool:
        """Whether it is a 0- or a 1-junction."""
        return self.kind.joins


@dataclass(frozen=True)
class Link:
    """A bond from ``tail`` to ``head`` (places in `Subject.items`): effort, flow, who receives the effort."""

    tail: int
    head: int
    declared: Bond
    effort: Rich
    flow: Rich
    receiver: int | None


@dataclass(frozen=True)
class Subject:
    """All nodes and bonds of a graph; ``remark`` says why there are no strokes, where there are none."""

    items: tuple[Item, ...]
    links: tuple[Link, ...]
    remark: str = ""


def subject(graph: Any, values: bool) -> Subject:
    """What to draw of a causal graph, or of a declared one: its causality is assigned.

    A graph whose causality is refused has no strokes but a remark.

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
    items = tuple(_item(owner, own, dependent, values) for owner, own in ports.items())
    links = tuple(
        _link(
            elements[tail], elements[head], checked.edges[tail, head]["declared"],
            (owners[tail], owners[head]), places, strokes,
        )
        for tail, head in checked.edges
        if owners[tail] != owners[head]
    )  # fmt: skip
    return Subject(items, links, remark)


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
    owner: Hashable, ports: list[Element], dependent: frozenset[Hashable], values: bool
) -> Item:
    element = ports[0]
    if element.whole is not None:
        return Item(
            owner, Kind.STOP, (_bounds(ports) if values else ()) or named(owner), one_port=True
        )
    if element.kind.joins:
        return Item(owner, element.kind, named(owner))
    switched = _switched(element)
    beside = named(owner)
    if switched:
        beside = (*beside, Run(f" ({switched})"))
    elif values:
        beside = _value(element) or beside
    return Item(
        owner,
        Kind.SW if switched else element.kind,
        beside,
        one_port=not element.kind.two_port and len(ports) == 1,
        dependent=any(port.name in dependent for port in ports),
    )


def _bounds(ports: Sequence[Element]) -> Rich:
    """What a rigid stop keeps its displacement within, if that is short; nothing of one that yields."""
    place = next(port.integral for port in ports if port.integral is not None)
    low: Rich = ()
    high: Rich = ()
    for port in ports:
        if port.switch is None:
            continue
        if sp.diff(port.switch.off, place) < 0:
            low = (*formula(place + port.switch.off), Run(" ≤ "))
        else:
            high = (Run(" ≤ "), *formula(place - port.switch.off))
    bounded: Rich = (*low, *formula(place), *high)
    switches = [port.switch for port in ports if port.switch is not None]
    text = (*bounded, *_resets(switches[0])) if switches else bounded
    for one in (text, bounded):
        if (low or high) and length(one) <= MOST:
            return joined([*one])
    return ()


def _switched(element: Element) -> str:
    """On or off: what in_mode leaves of a switch is a port that gives zero of one of the two."""
    if element.kind.resists and element.law == ExpressionLaw(sp.Integer(0)):
        return "on" if element.gives == "effort" else "off"
    return ""


def _value(element: Element) -> Rich | None:
    """What the element is by its value, by its law or by how it switches, if that is short."""
    if element.switch is not None:
        one_way = _one_way(element)
        text = (*one_way, *_resets(element.switch)) if one_way else _conditions(element.switch)
        return joined([*text]) if length(text) <= MOST else None
    given = element.value
    if given is None and element.kind.supplies and element.owner is None:
        law = element.law
        given = law.expression if isinstance(law, ExpressionLaw) else element.given
    if given is None or element.owner is not None:
        return None
    text = formula(given)
    return text if length(text) <= MOST else None


def _one_way(element: Element) -> Rich:
    """What a switch lets through, where its own two variables change it over, as a diode's; else nothing."""
    switch = element.switch
    own = None if switch is None else element.variable(switch.gives)
    other = None if switch is None else element.variable(OTHER[switch.gives])
    if switch is None or own is None or other is None:
        return ()
    on, off = switch.on / own, switch.off / other
    if on.is_positive and off.is_negative:
        return (*named(other), Run(" ≥ 0"))
    if on.is_negative and off.is_positive:
        return (*named(other), Run(" ≤ 0"))
    return ()


def _conditions(switch: Switch) -> Rich:
    """What turns a switch on, and what turns it off where that is more than the opposite."""
    text: Rich = (*formula(switch.on), Run(" > 0"))
    if switch.off != -switch.on:
        text = (*text, Run(", off "), *formula(switch.off), Run(" > 0"))
    return (*text, *_resets(switch))


def _resets(switch: Switch) -> Rich:
    """What a switch sets states to."""
    parts: Rich = ()
    for one in switch.resets:
        parts = (*parts, Run("; "), *formula(one.state), Run(" := "), *formula(one.value))
    return parts


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
    return Link(places[ends[0]], places[ends[1]], declared, names[0], names[1], receiver)
