"""Nodes as checked elements: which kind of element the attributes of a node declare."""

from collections.abc import Callable, Hashable, Iterable, Mapping
from dataclasses import replace
from typing import Any

import sympy as sp

from bondgraph.algebra.atoms import symbol
from bondgraph.errors import StructureError, nearest
from bondgraph.nodes import fields
from bondgraph.nodes.attributes import (
    bare_name,
    check_keys,
    check_node_name,
    energy_of,
    gives_of,
    inverse_of,
    kind_of,
    law_of,
    port_variables,
    priority_of,
    start_of,
    switch_of,
    unit_of,
    value_of,
    variable,
)
from bondgraph.nodes.controllers import controller_elements
from bondgraph.nodes.delays import delay_elements
from bondgraph.nodes.elements import OTHER, Element
from bondgraph.nodes.hysteresis import hysteresis_elements
from bondgraph.nodes.kinds import Kind
from bondgraph.nodes.laws import DryFriction, ExpressionLaw, law
from bondgraph.nodes.machines import machine_elements
from bondgraph.nodes.rate_limiter import rate_limiter_elements
from bondgraph.nodes.signals import function_elements, state_elements
from bondgraph.nodes.stops import stop_elements

COMPOSITE: Mapping[str, Callable[[Hashable, Mapping[str, Any]], list[Element]]] = {
    Kind.STOP: stop_elements,
    Kind.FUNCTION: function_elements,
    Kind.STATE: state_elements,
    Kind.CONTROLLER: controller_elements,
    Kind.HYSTERESIS: hysteresis_elements,
    Kind.RATE_LIMITER: rate_limiter_elements,
    Kind.DELAY: delay_elements,
    Kind.MACHINE: machine_elements,
}
"""What nodes of several elements are made of, by their kind; the first of them stands for the node.

Each other is bonded to the last junction before it, a junction to the first.
"""


def elements_of(name: Hashable, attributes: Mapping[str, Any]) -> dict[Hashable, Element]:
    """The element that a node's attributes declare; of a field one per port, called ``<name>.<port>``.

    Raises `StructureError` or `ExpressionError`, naming the node.
    """
    if attributes.get("ports") is None:
        if (made := _composite(name, attributes)) is not None:
            return {element.name: element for element in made}
        made = [_element(name, attributes)]
        if made[0].kind.joins and (attributes.keys() & {"on", "off", "reset"}):
            made.append(_control(made[0], attributes))
        return {element.name: element for element in made}
    where = f"node {name!r}"
    check_node_name(name)
    kind = kind_of(attributes, where)
    check_keys(kind, attributes, where)
    ports = fields.port_names(attributes["ports"], where)
    starts = _starts(attributes, ports, where)
    build = _energy_field if attributes.get("energy") is not None else _matrix_field
    if kind.resists and isinstance(attributes.get("law"), Mapping):
        build = _law_field
    made = build(name, kind, ports, attributes)
    if starts:
        made = [replace(one, start=starts.get(port)) for one, port in zip(made, ports, strict=True)]
    return {element.name: element for element in made}


def _starts(
    attributes: Mapping[str, Any], ports: tuple[str, ...], where: str
) -> dict[str, sp.Expr | None]:
    """What the states of a field's ports begin with, by the ports."""
    given = attributes.get("start")
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise StructureError(f"{where}: with ports, start maps ports to values, not {given!r}")
    _check_ports(given, ports, f"{where}, start")
    return {port: start_of({"start": value}, f"{where} at {port}") for port, value in given.items()}


def _check_ports(given: Iterable[str], ports: tuple[str, ...], where: str) -> None:
    for port in given:
        if port not in ports:
            raise StructureError(
                f"{where}: there is no port {port!r}{nearest(str(port), ports)}; there are {', '.join(ports)}"
            )


def _matrix_field(
    name: Hashable, kind: Kind, ports: tuple[str, ...], attributes: Mapping[str, Any]
) -> list[Element]:
    """A field by its matrix: each port with its row."""
    where = f"node {name!r}"
    for key in ("law", "gives"):
        if attributes.get(key) is not None:
            raise StructureError(
                f"{where}: with ports, give a matrix as value, or an energy, not {key}"
            )
    if attributes.get("value") is None:
        raise StructureError(f"{where}: a field needs a matrix as value, or an energy")
    rows = fields.matrix(attributes["value"], ports, kind.stores, where)
    parts = [fields.part(name, port) for port in ports]
    return [
        Element(
            parts[at], kind, rows[at][at], *port_variables(name, port, attributes),
            priority=priority_of(attributes, where), unit=unit_of(attributes, where),
            row=tuple(zip(parts, rows[at], strict=True)), owner=name,
        )
        for at, port in enumerate(ports)
    ]  # fmt: skip


def _energy_field(
    name: Hashable, kind: Kind, ports: tuple[str, ...], attributes: Mapping[str, Any]
) -> list[Element]:
    """A field by its energy: each port a storage whose law is the energy's slope along its state."""
    where = f"node {name!r}"
    for key in ("law", "value"):
        if attributes.get(key) is not None:
            raise StructureError(f"{where}: it has both an energy and a {key}; give one of them")
    letter = kind.letter
    states = [symbol(f"{letter}_{name}_{port}", where) for port in ports]
    energy, slopes = fields.gradient(attributes["energy"], states, where)
    return [
        Element(
            fields.part(name, port), kind, None, *port_variables(name, port, attributes),
            law=ExpressionLaw(slope, state), priority=priority_of(attributes, where),
            gives=kind.gives, unit=unit_of(attributes, where),
            owner=name, energy=energy,
        )
        for port, state, slope in zip(ports, states, slopes, strict=True)
    ]  # fmt: skip


def _law_field(
    name: Hashable, kind: Kind, ports: tuple[str, ...], attributes: Mapping[str, Any]
) -> list[Element]:
    """A resistance of several ports, each with a law that may read the others' variables."""
    where = f"node {name!r}"
    for key in ("energy", "value"):
        if attributes.get(key) is not None:
            raise StructureError(f"{where}: it has both a law and a {key}; give one of them")
    laws, gives = attributes["law"], attributes.get("gives") or {}
    if not isinstance(gives, Mapping):
        raise StructureError(
            f"{where}: with ports, gives maps ports to effort or flow, not {gives!r}"
        )
    for key, told in (("law", laws), ("gives", gives)):
        _check_ports(told, ports, f"{where}, {key}")
    if missing := [port for port in ports if laws.get(port) is None]:
        raise StructureError(f"{where}: no law at port {missing[0]!r}; each port needs one")
    made = []
    for port in ports:
        effort, flow = port_variables(name, port, attributes)
        own = {
            "effort": effort,
            "flow": flow,
            "law": laws[port],
            "gives": gives.get(port, "effort"),
        }
        one = _passive(fields.part(name, port), kind, own, unit_of(attributes, where))
        made.append(replace(one, owner=name))
    return made


def _element(name: Hashable, attributes: Mapping[str, Any]) -> Element:
    check_node_name(name)
    where = f"node {name!r}"
    kind = kind_of(attributes, where)
    check_keys(kind, attributes, where)
    unit = unit_of(attributes, where)
    if kind.joins:
        common = kind.common
        own = variable(attributes, common, name, strict=False)
        effort, flow = (own, None) if kind.common == "effort" else (None, own)
        return Element(name, kind, None, effort, flow)
    if kind.two_port:
        return Element(name, kind, value_of(attributes, where), None, None, unit=unit)
    if kind.supplies:
        return _source(name, kind, attributes, unit)
    if kind.detects:
        return _detector(name, kind, attributes, unit)
    if kind.switches:
        effort, flow = (variable(attributes, key, name) for key in ("effort", "flow"))
        switch = switch_of(name, attributes, "effort")
        return Element(name, kind, None, effort, flow, switch=switch)
    return _passive(name, kind, attributes, unit)


def _composite(name: Hashable, attributes: Mapping[str, Any]) -> list[Element] | None:
    """The elements of a node that is made of several; None of any other."""
    build = COMPOSITE.get(str(attributes.get("kind")))
    if build is None:
        return None
    check_node_name(name)
    kind = Kind(attributes["kind"])
    check_keys(kind, attributes, f"node {name!r}")
    return [replace(element, declared=kind) for element in build(name, attributes)]


def _source(name: Hashable, kind: Kind, attributes: Mapping[str, Any], unit: str | None) -> Element:
    """A source: a bare name is an input of that name, another expression a known source's law."""
    where = f"node {name!r}"
    if attributes.get("value") is None:
        raise StructureError(
            f"{where} has no value; give the input's name or an expression, or wire a signal to it"
        )
    gives, receives = kind.gives, OTHER[kind.gives]
    bare = bare_name(attributes["value"], where)
    given = variable({}, gives, name) if bare is None else sp.Symbol(bare.name)
    if bare not in (None, given):
        raise StructureError(f"{where}: the input {bare} must be a symbol without assumptions")
    received = variable(attributes, receives, name)
    effort, flow = (given, received) if gives == "effort" else (received, given)
    known = law(attributes["value"], where) if bare is None else None
    return Element(name, kind, None, effort, flow, law=known, gives=gives, unit=unit)


def _detector(
    name: Hashable, kind: Kind, attributes: Mapping[str, Any], unit: str | None
) -> Element:
    """A port that gives nothing and reads one variable, or that variable's integral too."""
    integral = attributes.get("integrate")
    if integral is not None:
        text = integral.name if isinstance(integral, sp.Symbol) else integral
        integral = symbol(text, f"node {name!r}, integrate")
    effort, flow = (variable(attributes, key, name) for key in ("effort", "flow"))
    start = start_of(attributes, f"node {name!r}")
    if start is not None and integral is None:
        raise StructureError(
            f"node {name!r}: it has a start, but integrates nothing; name integrate"
        )
    return Element(
        name, kind, None, effort, flow, gives=kind.gives, unit=unit, integral=integral, start=start
    )


def _passive(
    name: Hashable, kind: Kind, attributes: Mapping[str, Any], unit: str | None
) -> Element:
    """An I, C or R: linear by its value, nonlinear by its law, or (R) an open port."""
    where = f"node {name!r}"
    given = [key for key in ("value", "law", "energy") if attributes.get(key) is not None]
    if len(given) > 1:
        raise StructureError(f"{where} has both a {given[0]} and a {given[1]}; give one of them")
    if kind.stores and not given:
        raise StructureError(f"{where} has no value; give a number, a name, an expression or a law")
    valued = given == ["value"]
    gives = gives_of(kind, attributes, where, valued)
    effort, flow = (variable(attributes, key, name) for key in ("effort", "flow"))
    closed = law_of(name, kind, attributes, gives)
    inverse = inverse_of(attributes, closed, flow if kind.gives == "flow" else effort, where)
    free = inverse is not None or (isinstance(closed, DryFriction) and gives != "flow")
    return Element(
        name,
        kind,
        value_of(attributes, where) if valued else None,
        effort,
        flow,
        law=closed,
        priority=priority_of(attributes, where),
        gives=None if free else gives,
        unit=unit,
        energy=energy_of(name, kind, attributes)[0] if given == ["energy"] else None,
        inverse=inverse,
        start=start_of(attributes, where),
    )


def _control(junction: Element, attributes: Mapping[str, Any]) -> Element:
    """The switch that makes a junction a controlled one: a port of its own, ``<name>_switch``."""
    gives = OTHER[junction.kind.common]
    name = f"{junction.name}_switch"
    effort, flow = (variable({}, key, name) for key in ("effort", "flow"))
    switch = switch_of(junction.name, attributes, gives)
    return Element(name, Kind.SW, None, effort, flow, switch=switch)
