"""Names and numbers: parameters that nothing reads, and those that were nearly given."""

from collections.abc import Hashable, Iterator, Mapping
from typing import Any

import networkx as nx

from bondgraph.algebra.expressions import TIME
from bondgraph.checking.records import Finding
from bondgraph.declare.quantities import quantities
from bondgraph.declare.renaming import names_read
from bondgraph.declare.validate import validate
from bondgraph.errors import StructureError, nearest


def validated(graph: Any) -> "nx.DiGraph[Hashable]":
    """The checked copy of a declared graph; `StructureError` for one that is a checked copy itself."""
    found = validate(graph)
    if found is graph:
        raise StructureError(
            "this is the checked copy that validate made; give the graph as it was declared"
        )
    return found


def signals_named(graph: Any) -> set[str]:
    """Every name of an effort, a flow, a state or an input that the graph's nodes have."""
    found: set[str] = set()
    for name, attributes in graph.nodes(data=True):
        for begin, ending, given in quantities(name, attributes):
            found.add(f"{begin}{name}{ending}" if given is None else given)
    return found


def parameters_doubted(graph: Any, parameters: Mapping[str, object]) -> Iterator[Finding]:
    """Numbers that nothing reads, with the name that was meant where one is near."""
    signals = signals_named(graph)
    read = names_read(graph) - signals - {TIME.name}
    open_names = sorted(read - parameters.keys())
    for name in parameters:
        if name in read:
            continue
        if name in signals:
            yield Finding(
                "doubt", "parameter", f"{name} is a signal of the graph, not a parameter",
                "give a state its start as start= or in initial=, an input its signal in inputs=",
            )  # fmt: skip
        else:
            near = nearest(name, open_names)
            yield Finding(
                "doubt", "parameter", f"no value or law reads the parameter {name}",
                f"correct its name{near}" if near else "leave it out, or let a value read it",
            )  # fmt: skip
