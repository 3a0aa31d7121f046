"""`check`: a graph judged as a teacher would, with the way out of each finding."""

from collections.abc import Collection, Hashable, Iterator, Mapping
from typing import Any

from bondgraph.causality.assign import asked_derivative, assign_causality
from bondgraph.causality.causal_graph import CausalGraph
from bondgraph.checking.arrows import arrows_doubted
from bondgraph.checking.drawn import strokes_drawn
from bondgraph.checking.names import parameters_doubted, validated
from bondgraph.checking.reached import modes_doubted
from bondgraph.checking.records import Check, Finding, StrokeVerdict
from bondgraph.checking.shapes import junctions_doubted, junctions_simpler
from bondgraph.checking.strokes import strokes_judged
from bondgraph.declare.tables import with_tables
from bondgraph.declare.wires import is_wire
from bondgraph.errors import AlgebraicLoopError, CausalityError
from bondgraph.nodes.elements import Bond


def check(
    graph: Any, parameters: Mapping[str, object] | None = None,
    strokes: Mapping[Bond, Hashable] | None = None, derivative: bool | Collection[Hashable] = False,
) -> Check:  # fmt: skip
    """What is to be asked about a declared graph: most likely mistakes first, then what could be simpler.

    Doubts: numbers in ``parameters`` that nothing reads; junctions of one bond; arrows out of storages and
    resistances, into every source, and such that a sum stands where a difference is meant; modes of state
    machines that no transition leads to; sources that contradict each other; drawn strokes that are wrong,
    or take integral causality from a storage that could have it. Hints: bonds without a stroke where others
    have one; junctions that `merged` takes out.

    ``strokes``: bonds, as declared, to the node at whose end a causal stroke was drawn, as in
    `CausalGraph.strokes`; or ``stroke="tail"`` or ``"head"`` as attribute of a bond. Where they contradict
    each other, those that agree with the preferred causality are believed. ``derivative``: as of
    `assign_causality`, True for all storages or names of some, whose derivative causality is preferred; a
    hint names those that keep integral causality all the same.

    Raises `StructureError` for what is not a bond graph, for strokes of bonds and names of storages that are
    not there.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("push", "F"), bg.One("mass"), bg.I("m", "m"), bg.R("damper", "b")])
    >>> g.add_edges_from([("push", "mass"), ("mass", "m"), ("mass", "damper")])
    >>> len(bg.check(g, parameters={"m": 2, "b": 0.5}))
    0
    >>> print(bg.check(g, parameters={"m": 2, "bb": 0.5}))
    doubt (parameter): no value or law reads the parameter bb; correct its name (did you mean 'b'?)
    >>> for one in bg.check(g, strokes={("push", "mass"): "push", ("mass", "m"): "m"}).strokes:
    ...     print(one)
    [WRONG] push -> mass, stroke at push: Se 'push' imposes its effort
    [ok] mass -> m, stroke at m: 'm' receives the effort
    [open] mass -> damper: it has to be at 'mass': 1-junction 'mass' takes its flow from one bond only
    """
    checked = validated(graph)
    drawn = strokes_drawn(graph, strokes)
    chosen = asked_derivative(checked, derivative)
    causal, refusals = _causality(checked, chosen)
    verdicts: tuple[StrokeVerdict, ...] = ()
    loop: tuple[Hashable, ...] = ()
    if drawn and causal is not None:
        bonds = [edge for edge in graph.edges if not is_wire(graph, *edge)]
        verdicts, loop = strokes_judged(causal, bonds, drawn, chosen)
    findings = [
        *(parameters_doubted(with_tables(graph), parameters) if parameters is not None else ()),
        *junctions_doubted(checked),
        *arrows_doubted(checked),
        *modes_doubted(checked),
        *refusals,
        *_strokes_doubted(verdicts, loop),
        *(() if causal is None else _kept_integral(causal, chosen)),
        *junctions_simpler(graph),
    ]
    return Check(tuple(findings), verdicts)


def _causality(
    checked: Any, chosen: frozenset[Hashable]
) -> tuple[CausalGraph | None, tuple[Finding, ...]]:
    """The causal graph, or the contradiction for which there is none."""
    try:
        return assign_causality(checked, chosen or False), ()
    except (CausalityError, AlgebraicLoopError) as error:
        story, stop, way_out = str(error).rpartition(". ")
        if not stop:
            story, way_out = str(error), "open the loop, or put an element on it"
        way_out = way_out[:1].lower() + way_out[1:]
        return None, (Finding("doubt", "causality", story, way_out),)


def _kept_integral(causal: CausalGraph, chosen: frozenset[Hashable]) -> Iterator[Finding]:
    """Storages that should have derivative causality and cannot."""
    kept = [name for name in causal.integral if name in chosen]
    if kept:
        named = ", ".join(map(repr, kept))
        yield Finding(
            "hint", "causality", f"{named}: integral causality even where derivative is preferred",
            "nothing else determines what they hold; a resistance or a source beside them would", kept[0],
        )  # fmt: skip


def _strokes_doubted(
    verdicts: tuple[StrokeVerdict, ...], loop: tuple[Hashable, ...]
) -> Iterator[Finding]:
    for one in verdicts:
        if one.verdict in ("wrong", "not preferred"):
            tail, head = one.bond
            other = head if one.end == tail else tail
            yield Finding(
                "doubt", "stroke", f"the stroke of {tail!r} -> {head!r} at {one.end!r}: {one.text}",
                f"draw it at {other!r}, and look at those that follow", one.node, one.bond,
            )  # fmt: skip
    if loop:
        yield Finding(
            "doubt", "stroke",
            f"the strokes break no rule, but {', '.join(map(repr, loop))} form a loop of bonds whose "
            "equations have no solution",
            "let another resistance or storage of the loop have its other causality", loop[0],
        )  # fmt: skip
    missing = [one.bond for one in verdicts if one.verdict == "missing"]
    if missing:
        named = ", ".join(f"{tail!r} -> {head!r}" for tail, head in missing)
        yield Finding(
            "hint", "stroke", f"without a stroke: {named}", "draw them, or ask `assign_causality`"
        )
