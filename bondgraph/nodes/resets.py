"""What switches and stops set states to at their events, as a user writes it."""

from collections.abc import Mapping, Sequence
from typing import Any

import sympy as sp

from bondgraph.algebra.atoms import symbol
from bondgraph.algebra.expressions import expression
from bondgraph.errors import StructureError
from bondgraph.nodes.tasks import Reset


def resets_of(given: Any, where: str, events: Sequence[str]) -> tuple[Reset, ...]:
    """States by name with what each becomes at the first of these events; or the same event by event.

    Raises `StructureError` for what is neither.
    """
    if given is None:
        return ()
    if not isinstance(given, Mapping):
        raise StructureError(
            f"{where}: reset is {given!r}; it must map names of states to what they become"
        )
    if not any(isinstance(value, Mapping) for value in given.values()):
        return _at(given, where, events[0])
    for event, states in given.items():
        if event not in events or not isinstance(states, Mapping):
            raise StructureError(
                f"{where}: reset at {event!r}; there is {', '.join(map(repr, events))}, each with a mapping "
                "of names of states to what they become"
            )
    return tuple(one for event, states in given.items() for one in _at(states, where, event))


def _at(states: Mapping[Any, Any], where: str, event: str) -> tuple[Reset, ...]:
    """The resets of one event."""
    found: dict[sp.Symbol, Reset] = {}
    for name, value in states.items():
        text = name.name if isinstance(name, sp.Symbol) else name
        state = symbol(text, f"{where}, reset")
        if state in found:
            raise StructureError(f"{where}: {state} is reset twice at one event")
        found[state] = Reset(state, expression(value, f"{where}, reset of {state}"), event)
    return tuple(found.values())
