"""Connections between participants: from a signal of one to an input of another."""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from bondgraph.errors import SignalError
from codegen.cosimulation.ends import End, end_of, known_signal


@dataclass(frozen=True)
class Wire:
    """From a signal to an input; ``linear``: whether it goes on along a line between instants."""

    source: End
    target: End
    linear: bool = False

    def __str__(self) -> str:
        return f"{self.source} -> {self.target}"


def wires_of(
    connections: Mapping[str, Any], inputs: Mapping[str, Collection[str]], linear: Iterable[str]
) -> tuple[Wire, ...]:
    """Connections as wires; ``inputs``: of each participant.

    Raises `SignalError` for names that there are not, and for an input that is connected twice.

    >>> [str(one) for one in wires_of({"a.y": ["b.u", "c.u"]}, {"a": [], "b": ["u"], "c": ["u"]}, [])]
    ['a.y -> b.u', 'a.y -> c.u']
    """
    if not isinstance(connections, Mapping):
        raise SignalError(
            f"connections must map signals to inputs, {{'plant.v': 'engine.v'}}, not be {connections!r}"
        )
    lines = {*_lines(linear, inputs)}
    found, taken = list[Wire](), dict[End, End]()
    for text, targets in connections.items():
        source = end_of(text, inputs, "connection from")
        for one in [targets] if isinstance(targets, str) else targets:
            target = end_of(one, inputs, "connection to")
            known_signal(target, inputs[target.part], "connection to", "input")
            if target in taken:
                raise SignalError(
                    f"input {str(target)!r} is connected twice: to {str(taken[target])!r} and to {text!r}"
                )
            taken[target] = source
            found.append(Wire(source, target, target in lines))
    for one in lines - taken.keys():
        raise SignalError(f"linear {str(one)!r}: the input is not connected")
    return tuple(found)


def _lines(linear: Iterable[str], inputs: Mapping[str, Collection[str]]) -> list[End]:
    if isinstance(linear, str):
        raise SignalError(f"linear must be a list of inputs, not {linear!r}")
    found = [end_of(one, inputs, "linear") for one in linear]
    for one in found:
        known_signal(one, inputs[one.part], "linear", "input")
    return found


def open_inputs(
    given: Mapping[str, object] | None, inputs: Mapping[str, Collection[str]],
    wires: Iterable[Wire],
) -> dict[str, dict[str, object]]:  # fmt: skip
    """By participants the signals of inputs that are not connected.

    Raises `SignalError` for names that there are not, and for inputs that are connected as well.
    """
    found: dict[str, dict[str, object]] = {part: {} for part in inputs}
    taken = {wire.target: wire.source for wire in wires}
    if given is not None and not isinstance(given, Mapping):
        raise SignalError(f"inputs must map 'participant.input' to signals, not be {given!r}")
    for text, value in (given or {}).items():
        end = end_of(text, inputs, "input")
        known_signal(end, inputs[end.part], "input", "input")
        if end in taken:
            raise SignalError(
                f"input {text!r} is connected to {str(taken[end])!r}, and has a signal as well"
            )
        found[end.part][end.signal] = value
    return found
