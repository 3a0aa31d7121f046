"""Tables that come with a graph: which there are, and attributes whose text calls them as expressions."""

import re
from collections.abc import Mapping, Sequence
from typing import Any

import networkx as nx
import sympy as sp

from bondgraph.algebra.expressions import callable_in_text, expression
from bondgraph.algebra.lookups import Handle
from bondgraph.errors import TableError
from bondgraph.nodes.kinds import EXPRESSIONS, NAMED
from bondgraph.nodes.laws import DryFriction, ExpressionLaw
from bondgraph.tables.record import Sampled

TABLES = "tables"
"""The graph attribute that holds them."""

READ = ("law", "reset", "reads", *EXPRESSIONS, *NAMED)
"""The attributes of a node that read names."""


def tables_of(graph: Any) -> tuple[Sampled, ...]:
    """The tables that a graph was given as ``networkx.DiGraph(tables=[...])``.

    Raises `TableError` for what is no table, and for two of one name.
    """
    given = graph.graph.get(TABLES)
    if given is None:
        return ()
    if isinstance(given, Sampled):
        given = [given]
    if isinstance(given, str | Mapping) or not isinstance(given, Sequence):
        raise TableError(
            f"graph attribute 'tables' must be a list of LookupTable objects, not {given!r}"
        )
    callable_in_text(given, "graph attribute 'tables'")
    return tuple({table.name: table for table in given}.values())


def tables_in(graph: Any) -> tuple[Sampled, ...]:
    """The tables that a graph was given, and those that its values and laws carry, by name.

    Raises `TableError` for two of one name.
    """
    found = list(tables_of(graph))
    for _, attributes in graph.nodes(data=True):
        found += sorted(_carried(list(attributes.values())), key=lambda table: table.name)
    callable_in_text(found, "graph")
    return tuple({table.name: table for table in found}.values())


def _carried(value: Any) -> set[Sampled]:
    if isinstance(value, sp.Basic | sp.MatrixBase):
        return {handle.table for handle in value.atoms(Handle)}
    if isinstance(value, ExpressionLaw):
        return _carried(value.expression)
    if isinstance(value, DryFriction):
        return _carried([value.level, value.curve, value.breakaway])
    if isinstance(value, Mapping):
        return _carried(list(value.values()))
    if isinstance(value, list | tuple):
        return set[Sampled]().union(*map(_carried, value))
    return set()


def with_calls(
    attributes: Mapping[str, Any], tables: Sequence[Sampled], where: str
) -> dict[str, Any]:
    """A node's attributes with expressions in place of texts that call a table; else as they were."""
    if not tables:
        return dict(attributes)
    names = "|".join(re.escape(table.name) for table in tables)
    calls = re.compile(rf"\b(?:{names})\s*\(")

    def read(value: Any, key: str) -> Any:
        if isinstance(value, str):
            return expression(value, f"{where}, {key}", tables) if calls.search(value) else value
        if isinstance(value, list | tuple):
            return type(value)(read(entry, key) for entry in value)
        if isinstance(value, Mapping):
            return {name: read(entry, key) for name, entry in value.items()}
        return value

    return {key: read(value, key) if key in READ else value for key, value in attributes.items()}


def with_tables(graph: Any) -> "nx.DiGraph[Any]":
    """The same graph, or a copy whose values and laws need no tables to be read."""
    tables = tables_of(graph)
    if not tables:
        return graph  # type: ignore[no-any-return]
    result: nx.DiGraph[Any] = nx.DiGraph(graph)
    for name, attributes in graph.nodes(data=True):
        result.nodes[name].update(with_calls(attributes, tables, f"node {name!r}"))
    return result
