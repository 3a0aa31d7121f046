"""Plain data of a file, of which nothing is certain, become a validated graph."""

from collections.abc import Hashable, Iterable, Mapping
from typing import Any

import networkx as nx

from bondgraph.algebra.atoms import symbol
from bondgraph.algebra.expressions import expression
from bondgraph.declare.drawn import BondGraph
from bondgraph.declare.tables import TABLES, tables_of
from bondgraph.declare.validate import validate
from bondgraph.errors import BondGraphError, FileFormatError
from bondgraph.files.declarations import FRICTION, Declaration, check_text
from bondgraph.files.tables import restored_table
from bondgraph.nodes.kinds import EXPRESSIONS, INSTANTS, NAMED
from bondgraph.nodes.laws import DryFriction, ExpressionLaw
from bondgraph.tables.record import Sampled

SCALARS = (str, int, float)
TYPES: Mapping[str, tuple[type, ...]] = {
    **dict.fromkeys((*EXPRESSIONS, *INSTANTS), SCALARS),
    **dict.fromkeys(NAMED, (dict,)),
    "value": (*SCALARS, list),
    "law": (*SCALARS, dict),
    "start": (*SCALARS, dict),
    "priority": (int, float),
    "effort": (str, dict),
    "flow": (str, dict),
    "gives": (str, dict),
    "ports": (list,),
    "reads": (list,),
    "modes": (list,),
    "reset": (dict,),
}
"""What a file may hold for an attribute; where nothing is said here, a text."""

OWN_STATE = frozenset({"expression", "state"})


def restored(declaration: Declaration, tables: Iterable[Sampled] = ()) -> "nx.DiGraph[Hashable]":
    """The graph of a declaration that came from a file, validated.

    ``tables``: given with it, beside those that it has.

    Raises `FileFormatError` for attributes of a wrong type, nodes and bonds that come twice and bonds
    to nodes that are not there, and what `validate` raises.
    """
    graph = BondGraph()
    if declaration.name is not None:
        check_type(declaration.name, (str,), "the graph's name")
        graph.graph["name"] = declaration.name
    own = [restored_table(parts, f"tables[{at}]") for at, parts in enumerate(declaration.tables)]
    known = tables_of(nx.DiGraph(tables=[*own, *tables]))
    graph.graph.update({TABLES: list(known)} if known else {})
    for name, attributes in declaration.nodes:
        check_type(name, (str, int), "the id of a node")
        if name in graph:
            raise FileFormatError(f"node {name!r} is there twice; give each node an id of its own")
        graph.add_node(name)
        graph.nodes[name].update(_attributes(attributes, f"node {name!r}", known))
    for tail, head, attributes in declaration.bonds:
        for end in (tail, head):
            check_type(end, (str, int), "the end of a bond")
            if end not in graph:
                raise FileFormatError(f"bond {tail!r} -> {head!r}: there is no node {end!r}")
        where = f"bond {tail!r} -> {head!r}"
        if graph.has_edge(tail, head):
            raise FileFormatError(f"{where} is there twice; keep one")
        graph.add_edge(tail, head)
        graph.edges[tail, head].update(_attributes(attributes, where, ()))
    validate(graph)
    return graph


def check_type(value: object, types: Iterable[type], where: str) -> None:
    """Refuse a value that is of none of the types; true and false are no numbers.

    >>> check_type(True, (int,), "version")
    Traceback (most recent call last):
    bondgraph.errors.FileFormatError: version: True must be of type int
    """
    if type(value) not in types:
        allowed = ", ".join(one.__name__ for one in types)
        text = repr(value) if isinstance(value, SCALARS) else f"a {type(value).__name__}"
        short = text if len(text) <= 60 else text[:57] + "..."
        raise FileFormatError(f"{where}: {short} must be of type {allowed}")
    check_text(value, where)


def _attributes(
    attributes: Mapping[str, Any], where: str, tables: tuple[Sampled, ...]
) -> dict[str, Any]:
    """The attributes, checked for their types; a law of parts becomes a law."""
    result = {}
    for key, value in attributes.items():
        place = f"{where}, {key[:60]}"
        check_text(key, where)
        check_type(value, TYPES.get(key, (str,)), place)
        if isinstance(value, list):
            _check_list(value, place, rows=key == "value")
        elif key == "reset":
            _check_reset(value, place)
        elif key == "start" and isinstance(value, dict):
            _check_entries(value, f"{place} at")
        elif key in NAMED:
            _check_entries(value, f"{place} of")
        elif isinstance(value, dict) and key != "law":
            _check_list([*value, *value.values()], place, rows=False)
        result[key] = value
        if key == "law" and isinstance(value, dict):
            made = _laws if "ports" in attributes else _law
            result[key] = made(value, place, tables)
    return result


def _check_entries(told: Mapping[str, Any], where: str) -> None:
    """Refuse what does not map names to numbers and texts: of ports, of states, of what is given."""
    for name, value in told.items():
        check_type(name, (str,), where)
        check_type(value, SCALARS, f"{where} {name[:60]}")


def _laws(parts: Mapping[str, Any], where: str, tables: tuple[Sampled, ...]) -> dict[str, Any]:
    """The laws of a resistance with several ports."""
    for port, value in parts.items():
        check_type(port, (str,), where)
        check_type(value, (*SCALARS, dict), f"{where} at {port[:60]}")
    return {
        port: _law(value, f"{where} at {port[:60]}", tables) if isinstance(value, dict) else value
        for port, value in parts.items()
    }


def _check_list(values: Iterable[Any], where: str, rows: bool) -> None:
    """Refuse what is not a list of names or, with ``rows``, of lists of numbers and texts."""
    for value in values:
        check_type(value, (list,) if rows else (str,), where)
        for entry in value if rows else ():
            check_type(entry, SCALARS, where)


def _check_reset(states: Mapping[str, Any], where: str) -> None:
    """Refuse what is neither what states become nor that of each event."""
    for name, value in states.items():
        check_type(name, (str,), where)
        check_type(value, (*SCALARS, dict), f"{where} of {name[:60]}")
        for state, told in value.items() if isinstance(value, dict) else ():
            check_type(state, (str,), where)
            check_type(told, SCALARS, f"{where} of {state[:60]}")


def _law(
    parts: Mapping[str, Any], where: str, tables: tuple[Sampled, ...]
) -> DryFriction | ExpressionLaw:
    for key, value in parts.items():
        check_type(value, SCALARS, f"{where}, {key[:60]}")
    try:
        if set(parts) == OWN_STATE:
            state = symbol(parts["state"], where)
            return ExpressionLaw(expression(parts["expression"], where, tables), state)
        if "level" in parts and set(parts) <= {*FRICTION}:
            return DryFriction(**parts, tables=tables)
    except BondGraphError as error:
        text = str(error)
        raise type(error)(text if text.startswith(where) else f"{where}: {text}") from None
    raise FileFormatError(
        f"{where}: a law of parts has level, curve and breakaway, or expression and state, "
        f"not {', '.join(sorted(parts))[:60] or 'nothing'}"
    )
