"""Strokes and contradictions in words: chains of reasons, choices first."""

from collections.abc import Iterable

from bondgraph.causality.record import Contradiction, Reason, Strokes
from bondgraph.nodes.elements import OTHER

LONGEST_STORY = 12
"""Lines of a chain that are told; of a longer one the middle is counted only."""


def stroke_story(strokes: Strokes, node: int) -> tuple[str, ...]:
    """Why the bond of a node (its first, for a junction) has its stroke, one sentence a line."""
    return _shortened([_sentence(strokes, bond) for bond in _chain(strokes, [strokes.at[node][0]])])


def contradiction_story(strokes: Strokes, conflict: Contradiction) -> str:
    """Two chains of strokes that meet at one node, and what to change."""
    chain = _chain(strokes, conflict.bonds)
    roots = [strokes.reason[bond] for bond in chain]
    nodes = [reason.node for reason in roots if reason is not None and not reason.causes]
    if conflict.attempt is not None and not conflict.attempt.causes:
        nodes.append(conflict.attempt.node)
    nodes = sorted(set(nodes))
    lines = list(_shortened([_sentence(strokes, bond) for bond in chain]))
    lines.append(_final(strokes, conflict))
    return (
        f"{_headline(strokes, conflict, nodes)}: {'; '.join(lines)}. "
        "Remove one of them, or put a storage, a resistance or a junction of the other kind between"
        f"{_other_way(strokes, nodes)}"
    )


def _other_way(strokes: Strokes, nodes: list[int]) -> str:
    """That an open port may give its other variable, where the last that imposes is one."""
    element = strokes.elements[nodes[-1]]
    if not element.kind.resists or element.law is not None or element.gives is None:
        return ""
    other = OTHER[element.gives]
    return f", or let the open port {element.name!r} give its {other} (gives={other!r})"


def _headline(strokes: Strokes, conflict: Contradiction, nodes: list[int]) -> str:
    names = [repr(strokes.names[node]) for node in nodes]
    if all(strokes.elements[node].kind.supplies for node in nodes):
        who = "source" if len(nodes) == 1 else "sources"
    else:
        who = "node" if len(nodes) == 1 else "nodes"
    listed = names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
    place = _junction_of(strokes, conflict)
    if len(nodes) != 2 or place is None:
        verb = "imposes what its" if len(nodes) == 1 else "impose what their"
        return f"{who} {listed} {verb} surroundings exclude"
    zero = strokes.elements[place].kind.common == "effort"
    what, digit = ("effort", 0) if zero else ("flow", 1)
    return f"{who} {listed} both impose the {what} of {digit}-junction {strokes.names[place]!r}"


def _junction_of(strokes: Strokes, conflict: Contradiction) -> int | None:
    """The junction at which two efforts (0) or two flows (1) meet."""
    forced_by = strokes.reason[conflict.bonds[0]]
    places = [conflict.node] + ([forced_by.node] if forced_by is not None else [])
    junctions = [p for p in places if strokes.elements[p].kind.joins]
    return junctions[0] if junctions else None


def _chain(strokes: Strokes, bonds: Iterable[int]) -> list[int]:
    """All bonds whose strokes these follow from, and these, in the order they were set."""
    seen: set[int] = set()
    pending = list(bonds)
    while pending:
        bond = pending.pop()
        reason = strokes.reason[bond]
        if bond in seen or reason is None:
            continue
        seen.add(bond)
        pending.extend(reason.causes)
    position = {bond: at for at, bond in enumerate(strokes.trail)}
    return sorted(seen, key=position.__getitem__)


def _sentence(strokes: Strokes, bond: int) -> str:
    reason = strokes.reason[bond]
    if reason is None:
        return ""
    tail, head = strokes.declared[bond]
    end = strokes.end[bond]
    receiver = strokes.names[end] if end is not None else None
    return (
        f"{_subject(strokes, reason)}, so on bond {tail!r} -> {head!r} "
        f"{receiver!r} receives the effort"
    )


def _subject(strokes: Strokes, reason: Reason) -> str:
    return f"{strokes.elements[reason.node].kind} {strokes.names[reason.node]!r} {reason.text}"


def _final(strokes: Strokes, conflict: Contradiction) -> str:
    kind = strokes.elements[conflict.node].kind
    return f"but {kind} {strokes.names[conflict.node]!r} {conflict.text}"


def _shortened(lines: list[str]) -> tuple[str, ...]:
    if len(lines) <= LONGEST_STORY:
        return tuple(lines)
    half = LONGEST_STORY // 2
    return (*lines[:half], f"... ({len(lines) - 2 * half} more strokes)", *lines[-half:])


def deciding_nodes(strokes: Strokes, node: int) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """The nodes behind the stroke of a node's first bond: those that chose, and those that passed it on."""
    chain = _chain(strokes, [strokes.at[node][0]])
    reasons = [reason for bond in chain if (reason := strokes.reason[bond]) is not None]
    chose = dict.fromkeys(reason.node for reason in reasons if not reason.causes)
    passed = dict.fromkeys(reason.node for reason in reasons if reason.causes)
    return tuple(chose), tuple(passed)
