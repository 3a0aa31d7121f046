"""The master: signals are exchanged at communication points, between them all go on."""

from collections.abc import Mapping, Sequence
from math import isfinite

from bondgraph.errors import SimulationError
from codegen.cosimulation.ends import End
from codegen.cosimulation.loops import exchange_order
from codegen.cosimulation.part import Given, Part, named
from codegen.cosimulation.wires import Wire
from codegen.numbers.arrays import Array
from codegen.tuning import TUNING


class Master:
    """Participants and the wires between them. ``order``: in which they go on; None for all together."""

    def __init__(
        self, parts: Mapping[str, Part], wires: Sequence[Wire], order: Sequence[str] | None
    ) -> None:
        self._parts, self._wires = parts, wires
        self._into = {name: [one for one in wires if one.target.part == name] for name in parts}
        self._first, self._later = (exchange_order(parts, wires, first) for first in (True, False))
        self._turns = None if order is None else [parts[name] for name in order]
        #: Of each source of a line what it was told at first and last, with the time [s] of each.
        self._past = dict[End, tuple[tuple[float, float], tuple[float, float]]]()

    def run(self, times: Array) -> None:
        """From the first communication point to the last."""
        instants = times.tolist()
        for part in self._parts.values():
            with named(part.name):
                part.begin(instants[0])
        self._exchange(self._first, instants[0])
        for part in self._parts.values():
            with named(part.name):
                part.ready()
        for stop in instants[1:]:
            self._step(stop)
        self._arrive(instants[-1])

    def _step(self, stop: float) -> None:
        if self._turns is not None:
            for part in self._turns:
                self._give(part)
                with named(part.name):
                    part.keep()
                    part.advance(stop)
            return
        self._exchange(self._later, next(iter(self._parts.values())).time)
        for part in self._parts.values():
            with named(part.name):
                part.keep()
                part.advance(stop)

    def _arrive(self, time: float) -> None:
        """The last instant, at which nobody goes on."""
        if self._turns is None:
            self._exchange(self._later, time)
        for part in self._turns or self._parts.values():
            if self._turns is not None:
                self._give(part)
            with named(part.name):
                part.keep()

    def _exchange(self, order: Sequence[Part], time: float) -> None:
        """Give every input what its signal is, until no signal is another for it."""
        most = max(TUNING.impacts, 2 * len(self._wires) + 2)
        for _ in range(most):
            changed = [part.name for part in order if self._give(part)]
            if not changed:
                return
        raise SimulationError(
            f"at t = {time!r} s the signals between {', '.join(changed)} do not settle: each exchange "
            "changes them again; put a state or a sampled controller on the way"
        )

    def _give(self, part: Part) -> bool:
        """Whether a participant is given anything new."""
        given = {wire.target.signal: self._told(wire, part.time) for wire in self._into[part.name]}
        with named(part.name):
            return part.give(given)

    def _told(self, wire: Wire, time: float) -> Given:
        source = self._parts[wire.source.part]
        with named(source.name):
            value = source.read(wire.source.signal)
        if not isfinite(value):
            raise SimulationError(f"at t = {source.time!r} s {str(wire.source)!r} is {value}")
        if not wire.linear:
            return Given(value)
        return self._line(wire.source, (source.time, value), time)

    def _line(self, source: End, now: tuple[float, float], time: float) -> Given:
        """Along the line through what a signal was at two instants."""
        before, latest = self._past.get(source, (now, now))
        if latest[0] != now[0]:
            before = latest
        self._past[source] = before, now
        if before[0] == now[0]:
            return Given(now[1])
        slope = (now[1] - before[1]) / (now[0] - before[0])
        return Given(now[1] + slope * (time - now[0]), slope)
