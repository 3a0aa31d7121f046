"""The modes of state machines in what is told of a mode: each is a value of a state."""

from collections.abc import Mapping, Sequence
from typing import Any

import sympy as sp

from bondgraph.errors import StructureError, nearest
from bondgraph.nodes.tasks import Machine


def told_numbers(
    machines: Sequence[Machine], mode: Any, point: Mapping[Any, Any] | None
) -> tuple[Any, Any]:
    """The rest of ``mode``, and ``point`` with the number of each mode that a machine was told to be in.

    What is no mapping is left to whoever looks at it.

    Raises `StructureError` for a mode that a machine does not have, and where ``point`` says another number.
    """
    if not isinstance(mode, Mapping) or not isinstance(point, Mapping | None):
        return mode, point
    found = {} if point is None else dict(point)
    known = {one.name: one for one in machines}
    for name, word in mode.items():
        machine = known.get(name)
        if machine is None:
            continue
        if word not in machine.modes:
            raise StructureError(
                f"mode: {name!r} is never in {word!r}{nearest(str(word), machine.modes)}; it is in one of "
                f"{', '.join(machine.modes)}"
            )
        number = machine.modes.index(word)
        told = found.setdefault(_key(found, machine), number)
        if told != number:
            raise StructureError(
                f"mode: {name!r} is in {word!r}, number {number}, but {name} is told as {told}; leave one out"
            )
    return {name: word for name, word in mode.items() if name not in known}, found


def _key(point: Mapping[Any, Any], machine: Machine) -> sp.Symbol | str:
    """What the mode's number stands under: its name, or its symbol where that is there."""
    return machine.number if machine.number in point else str(machine.number)
