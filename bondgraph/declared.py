"""Node attributes as checked elements: the only reader of what a user wrote at a node."""

from collections.abc import Hashable, Mapping
from typing import Any

import sympy as sp

from bondgraph import fields
from bondgraph.elements import (
    DETECTORS,
    JUNCTIONS,
    KEYS,
    SOURCES,
    STORAGES,
    TWO_PORTS,
    Element,
    Kind,
)
from bondgraph.errors import ExpressionError, StructureError
from bondgraph.expressions import TIME, expression, number, symbol
from bondgraph.laws import DryFriction, ExpressionLaw, Law, law
from bondgraph.residues import is_zero


def elements_of(name: Hashable, attributes: Mapping[str, Any]) -> dict[Hashable, Element]:
    """The element that a node's attributes declare; of a field one per port, called ``<name>.<port>``.

    Raises `StructureError` or `ExpressionError`, naming the node.
    """
    if attributes.get("ports") is None:
        return {name: _element(name, attributes)}
    where = f"node {name!r}"
    _element_name(name)
    kind = _kind(attributes, where)
    _check_keys(kind, attributes, where)
    ports = fields.port_names(attributes["ports"], where)
    build = _energy_field if attributes.get("energy") is not None else _matrix_field
    made = build(name, kind, ports, attributes)
    return {element.name: element for element in made}


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
    rows = fields.matrix(attributes["value"], ports, kind in STORAGES, where)
    parts = [fields.part(name, port) for port in ports]
    return [
        Element(
            parts[at], kind, rows[at][at], *_port_variables(name, port, attributes),
            priority=_priority(attributes, where), unit=_unit(attributes, where),
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
    letter = "p" if kind is Kind.I else "q"
    states = [symbol(f"{letter}_{name}_{port}", where) for port in ports]
    energy, slopes = fields.gradient(attributes["energy"], states, where)
    return [
        Element(
            fields.part(name, port), kind, None, *_port_variables(name, port, attributes),
            law=ExpressionLaw(slope, state), priority=_priority(attributes, where),
            gives="flow" if kind is Kind.I else "effort", unit=_unit(attributes, where),
            owner=name, energy=energy,
        )
        for port, state, slope in zip(ports, states, slopes, strict=True)
    ]  # fmt: skip


def _port_variables(
    name: Hashable, port: str, attributes: Mapping[str, Any]
) -> tuple[sp.Symbol, sp.Symbol]:
    where = f"node {name!r}"
    effort, flow = (
        fields.port_variable(attributes.get(key), port, f"{key[0]}_{name}_{port}", where)
        for key in ("effort", "flow")
    )
    return effort, flow


def _unit(attributes: Mapping[str, Any], where: str) -> str | None:
    unit = attributes.get("unit")
    if unit is not None and not isinstance(unit, str):
        raise StructureError(f"{where}: unit {unit!r} must be a text")
    return unit


def _element_name(name: Hashable) -> None:
    if isinstance(name, bool) or not isinstance(name, str | int):
        raise StructureError(f"node {name!r}: a node's name must be a text or an integer")


def _element(name: Hashable, attributes: Mapping[str, Any]) -> Element:
    _element_name(name)
    where = f"node {name!r}"
    kind = _kind(attributes, where)
    _check_keys(kind, attributes, where)
    unit = _unit(attributes, where)
    if kind in JUNCTIONS:
        common = "effort" if kind is Kind.ZERO else "flow"
        variable = _name(attributes, common, name, strict=False)
        effort, flow = (variable, None) if kind is Kind.ZERO else (None, variable)
        return Element(name, kind, None, effort, flow)
    if kind in TWO_PORTS:
        return Element(name, kind, _value(attributes, where), None, None, unit=unit)
    if kind in SOURCES:
        return _source(name, kind, attributes, unit)
    if kind in DETECTORS:
        return _detector(name, kind, attributes, unit)
    return _passive(name, kind, attributes, unit)


def _kind(attributes: Mapping[str, Any], where: str) -> Kind:
    if "kind" not in attributes:
        raise StructureError(f"{where} has no kind; give one of {', '.join(Kind)}")
    try:
        return Kind(attributes["kind"])
    except ValueError:
        raise StructureError(
            f"{where}: unknown kind {attributes['kind']!r}; there are {', '.join(Kind)}"
        ) from None


def _check_keys(kind: Kind, attributes: Mapping[str, Any], where: str) -> None:
    for key in attributes:
        if key != "kind" and key not in KEYS[kind]:
            allowed = ", ".join(sorted(KEYS[kind]))
            raise StructureError(
                f"{where}: unknown attribute {key!r}; kind {kind} may have {allowed}"
            )


def _name(
    attributes: Mapping[str, Any], key: str, name: Hashable, strict: bool = True
) -> sp.Symbol | None:
    """The symbol of the node's effort or flow: the given name, or ``e_<name>`` or ``f_<name>``.

    Not ``strict``: None where the node's name makes no symbol.
    """
    where = f"node {name!r}"
    if attributes.get(key) is not None:
        given = attributes[key]
        text = given.name if isinstance(given, sp.Symbol) else given
        return symbol(text, f"{where}, {key}")
    try:
        return symbol(f"{key[0]}_{name}", where)
    except ExpressionError as error:
        if strict:
            raise StructureError(f"{error}; rename the node, or name its effort and flow") from None
        return None


def _value(attributes: Mapping[str, Any], where: str) -> sp.Expr:
    if attributes.get("value") is None:
        raise StructureError(f"{where} has no value; give a number, a name or an expression")
    value = expression(attributes["value"], where)
    if is_zero(value):
        raise StructureError(f"{where}: its value is zero, which leaves it without a meaning")
    return value


def _source(name: Hashable, kind: Kind, attributes: Mapping[str, Any], unit: str | None) -> Element:
    """A source: a bare name is an input of that name, another expression a known source's law."""
    where = f"node {name!r}"
    if attributes.get("value") is None:
        raise StructureError(f"{where} has no value; give the input's name or an expression")
    gives, receives = ("effort", "flow") if kind is Kind.SE else ("flow", "effort")
    value = expression(attributes["value"], where)
    bare = isinstance(value, sp.Symbol) and value != TIME
    given = sp.Symbol(value.name) if bare else _name({}, gives, name)
    if bare and value != given:
        raise StructureError(f"{where}: the input {value} must be a symbol without assumptions")
    received = _name(attributes, receives, name)
    effort, flow = (given, received) if kind is Kind.SE else (received, given)
    known = None if bare else law(value, where)
    return Element(name, kind, None, effort, flow, law=known, gives=gives, unit=unit)


def _detector(
    name: Hashable, kind: Kind, attributes: Mapping[str, Any], unit: str | None
) -> Element:
    """A port that gives nothing and reads one variable, or that variable's integral too."""
    integral = attributes.get("integrate")
    if integral is not None:
        text = integral.name if isinstance(integral, sp.Symbol) else integral
        integral = symbol(text, f"node {name!r}, integrate")
    effort, flow = (_name(attributes, variable, name) for variable in ("effort", "flow"))
    gives = "flow" if kind is Kind.DE else "effort"
    return Element(name, kind, None, effort, flow, gives=gives, unit=unit, integral=integral)


def _passive(
    name: Hashable, kind: Kind, attributes: Mapping[str, Any], unit: str | None
) -> Element:
    """An I, C or R: linear by its value, nonlinear by its law, or (R) an open port."""
    where = f"node {name!r}"
    given = [key for key in ("value", "law", "energy") if attributes.get(key) is not None]
    if len(given) > 1:
        raise StructureError(f"{where} has both a {given[0]} and a {given[1]}; give one of them")
    if kind in STORAGES and not given:
        raise StructureError(f"{where} has no value; give a number, a name, an expression or a law")
    valued = given == ["value"]
    gives = _gives(kind, attributes, where, valued)
    effort, flow = (_name(attributes, variable, name) for variable in ("effort", "flow"))
    closed = _given_law(name, kind, attributes, gives)
    inverse = _inverse(attributes, closed, flow if kind is Kind.I else effort, where)
    return Element(
        name,
        kind,
        _value(attributes, where) if valued else None,
        effort,
        flow,
        law=closed,
        priority=_priority(attributes, where),
        gives=gives if inverse is None else None,
        unit=unit,
        energy=_energy(name, kind, attributes)[0] if given == ["energy"] else None,
        inverse=inverse,
    )


def _inverse(
    attributes: Mapping[str, Any], closed: Law | None, given: sp.Symbol | None, where: str
) -> sp.Expr | None:
    """A law's inverse, checked: the law of it is the variable that the law gives."""
    if attributes.get("inverse") is None:
        return None
    if not isinstance(closed, ExpressionLaw) or closed.state is None:
        raise StructureError(f"{where}: an inverse belongs to the law or the energy of an I or a C")
    inverse = expression(attributes["inverse"], f"{where}, inverse")
    if not fields.inverts(closed.expression.subs(closed.state, inverse), given):
        raise StructureError(
            f"{where}: {inverse} is not the inverse of {closed.expression}: put in, it does not give {given}"
        )
    return inverse


def _given_law(
    name: Hashable, kind: Kind, attributes: Mapping[str, Any], gives: str | None
) -> Law | None:
    """The law declared, or the slope of the energy declared."""
    if attributes.get("energy") is not None:
        return _energy(name, kind, attributes)[1]
    return _law(name, kind, attributes["law"], gives) if attributes.get("law") is not None else None


def _energy(
    name: Hashable, kind: Kind, attributes: Mapping[str, Any]
) -> tuple[sp.Expr, ExpressionLaw]:
    """The energy of a one-port and the law that follows from it."""
    where = f"node {name!r}"
    state = symbol(f"{'p' if kind is Kind.I else 'q'}_{name}", where)
    energy, (slope,) = fields.gradient(attributes["energy"], [state], where)
    return energy, ExpressionLaw(slope, state)


def _law(name: Hashable, kind: Kind, given: object, gives: str | None) -> Law:
    where = f"node {name!r}, law"
    state = None
    if kind in STORAGES:
        state = symbol(f"{'p' if kind is Kind.I else 'q'}_{name}", where)
    result = law(given, where, state)
    if isinstance(result, DryFriction) and gives != "effort":
        raise StructureError(f"{where}: dry friction gives an effort; leave gives='effort'")
    return result


def _gives(kind: Kind, attributes: Mapping[str, Any], where: str, linear: bool) -> str | None:
    gives = attributes.get("gives", "effort")
    if gives not in ("effort", "flow"):
        raise StructureError(f"{where}: gives is {gives!r}; it must be 'effort' or 'flow'")
    if linear:
        if "gives" in attributes:
            raise StructureError(f"{where}: gives is for open ports and laws; leave it out here")
        return None
    if kind in STORAGES:
        return "flow" if kind is Kind.I else "effort"
    return str(gives)


def _priority(attributes: Mapping[str, Any], where: str) -> float:
    try:
        return float(number(attributes.get("priority", 0), f"{where}, priority"))
    except ExpressionError as error:
        raise StructureError(f"{error}; priority must be a number") from None
