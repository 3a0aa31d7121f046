"""`assign_causality`: strokes by trial and propagation, each with its reason; refusals told as a story."""

from collections.abc import Collection, Hashable
from types import MappingProxyType
from typing import Any

import networkx as nx

from bondgraph.causality.causal_graph import CausalGraph
from bondgraph.causality.freed import fewest_turned, storages_freed, wanting
from bondgraph.causality.record import Contradiction, Reason
from bondgraph.causality.regularity import regular_ports
from bondgraph.causality.signals import causal_equations, causal_groups, loop_rows
from bondgraph.causality.stories import contradiction_story
from bondgraph.causality.strokes import StrokeSearch
from bondgraph.causality.vanishing import elements_in, generic, told
from bondgraph.declare.validate import validate, with_elements
from bondgraph.errors import (
    AlgebraicLoopError,
    BondGraphError,
    CausalityError,
    StructureError,
    nearest,
)
from bondgraph.nodes.elements import OTHER

TRIALS_PER_BOND = 20
"""Beyond this the search for strokes stops and exact rank decides the ports first."""


def assign_causality(graph: Any, derivative: bool | Collection[Hashable] = False) -> CausalGraph:
    """Give every bond its causal stroke; storages get integral causality wherever that is possible.

    Order: sources and ports of fixed causality; storages by ``priority``, then declaration; dry friction;
    switches and linear resistances; what is left. Accepts a declared or a validated graph.

    Raises `CausalityError` when sources and fixed ports contradict each other, `AlgebraicLoopError`
    when the structure is singular under every causality. Where laws contradict each other, those that can
    be turned round are: of storages, which then may have derivative causality, and of resistances, these
    also where they impose what a storage keeps. Both are genuine: a graph is
    refused only if the determinant of its bond equations vanishes identically. A switch has one causality
    for all of its modes: it gives zero in one, and in the other whatever keeps at zero what it receives.

    ``derivative``: True prefers derivative causality of all storages, names that of some, tried before
    the others. Those that stay integral all the same are as many as the state matrix lacks in rank; where
    none does, constant inputs determine where all rests. Such strokes are to be looked at; a graph whose
    storages wait for resistances has no state equations in them, and `state_equations` refuses.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("push", "F"), bg.One("mass"), bg.I("m", "m"), bg.R("drag", "b")])
    >>> g.add_edges_from([("push", "mass"), ("mass", "m"), ("mass", "drag")])
    >>> assign_causality(g).integral, assign_causality(g, derivative=True).integral
    (('m',), ())
    """
    checked = validate(graph)
    if derivative is not False:
        return _assigned(checked, asked_derivative(checked, derivative))
    try:
        found = _assigned(checked)
    except AlgebraicLoopError as error:
        raise AlgebraicLoopError(f"{error}{_vanishing(checked)}") from None
    except CausalityError as error:
        turned = storages_freed(checked)
        freed = with_elements(checked, turned)
        other = _with_fewest(freed, _tried(freed) if turned else None)
        if other is None:
            raise CausalityError(f"{error}{wanting(checked, str(error), turned)}") from None
        return other
    return _with_fewest(checked, found) or found


def asked_derivative(
    checked: "nx.DiGraph[Hashable]", derivative: bool | Collection[Hashable]
) -> frozenset[Hashable]:
    """The storages of a validated graph, a field's ports each, that should have derivative causality.

    Raises `StructureError` for what is no list of the graph's storages.
    """
    if derivative is False:
        return frozenset()
    storages = [name for name in checked if checked.nodes[name]["element"].kind.stores]
    owners = [checked.nodes[name]["element"].owner for name in storages]
    if derivative is True:
        return frozenset(storages)
    if isinstance(derivative, str) or not isinstance(derivative, Collection):
        raise StructureError(f"derivative must be True or a list of storages, not {derivative!r}")
    for name in derivative:
        if name not in storages and name not in owners:
            raise StructureError(
                f"derivative: {name!r} is no storage of the graph{nearest(str(name), map(str, storages))}"
            )
    pairs = zip(storages, owners, strict=True)
    return frozenset(name for name, owner in pairs if name in derivative or owner in derivative)


def _with_fewest(graph: "nx.DiGraph[Hashable]", found: CausalGraph | None) -> CausalGraph | None:
    """The strokes with laws of resistances turned round where these impose what a storage keeps."""
    if found is not None and not found.derivative:
        return found
    return fewest_turned(graph, _tried, found) or found


def _tried(graph: "nx.DiGraph[Hashable]") -> CausalGraph | None:
    """The graph whose laws go either way, if that resolves what contradicted."""
    try:
        return _assigned(graph)
    except (AlgebraicLoopError, CausalityError):
        return None


def _assigned(
    checked: "nx.DiGraph[Hashable]", derivative: frozenset[Hashable] = frozenset()
) -> CausalGraph:
    strokes = StrokeSearch(checked)
    order, preferred = preferences(strokes, derivative)
    _impose_fixed(strokes, order)
    found = complete(strokes, order, preferred)
    # By strokes alone a switch may come to drive a dependent storage; by exact rank it never does, as
    # a storage is dependent only on what comes before it.
    if not found or _has_loop(strokes) or _switches_beside_dependent(strokes):
        chosen = regular_ports(strokes.found, order, preferred)
        if not found or any(strokes.gives(node) != gives for node, gives in chosen.items()):
            _search_with(strokes, order, preferred, chosen)
    return _causal_graph(checked, strokes)


def _vanishing(checked: "nx.DiGraph[Hashable]") -> str:
    """The determinant that vanishes: of a loop of a causality that the graph has with other ratios."""
    made, values = generic({n: e for n, e in elements_in(checked).items() if e.kind.two_port})
    try:
        equations = causal_equations(_assigned(with_elements(checked, made)).assignment)
    except BondGraphError:
        return "; so it is with any ratios"
    for group in causal_groups(equations.terms):
        text = told(loop_rows(equations, group), values) if len(group) > 1 else None
        if text is not None:
            return f"; {text}"
    return ""


def preferences(
    strokes: StrokeSearch, derivative: frozenset[Hashable] = frozenset()
) -> tuple[list[int], dict[int, str]]:
    """The one-ports in the order of their importance, and what each should give.

    ``derivative``: the storages that should have derivative causality; they come before others.
    """
    preferred: dict[int, str] = {}
    ranks: dict[int, tuple[int, float, int]] = {}
    for node, element in enumerate(strokes.elements):
        if not element.one_port:
            continue
        if element.gives is not None:
            preferred[node] = element.gives
            ranks[node] = (0 if element.kind.supplies else 1, 0, node)
        elif element.kind.stores:
            asked = strokes.names[node] in derivative
            preferred[node] = OTHER[element.kind.gives] if asked else element.kind.gives
            ranks[node] = (2 if asked else 3, -element.priority, node)
        else:
            preferred[node] = element.switch.gives if element.switch else "effort"
            ranks[node] = (4 if element.law else 5, 0, node)
    return sorted(ranks, key=ranks.__getitem__), preferred


def _impose_fixed(strokes: StrokeSearch, order: list[int]) -> None:
    for node in order:
        gives = strokes.elements[node].gives
        if gives is None:
            return
        reason = Reason(node, f"imposes its {gives}")
        conflict = strokes.assign(strokes.at[node][0], strokes.end_for(node, gives), reason)
        if conflict:
            raise CausalityError(contradiction_story(strokes.found, conflict))


def complete(strokes: StrokeSearch, order: list[int], preferred: dict[int, str]) -> bool:
    """Complete the strokes by trials that backtrack; False if there is no way or it takes too long."""
    items = [(strokes.at[node][0], strokes.end_for(node, preferred[node]), node) for node in order]
    items += [(bond, head, tail) for bond, (tail, head) in enumerate(strokes.bonds)]
    limit = TRIALS_PER_BOND * len(strokes.bonds) + 1_000
    open_choices: list[tuple[int, int]] = []
    at = trials = 0
    while at < len(items):
        if strokes.end[items[at][0]] is None:
            trials += 1
            length = len(strokes.trail)
            conflict = _try(strokes, items[at])
            if conflict is None:
                open_choices.append((at, length))
            elif _try_other(strokes, items[at], conflict):
                turned = _turn_back(strokes, items, open_choices)
                if turned is None or trials > limit:
                    return False
                at = turned
        at += 1
    return True


Choice = tuple[int, int, int]
"""A bond, the end its stroke should lie at, and the node that wants it there."""


def _try(strokes: StrokeSearch, choice: Choice) -> Contradiction | None:
    """Set the preferred stroke and all that follows; on a contradiction leave no trace and tell it."""
    bond, end, node = choice
    kind = strokes.elements[node].kind
    text = "is free to choose"
    if kind.stores:
        integral = end == strokes.end_for(node, kind.gives)
        text = f"is tried in {'integral' if integral else 'derivative'} causality first"
    return _assign_or_undo(strokes, bond, end, Reason(node, text))


def _try_other(
    strokes: StrokeSearch, choice: Choice, conflict: Contradiction | None
) -> Contradiction | None:
    """The same for the other side of a choice, whose preferred side met a conflict, if it is known."""
    bond, end, node = choice
    text = "takes the other causality, since its first choice leads to a contradiction further on"
    if conflict is not None:
        name = strokes.names[conflict.node]
        text = f"cannot have its preferred causality: {name!r} {conflict.text}"
    return _assign_or_undo(strokes, bond, strokes.other(bond, end), Reason(node, text))


def _assign_or_undo(
    strokes: StrokeSearch, bond: int, end: int, reason: Reason
) -> Contradiction | None:
    length = len(strokes.trail)
    conflict = strokes.assign(bond, end, reason)
    if conflict is not None:
        strokes.undo(length)
    return conflict


def _turn_back(
    strokes: StrokeSearch, items: list[Choice], open_choices: list[tuple[int, int]]
) -> int | None:
    """Take the other side of the last open choice where that works, and tell which choice it was."""
    while open_choices:
        at, length = open_choices.pop()
        strokes.undo(length)
        if _try_other(strokes, items[at], None) is None:
            return at
    return None


def _has_loop(strokes: StrokeSearch) -> bool:
    return any(len(group) > 1 for group in causal_groups(causal_equations(strokes.found).terms))


def _switches_beside_dependent(strokes: StrokeSearch) -> bool:
    elements = strokes.elements
    dependent = any(
        element.kind.stores and strokes.gives(node) != element.kind.gives
        for node, element in enumerate(elements)
    )
    return dependent and any(element.lets_go for element in elements)


def _search_with(
    strokes: StrokeSearch, order: list[int], preferred: dict[int, str], chosen: dict[int, str]
) -> None:
    """Strokes again, with every port's causality given."""
    strokes.undo(0)
    conflict: Contradiction | None = None
    for node in order:
        if node not in chosen:
            continue
        text = f"gives its {chosen[node]}: otherwise its loop would be singular"
        if strokes.elements[node].gives is not None:
            text = f"imposes its {chosen[node]}"
        end = strokes.end_for(node, chosen[node])
        conflict = conflict or strokes.assign(strokes.at[node][0], end, Reason(node, text))
    if conflict or not complete(strokes, order, preferred | chosen):
        raise CausalityError(
            "no complete set of causal strokes was found, though the equations are regular; "
            "please report this graph"
        )


def _causal_graph(graph: "nx.DiGraph[Hashable]", strokes: StrokeSearch) -> CausalGraph:
    declared = nx.get_edge_attributes(graph, "declared")
    storages = {
        strokes.names[node]: strokes.gives(node) == (element.kind.gives)
        for node, element in enumerate(strokes.elements)
        if element.kind.stores
    }
    owners = [element.owner or strokes.names[at] for at, element in enumerate(strokes.elements)]
    ends = [owners[end] for end in strokes.end if end is not None]
    return CausalGraph(
        graph=graph,
        strokes=MappingProxyType(dict(zip(declared.values(), ends, strict=True))),
        integral=tuple(name for name, integral in storages.items() if integral),
        derivative=tuple(name for name, integral in storages.items() if not integral),
        assignment=strokes.found,
    )
