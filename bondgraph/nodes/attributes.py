"""What a user wrote at a node, attribute by attribute: the only reader of node attributes."""

from collections.abc import Hashable, Mapping
from typing import Any

import sympy as sp

from bondgraph.algebra.atoms import number, symbol
from bondgraph.algebra.expressions import TIME, expression
from bondgraph.algebra.residues import is_zero
from bondgraph.errors import ExpressionError, StructureError
from bondgraph.nodes import fields
from bondgraph.nodes.elements import Switch
from bondgraph.nodes.kinds import Kind
from bondgraph.nodes.laws import ExpressionLaw, Law, check_slider, law, slides
from bondgraph.nodes.resets import resets_of


def check_node_name(name: Hashable) -> None:
    """Refuse a name that is neither a text nor an integer."""
    if isinstance(name, bool) or not isinstance(name, str | int):
        raise StructureError(f"node {name!r}: a node's name must be a text or an integer")


def kind_of(attributes: Mapping[str, Any], where: str) -> Kind:
    """The kind of node that the attributes name."""
    if "kind" not in attributes:
        raise StructureError(f"{where} has no kind; give one of {', '.join(Kind)}")
    try:
        return Kind(attributes["kind"])
    except ValueError:
        raise StructureError(
            f"{where}: unknown kind {attributes['kind']!r}; there are {', '.join(Kind)}, "
            "and 0 and 1 for Zero and One"
        ) from None


def check_keys(kind: Kind, attributes: Mapping[str, Any], where: str) -> None:
    """Refuse attributes that a node of this kind does not have."""
    for key in attributes:
        if key != "kind" and key not in kind.nature.keys:
            allowed = ", ".join(sorted(kind.nature.keys))
            raise StructureError(
                f"{where}: unknown attribute {key!r}; kind {kind} may have {allowed}"
            )


def unit_of(attributes: Mapping[str, Any], where: str) -> str | None:
    """The unit of what the element gives, if one is told."""
    unit = attributes.get("unit")
    if unit is not None and not isinstance(unit, str):
        raise StructureError(f"{where}: unit {unit!r} must be a text")
    return unit


def start_of(attributes: Mapping[str, Any], where: str) -> sp.Expr | None:
    """The value with which a state begins, if one is told: numbers and parameters alone."""
    if attributes.get("start") is None:
        return None
    found = expression(attributes["start"], f"{where}, start")
    if TIME in found.free_symbols:
        raise StructureError(
            f"{where}: its start {found} reads the time; a run begins at one value"
        )
    return found


def priority_of(attributes: Mapping[str, Any], where: str) -> float:
    """How early a storage is tried in integral causality."""
    try:
        return float(number(attributes.get("priority", 0), f"{where}, priority"))
    except ExpressionError as error:
        raise StructureError(f"{error}; priority must be a number") from None


def bare_name(value: object, where: str) -> sp.Symbol | None:
    """The name that a source's value is, an input; None for an expression.

    Text that is more than a name, such as ``1*v``, is an expression though it comes to one: it repeats a
    signal of the model, as an ideal follower does.

    >>> bare_name("v", "node 's'"), bare_name("1*v", "node 's'")
    (v, None)
    """
    found = expression(value, where)
    named = isinstance(found, sp.Symbol) and found != TIME
    if isinstance(value, str):
        named = named and value.strip().isidentifier()
    return found if named else None


def variable(
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


def port_variables(
    name: Hashable, port: str, attributes: Mapping[str, Any]
) -> tuple[sp.Symbol, sp.Symbol]:
    """Effort and flow of one port of a field."""
    where = f"node {name!r}"
    effort, flow = (
        fields.port_variable(attributes.get(key), port, f"{key[0]}_{name}_{port}", where)
        for key in ("effort", "flow")
    )
    return effort, flow


def value_of(attributes: Mapping[str, Any], where: str) -> sp.Expr:
    """The value, which must be there and not be zero."""
    if attributes.get("value") is None:
        raise StructureError(f"{where} has no value; give a number, a name or an expression")
    value = expression(attributes["value"], where)
    if is_zero(value):
        raise StructureError(f"{where}: its value is zero, which leaves it without a meaning")
    return value


def gives_of(kind: Kind, attributes: Mapping[str, Any], where: str, linear: bool) -> str | None:
    """What an I, C or R gives where its causality is fixed; None for linear ones."""
    gives = attributes.get("gives", "effort")
    if gives not in ("effort", "flow"):
        raise StructureError(f"{where}: gives is {gives!r}; it must be 'effort' or 'flow'")
    if linear:
        if "gives" in attributes:
            raise StructureError(f"{where}: gives is for open ports and laws; leave it out here")
        return None
    if kind.stores:
        return kind.gives
    return str(gives)


def law_of(
    name: Hashable, kind: Kind, attributes: Mapping[str, Any], gives: str | None
) -> Law | None:
    """The law declared, or the slope of the energy declared."""
    if attributes.get("energy") is not None:
        return energy_of(name, kind, attributes)[1]
    return _law(name, kind, attributes["law"], gives) if attributes.get("law") is not None else None


def energy_of(
    name: Hashable, kind: Kind, attributes: Mapping[str, Any]
) -> tuple[sp.Expr, ExpressionLaw]:
    """The energy of a one-port and the law that follows from it."""
    where = f"node {name!r}"
    state = symbol(f"{kind.letter}_{name}", where)
    energy, (slope,) = fields.gradient(attributes["energy"], [state], where)
    return energy, ExpressionLaw(slope, state)


def _law(name: Hashable, kind: Kind, given: object, gives: str | None) -> Law:
    where = f"node {name!r}, law"
    state = None
    if kind.stores:
        state = symbol(f"{kind.letter}_{name}", where)
    result = law(given, where, state)
    if gives is not None and slides(result, gives):
        check_slider(result, where)
    return result


def inverse_of(
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


def switch_of(name: Hashable, attributes: Mapping[str, Any], gives: str) -> Switch:
    """When a switch or a controlled junction turns on and off."""
    where = f"node {name!r}"
    if attributes.get("on") is None:
        raise StructureError(f"{where} has no condition on, above zero where it turns on")
    on = expression(attributes["on"], f"{where}, on")
    off = -on if attributes.get("off") is None else expression(attributes["off"], f"{where}, off")
    resets = resets_of(attributes.get("reset"), where, ("on", "off"))
    return Switch(name, on, off, gives, resets=resets)
