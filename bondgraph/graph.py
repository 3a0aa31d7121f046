"""`validate`: the only reader of the user's attributes; what passes is complete, checked and frozen."""

from collections.abc import Hashable, Mapping
from typing import TYPE_CHECKING, Any

import networkx as nx
import sympy as sp

from bondgraph.elements import (
    DETECTORS,
    JUNCTIONS,
    KEYS,
    POWER_INTO,
    SOURCES,
    STORAGES,
    TWO_PORTS,
    Element,
    Kind,
)
from bondgraph.errors import ExpressionError, StructureError
from bondgraph.expressions import TIME, expression, number, symbol
from bondgraph.laws import DryFriction, Law, law
from bondgraph.names import check_names, check_one_whole
from bondgraph.residues import is_zero

Bond = tuple[Hashable, Hashable]


if TYPE_CHECKING:
    _DiGraph = nx.DiGraph[Hashable]
else:
    _DiGraph = nx.DiGraph


class _Validated(_DiGraph):
    """A graph that has passed; only `validate` makes one."""


def validate(graph: Any) -> "nx.DiGraph[Hashable]":
    """A frozen copy of the graph whose nodes carry one checked `Element` each as ``element``.

    Bonds of I, C or R at junctions and sources point into them; each keeps as ``declared`` the pair
    of nodes it was declared with. A graph that has passed is returned as it is.

    Raises `StructureError`, naming the node or bond, for whatever is not a bond graph.
    """
    if not isinstance(graph, nx.DiGraph) or graph.is_multigraph():
        raise StructureError(
            f"a bond graph is a networkx.DiGraph with one edge a bond, not a {type(graph).__name__}"
        )
    if isinstance(graph, _Validated):
        return graph
    if len(graph) == 0:
        raise StructureError("the graph has no nodes; add elements and bonds first")
    result = _Validated()
    for name, attributes in graph.nodes(data=True):
        result.add_node(name, element=_element(name, attributes))
    for tail, head, attributes in graph.edges(data=True):
        _check_bond(graph, tail, head, attributes)
        first, last = _oriented(result, tail, head)
        result.add_edge(first, last, declared=(tail, head))
    for name in result:
        _check_degree(result, name)
    check_names([result.nodes[name]["element"] for name in result])
    check_one_whole(result)
    nx.freeze(result)
    return result


def _check_bond(graph: Any, tail: Hashable, head: Hashable, attributes: dict[str, Any]) -> None:
    if tail == head:
        raise StructureError(f"node {tail!r} is bonded to itself; remove that edge")
    if graph.has_edge(head, tail):
        raise StructureError(
            f"nodes {tail!r} and {head!r} are bonded both ways; a bond is one edge, in the "
            "direction of positive power"
        )
    if attributes:
        raise StructureError(
            f"bond {tail!r} -> {head!r}: unknown attribute {sorted(map(str, attributes))[0]!r}; "
            "bonds carry no attributes"
        )


def _oriented(graph: "nx.DiGraph[Hashable]", tail: Hashable, head: Hashable) -> Bond:
    """The bond turned so that it points into I, C or R, unless its other end needs its direction."""
    kinds = [graph.nodes[name]["element"].kind for name in (tail, head)]
    if kinds[0] in POWER_INTO and kinds[1] not in POWER_INTO and kinds[1] not in TWO_PORTS:
        return head, tail
    return tail, head


def _check_degree(graph: "nx.DiGraph[Hashable]", name: Hashable) -> None:
    kind = graph.nodes[name]["element"].kind
    inward, outward = graph.in_degree(name), graph.out_degree(name)
    count = inward + outward
    if kind in TWO_PORTS and (inward, outward) != (1, 1):
        raise StructureError(
            f"{kind} {name!r} has {inward} bond(s) in and {outward} out; it needs one in and one out"
        )
    if kind in JUNCTIONS and count == 0:
        raise StructureError(f"junction {name!r} has no bonds; bond it or remove it")
    if kind not in JUNCTIONS and kind not in TWO_PORTS and count != 1:
        raise StructureError(
            f"{kind} {name!r} has {count} bonds; it needs exactly one"
            + ("; put a junction between" if count else "; bond it or remove it")
        )


def _element(name: Hashable, attributes: Mapping[str, Any]) -> Element:
    if isinstance(name, bool) or not isinstance(name, str | int):
        raise StructureError(f"node {name!r}: a node's name must be a text or an integer")
    where = f"node {name!r}"
    kind = _kind(attributes, where)
    _check_keys(kind, attributes, where)
    unit = attributes.get("unit")
    if unit is not None and not isinstance(unit, str):
        raise StructureError(f"{where}: unit {unit!r} must be a text")
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
    valued, lawful = (attributes.get(key) is not None for key in ("value", "law"))
    if valued and lawful:
        raise StructureError(f"{where} has both a value and a law; give one of them")
    if kind in STORAGES and not valued and not lawful:
        raise StructureError(f"{where} has no value; give a number, a name, an expression or a law")
    gives = _gives(kind, attributes, where, valued)
    return Element(
        name,
        kind,
        _value(attributes, where) if valued else None,
        _name(attributes, "effort", name),
        _name(attributes, "flow", name),
        law=_law(name, kind, attributes["law"], gives) if lawful else None,
        priority=_priority(attributes, where),
        gives=gives,
        unit=unit,
    )


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
