"""`check`: a graph judged as a teacher would, with the way out of each finding."""

from collections.abc import Iterator, Mapping
from typing import Any

from bondgraph.causality.assign import assign_causality
from bondgraph.checking.arrows import arrows_doubted
from bondgraph.checking.names import parameters_doubted
from bondgraph.checking.records import Check, Finding
from bondgraph.checking.shapes import junctions_doubted, junctions_simpler
from bondgraph.declare.tables import with_tables
from bondgraph.declare.validate import validate
from bondgraph.errors import AlgebraicLoopError, CausalityError


def check(graph: Any, parameters: Mapping[str, object] | None = None) -> Check:
    """What is to be asked about a declared graph: most likely mistakes first, then what could be simpler.

    Doubts: numbers in ``parameters`` that nothing reads; junctions of one bond;
    arrows out of storages and resistances, into every source, and such that a sum stands where a
    difference is meant; sources that contradict each other. Hints: junctions that `merged` takes out.

    Raises `StructureError` for what is not a bond graph.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("push", "F"), bg.One("mass"), bg.I("m", "m"), bg.R("damper", "b")])
    >>> g.add_edges_from([("push", "mass"), ("mass", "m"), ("mass", "damper")])
    >>> len(bg.check(g, parameters={"m": 2, "b": 0.5}))
    0
    >>> print(bg.check(g, parameters={"m": 2, "bb": 0.5}))
    doubt (parameter): no value or law reads the parameter bb; correct its name (did you mean 'b'?)
    """
    checked = validate(graph)
    findings = [
        *(parameters_doubted(with_tables(graph), parameters) if parameters is not None else ()),
        *junctions_doubted(checked),
        *arrows_doubted(checked),
        *_causality_doubted(checked),
        *junctions_simpler(graph),
    ]
    return Check(tuple(findings))


def _causality_doubted(checked: Any) -> Iterator[Finding]:
    """The contradiction for which no causality can be assigned."""
    try:
        assign_causality(checked)
    except (CausalityError, AlgebraicLoopError) as error:
        story, stop, way_out = str(error).rpartition(". ")
        if not stop:
            story, way_out = str(error), "open the loop, or put an element on it"
        yield Finding("doubt", "causality", story, way_out[:1].lower() + way_out[1:])
