"""What a sweep keeps of each run: functions of a `Result` that give a number or an array.

The ready ones here can be sent to other processes; so can any function at the top of a module.
"""

from collections.abc import Callable, Collection, Hashable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np

from bondgraph.errors import SignalError, nearest
from bondgraph.nodes.tasks import Transition
from codegen.numbers.arrays import Array
from codegen.record.result import Result, values_of
from codegen.runs.track import KINDS, Event


@dataclass(frozen=True, repr=False)
class Measure:
    """A function of a run, with what it is asked for; its text is how it was made."""

    function: Callable[..., float | Array]
    arguments: tuple[Any, ...]
    #: Whether it gives a number for each point in time.
    over_time: bool = False

    def __call__(self, result: Result) -> float | Array:
        """The number or the array for one run."""
        return self.function(result, *self.arguments)

    def __repr__(self) -> str:
        name = self.function.__name__.removeprefix("_")
        return f"{name}({', '.join(map(repr, self.arguments))})"


def peak(signal: str) -> Measure:
    """The largest magnitude of a signal at the samples.

    Raises nothing; a sweep, and a run, refuses by `SignalError` a signal that there is not.

    >>> peak("tau_k1")
    peak('tau_k1')
    """
    return Measure(_peak, (signal,))


def largest(signal: str) -> Measure:
    """The largest value of a signal at the samples.

    Raises nothing; a sweep, and a run, refuses by `SignalError` a signal that there is not.

    >>> largest("v")
    largest('v')
    """
    return Measure(_largest, (signal,))


def smallest(signal: str) -> Measure:
    """The smallest value of a signal at the samples.

    Raises nothing; a sweep, and a run, refuses by `SignalError` a signal that there is not.

    >>> smallest("v")
    smallest('v')
    """
    return Measure(_smallest, (signal,))


def final(signal: str) -> Measure:
    """A signal's value at the last point in time.

    Raises nothing; a sweep, and a run, refuses by `SignalError` a signal that there is not.

    >>> final("v")
    final('v')
    """
    return Measure(_final, (signal,))


def integral(signal: str) -> Measure:
    """A signal integrated through the run, however few its samples; see `Result.integral`.

    Raises nothing; a sweep, and a run, refuses by `SignalError` a signal that there is not.

    >>> integral("v")
    integral('v')
    """
    return Measure(_integral, (signal,))


def samples(signal: str) -> Measure:
    """The whole signal, a number for each point in time.

    Raises nothing; a sweep, and a run, refuses by `SignalError` a signal that there is not.

    >>> samples("v")
    samples('v')
    """
    return Measure(_samples, (signal,), over_time=True)


def first_event(port: Hashable, kind: str) -> Measure:
    """The time [s] of the first event of that kind at a port, such as "stick"; NaN if there is none.

    Raises `SignalError` for a kind that events do not have; a sweep, and a run, for what is no node of the
    graph.

    >>> first_event("clutch", "stick")
    first_event('clutch', 'stick')
    """
    return Measure(_first_event, (port, _checked(kind)))


def event_count(port: Hashable, kind: str) -> Measure:
    """How many events of that kind a port has.

    Raises `SignalError` for a kind that events do not have; a sweep, and a run, for what is no node of the
    graph.

    >>> event_count("clutch", "slip")
    event_count('clutch', 'slip')
    """
    return Measure(_event_count, (port, _checked(kind)))


def work(node: Hashable) -> Measure:
    """The energy that an element absorbs, or a source supplies, through the run; see `Result.work`.

    Raises nothing; a sweep refuses by `SignalError` a node that there is not.

    >>> work("brake")
    work('brake')
    """
    return Measure(_work, (node,))


def balance() -> Measure:
    """What the power balance of a run leaves open, of the energy turned over; see `Result.audit`.

    Raises nothing.

    >>> balance()
    balance()
    """
    return Measure(_balance, ())


def _checked(kind: str) -> str:
    if not isinstance(kind, str) or (kind not in KINDS and not is_taken(kind)):
        raise SignalError(
            f"no event is a {kind!r}{nearest(str(kind), KINDS)}; there are {', '.join(KINDS)}, and of "
            "state machines transitions such as 'idle > drive'"
        )
    return kind


def is_taken(kind: str) -> bool:
    """Whether a kind of event is a transition of a state machine."""
    return len(kind.split(" > ")) == 2


def _peak(result: Result, signal: str) -> float:
    return float(np.abs(values_of(result, signal)).max())


def _largest(result: Result, signal: str) -> float:
    return float(values_of(result, signal).max())


def _smallest(result: Result, signal: str) -> float:
    return float(values_of(result, signal).min())


def _final(result: Result, signal: str) -> float:
    return float(values_of(result, signal)[-1])


def _integral(result: Result, signal: str) -> float:
    return float(result.integral(signal)[-1])


def _samples(result: Result, signal: str) -> Array:
    return values_of(result, signal)


def check_node(node: Hashable, nodes: Collection[Hashable]) -> None:
    """Refuse, by `SignalError`, what is no node of the graph."""
    if node not in nodes:
        told = [str(one) for one in nodes]
        raise SignalError(
            f"no node {node!r}{nearest(str(node), told)}; there are {', '.join(told) or 'none'}"
        )


def check_event(port: Hashable, kind: str, transitions: Collection[Transition]) -> None:
    """Refuse, by `SignalError`, a transition that the node does not have."""
    known = [one.words for one in transitions if one.machine.name == port]
    if is_taken(kind) and kind not in known:
        raise SignalError(
            f"{port!r} has no transition {kind!r}{nearest(kind, known)}; there are "
            f"{', '.join(known) or 'none'}"
        )


def _events(result: Result, port: Hashable, kind: str) -> list[Event]:
    check_node(port, result.observer.nodes())
    check_event(port, kind, result.observer.transitions())
    return [event for event in result.events if (event.port, event.kind) == (port, kind)]


def _first_event(result: Result, port: Hashable, kind: str) -> float:
    return min((event.time for event in _events(result, port, kind)), default=float("nan"))


def _event_count(result: Result, port: Hashable, kind: str) -> float:
    return float(len(_events(result, port, kind)))


def _work(result: Result, node: Hashable) -> float:
    return float(result.work(node)[-1])


def _balance(result: Result) -> float:
    audit = result.audit()
    left = abs(audit.residual)
    return left / audit.turned_over if audit.turned_over > 0 else left


EVENTFUL = frozenset[Callable[..., float | Array]]({_first_event, _event_count})
"""Those that events are kept for."""

READY: Mapping[Callable[..., float | Array], str] = MappingProxyType(
    {
        _peak: "peak", _largest: "largest", _smallest: "smallest", _final: "final",
        _integral: "integral", _samples: "samples", _first_event: "first_event",
        _event_count: "event_count", _work: "work", _balance: "balance",
    }
)  # fmt: skip
"""What loops in C can do, too."""

OF_NODES = frozenset({"first_event", "event_count", "work"})
"""Those that are asked of a node; the others are asked of a signal, or of nothing."""
