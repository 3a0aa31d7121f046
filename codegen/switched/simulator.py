"""`switched_simulator`: graphs with switches, one phase after another, momenta handed over between."""

import math
from collections import deque
from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bondgraph.declare.switching import checked_modes
from bondgraph.declare.validate import validate
from bondgraph.equations import StateEquations
from bondgraph.errors import SimulationError, StructureError
from codegen.energy.accounts import Account, accounts, with_signals
from codegen.energy.ledger import Integrated, Ledger
from codegen.energy.tally import Tally
from codegen.inputs.signal import Signal
from codegen.model.snapshot import Snapshot
from codegen.modes.pace import hardly_apart
from codegen.numbers.arrays import Array, read_only
from codegen.program.units import told_units
from codegen.record.columns import named_columns
from codegen.record.replay import shares, tally_of
from codegen.record.result import Result
from codegen.record.snapshots import snapshots
from codegen.runs.arguments import checked_times, named_numbers, settings_of, signals_for
from codegen.runs.hybrid import run_hybrid
from codegen.runs.impulses import refuse_impulses
from codegen.runs.track import Event, Settings
from codegen.switched.phases import Held, Keeping, Moment, On, Phase, Phases
from codegen.switched.spliced import Spliced
from codegen.tuning import TUNING


@dataclass(frozen=True)
class SwitchedSimulator:
    """A graph with switches and numbers for its parameters.

    ``states``: the co-energy variables of all storages, then states that laws own. ``inputs``: what the
    model must be given. ``switches``: the names of switches and controlled junctions.
    """

    states: tuple[str, ...]
    inputs: tuple[str, ...]
    switches: tuple[Hashable, ...]
    phases: Phases

    def run(
        self,
        time: ArrayLike,
        initial: Mapping[str, float] | None = None,
        inputs: Mapping[str, object] | None = None,
        initially_on: Iterable[Hashable] = (),
        method: str = "auto",
        rtol: float = TUNING.rtol,
        atol: float = TUNING.atol,
    ) -> Result:
        """Integrate over the given times [s], as `Simulator.run` does, from phase to phase.

        ``initially_on``: the switches that are on at first, as far as their conditions let them.
        ``initial``: states by name; the others start at 0, or follow those on which they depend at first.
        What is named but cannot stay as it is shares its momentum or charge at once.

        The result's ``events`` tell which switch went on or off when; each switch also is a column, 1 or 0.

        Raises `SimulationError` where no mode of the switches is consistent, or they change over without end.
        """
        times = checked_times(time)
        given = signals_for({} if inputs is None else inputs, self.inputs)
        signals = dict(zip(self.inputs, given, strict=True))
        values = named_numbers({} if initial is None else initial, self.states)
        settings = settings_of(method, rtol, atol)
        first = checked_modes(self.switches, initially_on)
        start = _Start(times, MappingProxyType(signals), settings, first, MappingProxyType(values))
        with np.errstate(all="ignore"):
            return _Journey(self, start, self._ledger(start)).run()

    def _ledger(self, start: "_Start") -> Ledger:
        """What the run is asked about energy; every phase has the same one-ports."""
        model = self.phases.any().simulator.closed
        own = tuple(name.name for name in model.program.law_states)
        return Ledger(model.equations, (*own, *self.inputs), partial(self._again, start))

    def _again(self, start: "_Start", _: StateEquations, whole: Sequence[Account]) -> Integrated:
        """The run once more, with accounts integrated."""
        names = {name for account in whole for p in account for name in (p.one, p.other)}

        def told(equations: StateEquations) -> StateEquations:
            return with_signals(accounts(equations), names).equations

        simulator = replace(self, phases=self.phases.telling(told))
        with np.errstate(all="ignore"):
            journey = _Journey(simulator, start, self._ledger(start), whole)
            result = journey.run()
        rows = np.array(journey.rows)
        totals, impacts = read_only(rows[:, :-1] @ shares(whole)), read_only(rows[:, -1])
        return Integrated(totals, impacts, result.observer)


@dataclass(frozen=True)
class _Start:
    """What a run is given: samples, inputs by name, settings, the switches that are on, states by name."""

    times: Array
    signals: Mapping[str, Signal]
    settings: Settings
    on: On
    initial: Mapping[str, float]


class _Journey:
    """One run: the phases that it passes through, its results so far, and its events.

    ``rows``: of accounts that are integrated on the way, at each sample.
    """

    def __init__(
        self, simulator: SwitchedSimulator, start: _Start, ledger: Ledger,
        whole: Sequence[Account] | None = None,
    ) -> None:  # fmt: skip
        times, signals, settings = start.times, start.signals, start.settings
        self._start, self._ledger, self._whole = start, ledger, whole
        self.rows: list[Array] = []
        self._ended: tuple[Tally, tuple[Array, Array], Array] | None = None
        self._simulator, self._times = simulator, times
        self._signals, self._settings = signals, settings
        self._parts: list[Result] = []
        self._modes: list[On] = []
        self._events: list[Event] = []
        self._begin, self._end = float(times[0]), float(times[-1])
        self._peaks: dict[Hashable, float] = {}
        #: How each friction port slips as a phase ends; none before the first.
        self._slips: dict[Hashable, int] = {}

    def run(self) -> Result:
        """From phase to phase to the end."""
        phases, t, on = self._simulator.phases, float(self._times[0]), self._start.on
        held: Keeping = partial(self._started, t, self._start.initial)
        changed, rounds = On(), deque[float](maxlen=TUNING.stalled)
        while True:
            pieces = {name: signal.piece(t) for name, signal in self._signals.items()}
            moment = Moment(t, pieces, self._settings, self._begin, self._end, self._following(t))
            phase, vector = phases.begin(moment, held, on, changed)
            if rounds:
                self._note(t, on, phase.on)
            on = phase.on
            t, kept, changed, time = self._pass(phase, t, vector)
            held = partial(_same, kept)
            if not changed:
                return self._result()
            rounds.append(t)
            if len(rounds) == TUNING.stalled and t - rounds[0] < hardly_apart(time):
                raise SimulationError(
                    f"{TUNING.stalled} switchings within a moment of t = {t:.12g}: the run makes no "
                    f"progress; the last were {', '.join(map(repr, changed))}"
                )

    def _following(self, t: float) -> float:
        """The inputs' next breakpoint."""
        points = (signal.following(t) for signal in self._signals.values())
        return min(points, default=math.inf)

    def _started(self, t: float, initial: Mapping[str, float], phase: Phase) -> Held:
        """What storages hold at the start: as given by name, the others as the phase makes them follow."""
        simulator, signals = phase.simulator, self._given(phase)
        state = np.array([initial.get(name, 0.0) for name in simulator.states])
        given = np.array([signal(t) for signal in signals])
        s = simulator.vector(t, state, given)
        pieces = [signal.piece(t) for signal in signals]
        slipping = tuple(1 for _ in simulator.closed.program.friction)
        return _held(phase, t, simulator.closed.at(t, s, pieces, slipping), initial, self._peaks)

    def _given(self, phase: Phase) -> list[Signal]:
        """The inputs' signals, and those of the phase's known sources."""
        simulator, times = phase.simulator, self._times
        sources = simulator.sources(float(times[0]), float(times[-1]))
        return [self._signals[name] for name in simulator.inputs] + sources

    def _pass(self, phase: Phase, t: float, vector: Array) -> tuple[float, Held, On, float]:
        """One phase: to the end of the run or the first switching, whose switches come third.

        Fourth comes the shortest time constant there.
        """
        model, signals = phase.simulator.closed, self._given(phase)
        done = sum(len(part.time) for part in self._parts)
        rest = self._times[done:]
        refuse_impulses(model, signals, rest)
        tally = self._tally(phase, rest, t, vector, signals)
        ports = [port.name for port in model.program.friction]
        before = tuple(self._slips[name] for name in ports) if self._slips else None
        stretch = run_hybrid(
            model, rest, vector, signals, self._settings, t, self._begin, tally, before
        )
        self._slips = dict(zip(ports, stretch.mode, strict=True))
        track = stretch.track
        self._events += track.events
        if track.recorded:
            own = slice(0, track.recorded)
            track.vectors = track.vectors[own]
            simulator = phase.simulator
            shots = snapshots(model, rest[own], signals, track)
            columns, observer = named_columns(model, rest[own], shots)
            self._parts.append(
                Result(rest[own], simulator.states, simulator.inputs, simulator.outputs, (),
                       columns, observer, self._ledger,
                       told_units(model.equations))
            )  # fmt: skip
            self._modes += [phase.on] * track.recorded
        pieces = [signal.piece(stretch.t) for signal in signals]
        now = model.at(stretch.t, stretch.s, pieces, stretch.mode)
        names = self._simulator.switches
        largest = track.largest[: len(model.program.states)]
        sizes = phase.handover.sizes(stretch.t, now, largest).tolist()
        for name, size in zip(phase.handover.storages, sizes, strict=True):
            self._peaks[name] = max(size, self._peaks.get(name, 0.0))
        held = _held(phase, stretch.t, now, {}, self._peaks)
        if tally is not None:
            self.rows += tally.rows
            self._ended = tally, tally.pair(now), phase.handover.momenta(stretch.t, now)
        return stretch.t, held, On(names[k] for k in stretch.fallen), stretch.time

    def _tally(
        self, phase: Phase, rest: Array, t: float, vector: Array, signals: Sequence[Signal]
    ) -> Tally | None:
        """What is integrated in a phase, from what the phases before it left and the impact between."""
        if self._whole is None:
            return None
        model, handover = phase.simulator.closed, phase.handover
        tally = tally_of(model, self._whole, rest)
        if self._ended is None:
            return tally
        before, pair, momenta = self._ended
        tally.total, tally.taken = before.total, before.taken
        slipping = tuple(1 for _ in model.program.friction)
        now = model.at(t, vector, [signal.piece(t) for signal in signals], slipping)
        after = handover.momenta(t, now)
        ports = model.equations.reduction.structure.ports
        names = {p.given.name for p in ports if p.element.kind.stores}
        names |= {p.received.name for p in ports if p.element.kind.stores}
        stored = [p.one in names and p.other in names for account in self._whole for p in account]
        taken = handover.taken(t, now, momenta, after)
        impulses = handover.impulses(t, now, after - momenta)
        tally.impact(pair, now, impulses, np.array(stored), taken)
        return tally

    def _note(self, t: float, old: On, new: On) -> None:
        for name in self._simulator.switches:
            if (name in old) != (name in new):
                self._events.append(Event(t, name, "on" if name in new else "off"))

    def _result(self) -> Result:
        """All phases as one result."""
        spliced, simulator = Spliced(tuple(self._parts)), self._simulator
        common = set(self._parts[0].columns).intersection(*(part.columns for part in self._parts))
        names = dict.fromkeys([*simulator.states, *self._parts[0].columns])
        columns = {
            name: read_only(spliced.signal(name))
            for name in names
            if name in common or name in simulator.states
        }
        for name in simulator.switches:
            columns[str(name)] = read_only(np.array([float(name in mode) for mode in self._modes]))
        return Result(
            self._times, simulator.states, simulator.inputs, self._parts[0].outputs,
            tuple(self._events), MappingProxyType(columns), spliced, self._ledger,
            MappingProxyType({name: unit for part in self._parts for name, unit in part.units.items()}),
        )  # fmt: skip


def _same(held: Held, phase: Phase) -> Held:
    return held


def _held(
    phase: Phase, t: float, now: Snapshot, given: Mapping[str, float],
    peaks: Mapping[Hashable, float],
) -> Held:  # fmt: skip
    """What is kept at an instant: the momenta of storages, and the states of laws."""
    found = phase.handover.momenta(t, now, given).tolist()
    momenta = dict(zip(phase.handover.storages, found, strict=True))
    own = (name.name for name in phase.simulator.closed.program.law_states)
    return Held(momenta, dict(zip(own, now.z.tolist(), strict=True)), dict(peaks))


def switched_simulator(
    graph: Any,
    parameters: Mapping[str, object],
    laws: Mapping[Any, object] | None = None,
    outputs: Iterable[Hashable] | None = None,
) -> SwitchedSimulator:
    """A simulator of a graph with switches and controlled junctions, in all of their modes.

    Each mode has a causality and equations of its own, derived when a run first needs them. What a
    mode makes dependent is handed over with conserved momenta and displacements. ``parameters`` and
    ``laws`` as for `simulator`, ``outputs`` as for `derive`.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.One("first"), bg.I("m_1", 1, flow="v_1"), bg.Zero("gap"),
    ...                   bg.Sw("slack", on="1 - t"), bg.One("second"), bg.I("m_2", 3, flow="v_2")])
    >>> g.add_edges_from([("first", "m_1"), ("first", "gap"), ("gap", "slack"), ("gap", "second"),
    ...                   ("second", "m_2")])
    >>> run = switched_simulator(g, {}).run([0.0, 2.0], initial={"v_1": 4.0})
    >>> run["v_1"].round(9).tolist(), run["v_2"].round(9).tolist(), run.events
    ([4.0, 1.0], [0.0, 1.0], (Event(time=1.0, port='slack', kind='off'),))
    """
    checked = validate(graph)
    phases = Phases(checked, parameters, laws, None if outputs is None else list(outputs))
    names = phases.names
    if not names:
        raise StructureError("the graph has no switches; derive it and make a simulator of that")
    first = phases.any()
    _check_names(names, first)
    handover, model = first.handover, first.simulator.closed
    own = tuple(name.name for name in model.program.law_states)
    return SwitchedSimulator(
        (*handover.variables, *own), first.simulator.inputs, names, phases
    )  # fmt: skip


def _check_names(switches: Sequence[Hashable], phase: Phase) -> None:
    """Refuse switches whose columns would hide a signal's."""
    model = phase.simulator.closed
    taken = {*map(str, model.equations.signals), *phase.simulator.inputs, *phase.simulator.states}
    taken |= {name.name for name in model.program.law_states}
    for at, name in enumerate(switches):
        if str(name) in taken or str(name) in map(str, switches[:at]):
            raise StructureError(
                f"switch {name!r} is called like a signal or another switch, and each is a column of a "
                "result; rename it"
            )
