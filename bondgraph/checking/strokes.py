"""Drawn strokes judged one by one: right, wrong, possible but not preferred, or missing."""

from collections.abc import Collection, Hashable, Iterator, Mapping
from dataclasses import dataclass, replace

from bondgraph.algebra.exact import determinant
from bondgraph.algebra.residues import is_zero
from bondgraph.causality.assign import assign_causality, complete, preferences
from bondgraph.causality.causal_graph import CausalGraph
from bondgraph.causality.record import Contradiction, Reason
from bondgraph.causality.signals import causal_equations, causal_groups, loop_rows
from bondgraph.causality.strokes import StrokeSearch
from bondgraph.checking.drawn import Drawn
from bondgraph.checking.records import StrokeVerdict
from bondgraph.declare.validate import with_elements
from bondgraph.nodes.elements import OTHER, Bond


@dataclass(frozen=True)
class _Accepted:
    """Drawn strokes that agree with all rules, with all that follows; the others with what they break."""

    search: StrokeSearch
    broken: Mapping[int, tuple[int, str]]


Names = frozenset[Hashable]
"""Of storages whose derivative causality is preferred."""


def strokes_judged(
    causal: CausalGraph, bonds: Collection[Bond], drawn: Drawn, chosen: Names = frozenset()
) -> tuple[tuple[StrokeVerdict, ...], tuple[Hashable, ...]]:
    """A verdict for each of the bonds, in their order, and the nodes of a loop that has no solution.

    Where strokes contradict each other, those that agree with the preferred causality are believed: integral
    but of the storages that are ``chosen``.
    """
    first = _accepted(causal, drawn, chosen)
    best = _with_least(causal, _unpreferred(first.search, chosen), chosen)
    accepted = _accepted(best, drawn, chosen)
    needless = _needless(best, accepted.search, drawn, chosen)
    number = {bond: at for at, bond in enumerate(best.assignment.declared)}
    verdicts = [_verdict(best, accepted, needless, drawn, number[bond]) for bond in bonds]
    return tuple(verdicts), _unsolved(accepted)


def _with_least(causal: CausalGraph, others: Collection[int], chosen: Names) -> CausalGraph:
    """The causality with most storages as is preferred in which these come last: not so where any may be."""
    if not others:
        return causal
    strokes = causal.assignment
    lowest = min(element.priority for element in strokes.elements) - 1
    later = {
        strokes.names[node]: replace(strokes.elements[node], priority=lowest) for node in others
    }
    return assign_causality(with_elements(causal.graph, later), chosen or False)


def _unpreferred(search: StrokeSearch, chosen: Names) -> list[int]:
    """The storages that the strokes so far give another causality than is preferred: as a rule derivative."""
    return [
        node for node, element in enumerate(search.elements)
        if element.kind.stores and search.end[search.at[node][0]] is not None
        and (search.gives(node) != element.kind.gives) != (search.names[node] in chosen)
    ]  # fmt: skip


def _accepted(target: CausalGraph, drawn: Drawn, chosen: Names) -> _Accepted:
    """Set drawn strokes, those first that the target has, and tell what the others break."""
    search = StrokeSearch(target.graph)
    order, preferred = preferences(search, chosen)
    for node in order:
        gives = search.elements[node].gives
        if gives is not None:
            reason = Reason(node, f"imposes its {gives}")
            search.assign(search.at[node][0], search.end_for(node, gives), reason)
    ends = {b: _end(search, b, drawn[d]) for b, d in enumerate(search.declared) if d in drawn}
    broken: dict[int, tuple[int, str]] = {}
    for bond in sorted(ends, key=lambda b: (ends[b] != target.assignment.end[b], b)):
        found = _set(search, bond, ends[bond])
        if found is None and ends[bond] != target.assignment.end[bond]:
            found = _excluded(search, bond, order, preferred)
        if found is not None:
            broken[bond] = found
    return _Accepted(search, broken)


def _set(search: StrokeSearch, bond: int, end: int) -> tuple[int, str] | None:
    """Set one drawn stroke; the node and the rule that it breaks, if it breaks one."""
    if search.end[bond] is not None:
        reason = search.reason[bond]
        return None if search.end[bond] == end or reason is None else (reason.node, reason.text)
    length = len(search.trail)
    conflict: Contradiction | None = search.assign(bond, end, Reason(end, "is drawn so"))
    if conflict is None:
        return None
    search.undo(length)
    return conflict.node, conflict.text


def _excluded(
    search: StrokeSearch, bond: int, order: list[int], preferred: dict[int, str]
) -> tuple[int, str] | None:
    """Whether no strokes of the other bonds go with those that are set; the last is then taken back."""
    length = len(search.trail)
    possible = complete(search, order, preferred)
    search.undo(length)
    if possible:
        return None
    search.undo(search.trail.index(bond))
    return search.bonds[bond][1], "can have no complete strokes with this one and those before it"


def _end(search: StrokeSearch, bond: int, name: Hashable) -> int:
    """The number of a bond's end by the name of its node; a port's is its field's."""
    return next(
        n for n in search.bonds[bond] if (search.elements[n].owner or search.names[n]) == name
    )


def _needless(
    best: CausalGraph, search: StrokeSearch, drawn: Drawn, chosen: Names
) -> dict[int, int]:
    """Drawn bonds that keep a storage from the preferred causality that it could have, and the storage."""
    found: dict[int, int] = {}
    integral = set(best.integral)
    for node in _unpreferred(search, chosen):
        if (search.names[node] in integral) == (search.names[node] in chosen):
            continue
        bond = search.at[node][0]
        roots = [bond] if search.declared[bond] in drawn else list(_roots(search, bond))
        found |= {root: node for root in roots if root not in found}
    return found


def _roots(search: StrokeSearch, bond: int) -> Iterator[int]:
    """The drawn strokes from which a bond's stroke follows."""
    pending, seen = [bond], {bond}
    while pending:
        one = pending.pop()
        reason = search.reason[one]
        if reason is not None and reason.text == "is drawn so":
            yield one
        for cause in reason.causes if reason is not None else ():
            if cause not in seen:
                seen.add(cause)
                pending.append(cause)


def _verdict(
    best: CausalGraph, accepted: _Accepted, needless: Mapping[int, int], drawn: Drawn, bond: int
) -> StrokeVerdict:
    search = accepted.search
    declared = search.declared[bond]
    if declared not in drawn:
        return StrokeVerdict(declared, None, "missing", _missing(best, search, bond))
    end = drawn[declared]
    if bond in accepted.broken:
        node, rule = accepted.broken[bond]
        return StrokeVerdict(
            declared, end, "wrong", f"{_told(search, node)} {rule}", _name(search, node)
        )
    if bond in needless:
        node = needless[bond]
        has, other, gives = "derivative", "integral", search.elements[node].kind.gives
        if search.gives(node) == gives:
            has, other, gives = other, has, OTHER[gives]
        text = (
            f"{_told(search, node)} has {has} causality, though it could have {other}: receive the "
            f"{OTHER[gives]} and give the {gives}"
        )
        return StrokeVerdict(declared, end, "not preferred", text, _name(search, node))
    return StrokeVerdict(declared, end, "right", f"{end!r} receives the effort")


def _missing(best: CausalGraph, search: StrokeSearch, bond: int) -> str:
    """What follows for a bond without a stroke, or what would be preferred."""
    end, reason = search.end[bond], search.reason[bond]
    if end is not None and reason is not None:
        return f"it has to be at {_name(search, end)!r}: {_told(search, reason.node)} {reason.text}"
    chosen = best.assignment.end[bond]
    where = "" if chosen is None else f"; at {_name(search, chosen)!r} it would be preferred"
    return f"no stroke is drawn, and none follows yet{where}"


def _name(search: StrokeSearch, node: int) -> Hashable:
    return search.elements[node].owner or search.names[node]


def _told(search: StrokeSearch, node: int) -> str:
    return f"{search.elements[node].kind.word} {search.names[node]!r}"


def _unsolved(accepted: _Accepted) -> tuple[Hashable, ...]:
    """The nodes of a loop that complete strokes leave without a solution, though they break no rule."""
    search = accepted.search
    if accepted.broken or None in search.end:
        return ()
    equations = causal_equations(search.found)
    for group in causal_groups(equations.terms):
        if len(group) > 1 and is_zero(determinant(loop_rows(equations, group))):
            ends = (node for signal in group for node in search.bonds[signal // 2])
            return tuple(dict.fromkeys(_name(search, node) for node in ends))
    return ()
