"""Names of what nodes of signals are made of: results give them where they are asked for, and list none."""

from collections.abc import Iterable

import sympy as sp

from bondgraph.nodes.elements import Element
from bondgraph.nodes.kinds import Kind


def inner_names(elements: Iterable[Element]) -> frozenset[str]:
    """What parts of nodes of signals give, receive, hold and switch, by name: what nobody declared.

    >>> from bondgraph.declare.declared import elements_of
    >>> sorted(inner_names(elements_of("u", {"kind": "Function", "value": "sin(t)"}).values()))
    ['f_u']
    """
    own = [one for one in elements if one.of_signals]
    told = {name for one in own for name in _declared(one)}
    found = {str(name) for one in own for name in (one.effort, one.flow) if name is not None}
    found |= {str(one.switch.name) for one in own if one.switch is not None}
    found |= {f"{one.kind.letter}_{one.name}".replace(".", "_") for one in own if one.kind.stores}
    return frozenset(found - {str(name) for name in told})


def _declared(part: Element) -> tuple[sp.Symbol | None, ...]:
    """A signal itself; of a state within bounds also the rate that equations name."""
    late = part.late is not None and part.name == part.whole
    if part.is_effort_told or part.is_function or late:
        return (part.effort,)
    if part.kind.stores:
        return (part.flow,)
    demand = part.declared is Kind.STATE and part.kind.supplies and part.name != part.whole
    return (part.integral, part.effort) if demand else (part.integral,)
