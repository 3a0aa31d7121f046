"""Participants as they are asked for: simulators and paths of units, and what is told of each."""

from collections.abc import Iterable, Mapping, Sequence
from os import PathLike
from typing import Any

from bondgraph.errors import SignalError, UnitError, nearest
from codegen.cosimulation.described import READ, UnitDescription, described
from codegen.cosimulation.ends import known_signal
from codegen.cosimulation.wires import Wire
from codegen.simulator import Simulator
from codegen.switched.simulator import SwitchedSimulator

Participant = Simulator | SwitchedSimulator | str | PathLike[str]
"""A model of ours, or the path of a unit for co-simulation."""

Asked = Simulator | SwitchedSimulator | UnitDescription


def asked_of(participants: Mapping[str, Participant]) -> dict[str, Asked]:
    """Participants by name, units as they describe themselves."""
    if not isinstance(participants, Mapping) or not participants:
        raise SignalError(
            f"participants must map names to simulators and units, not be {participants!r}"
        )
    found = dict[str, Asked]()
    for name, one in participants.items():
        if not isinstance(name, str) or not name or "." in name:
            raise SignalError(f"a participant's name is a text without a dot, not {name!r}")
        if isinstance(one, Simulator | SwitchedSimulator):
            found[name] = one
        elif isinstance(one, str | PathLike):
            found[name] = described(one)
        else:
            raise SignalError(
                f"participant {name!r} must be a simulator or the path of a unit, not {type(one).__name__}; "
                "codegen.simulator makes one of equations"
            )
    _check_once(found)
    return found


def _check_once(asked: Mapping[str, Asked]) -> None:
    """Refuse a second instance of a unit that a process may have one of."""
    seen = dict[str, str]()
    for name, one in asked.items():
        if isinstance(one, UnitDescription) and one.once:
            if one.token in seen:
                raise UnitError(
                    f"participants {seen[one.token]!r} and {name!r}: unit {str(one.path)!r} may be there "
                    "once in a process, as it says of itself"
                )
            seen[one.token] = name


def inputs_of(one: Asked) -> tuple[str, ...]:
    """What a participant is given."""
    return one.names("input") if isinstance(one, UnitDescription) else one.inputs


def check_sources(wires: Iterable[Wire], asked: Mapping[str, Asked]) -> None:
    """Refuse what no unit gives, and lines into units that cannot follow them."""
    for wire in wires:
        origin, target = asked[wire.source.part], asked[wire.target.part]
        if isinstance(origin, UnitDescription):
            variable = origin.variables.get(wire.source.signal)
            if variable is not None and variable.name not in origin.names(*READ):
                raise SignalError(
                    f"connection from {str(wire.source)!r}: the unit's variable is "
                    f"{_article(variable.causality)}, which gives nothing; connect an output"
                )
            known_signal(
                wire.source, origin.names(*READ), "connection from", "output of one number"
            )
        if wire.linear and isinstance(target, UnitDescription) and not target.interpolates:
            raise SignalError(
                f"linear {str(wire.target)!r}: the unit holds its inputs over a step; leave it out"
            )


def _article(causality: str) -> str:
    return f"{'an' if causality[0] in 'aeiou' else 'a'} {causality}"


def turns_of(order: Sequence[str] | None, asked: Mapping[str, Asked]) -> tuple[str, ...] | None:
    """In which order participants go on; None for all at once."""
    if order is None:
        return None
    names = (order,) if isinstance(order, str) else tuple(order)
    if sorted(names) != sorted(asked):
        raise SignalError(
            f"order must name each participant once, {', '.join(asked)}, not be {', '.join(map(str, names))}"
        )
    return names


def by_part(told: Any, asked: Mapping[str, Asked], what: str) -> Mapping[str, Any]:
    """What is told by participants; `SignalError` for names that there are not."""
    if told is None:
        return {}
    if not isinstance(told, Mapping):
        raise SignalError(f"{what} must map participants to what holds of them, not be {told!r}")
    for name in told:
        if name not in asked:
            raise SignalError(
                f"{what}: there is no participant {name!r}{nearest(str(name), asked)}; there are "
                f"{', '.join(asked)}"
            )
    return told
