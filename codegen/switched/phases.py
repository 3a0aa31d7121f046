"""Phases: a graph in one mode of its switches, as a simulator with guards; and which one begins."""

from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import Any

import networkx as nx
import numpy as np

from bondgraph.declare.switching import in_mode, switches
from bondgraph.derive import derive
from bondgraph.equations import StateEquations
from bondgraph.errors import BondGraphError, SimulationError
from codegen.inputs.pieces import Piece
from codegen.model.doubts import warn_of_doubts
from codegen.model.snapshot import Mode
from codegen.modes.choose import a_moment_later, decide
from codegen.modes.guards import guard_values
from codegen.modes.pace import LOOK_AHEAD, look_ahead, time_constant
from codegen.modes.rounding import Peaks
from codegen.numbers.arrays import Array
from codegen.runs.legs import Leg
from codegen.runs.track import Settings
from codegen.simulate import Simulator, guarded_simulator
from codegen.standalone.levels import TOLERANCE
from codegen.switched.handover import Handover

On = frozenset[Hashable]
"""The switches that are on."""

MOST_SWITCHES = 12
"""With more, only phases that single changes lead to are tried."""


@dataclass(frozen=True)
class Phase:
    """A graph in one mode of its switches. Guard k falls where switch k should change over."""

    on: On
    simulator: Simulator
    handover: Handover


@dataclass(frozen=True)
class Held:
    """What is kept when a switch changes over: momenta by storage, states of laws by name."""

    momenta: Mapping[Hashable, float]
    own: Mapping[str, float]
    #: The largest momenta that the run has seen: what rounding is relative to.
    peaks: Mapping[Hashable, float]


@dataclass(frozen=True)
class Moment:
    """When a phase begins, with the inputs' pieces by name; ``begin``, ``end`` [s]: of the run.

    ``following`` [s]: the inputs' next breakpoint, infinite if there is none.
    """

    t: float
    pieces: Mapping[str, Piece]
    settings: Settings
    begin: float
    end: float
    following: float


Keeping = Callable[[Phase], Held]
"""What a phase is handed at its beginning."""


class Phases:
    """The phases of a graph with switches, each derived when it is first asked for."""

    def __init__(
        self,
        graph: "nx.DiGraph[Hashable]",
        parameters: Mapping[str, object],
        laws: Mapping[Any, object] | None,
        outputs: Sequence[Hashable] | None,
        told: Callable[[StateEquations], StateEquations] | None = None,
    ) -> None:
        self._graph, self._parameters, self._laws = graph, parameters, laws
        self._outputs, self._told = outputs, told
        self.switches = switches(graph)
        self._known: dict[On, Phase | BondGraphError] = {}
        self._warned: tuple[str, ...] = ()

    @cached_property
    def names(self) -> tuple[Hashable, ...]:
        """The switches, in declaration order."""
        return tuple(switch.name for switch in self.switches)

    def __getitem__(self, on: On) -> Phase:
        """One phase; raises the `BondGraphError` of a mode that has no equations."""
        if on not in self._known:
            try:
                self._known[on] = self._phase(on)
            except BondGraphError as error:
                self._known[on] = error
        found = self._known[on]
        if isinstance(found, BondGraphError):
            raise found
        return found

    def telling(self, told: Callable[[StateEquations], StateEquations]) -> "Phases":
        """The same phases with more signals: ``told`` makes of each one's equations those that know them."""
        return Phases(self._graph, self._parameters, self._laws, self._outputs, told)

    def any(self) -> Phase:
        """The mode with the fewest switches on that has equations; else raises what the first lacks."""
        refused: BondGraphError | None = None
        for on in self._all_modes(frozenset()):
            try:
                return self[on]
            except BondGraphError as error:
                refused = refused or error
        raise refused or SimulationError("the graph has no mode")

    def _phase(self, on: On) -> Phase:
        equations = derive(in_mode(self._graph, on), self._outputs)
        if self._told is not None:
            equations = self._told(equations)
        guards = [-(s.off if s.name in on else s.on) for s in self.switches]
        simulator = guarded_simulator(equations, self._parameters, self._laws, guards)
        if self._told is None:
            # What one mode was told for need not be said of the next.
            model = simulator.closed
            self._warned += warn_of_doubts(model.program, equations, model.parameters, self._warned)
        return Phase(on, simulator, Handover(simulator.closed))

    def begin(self, now: Moment, held: Keeping, last: On, changed: On) -> tuple[Phase, Array]:
        """The phase that begins and its integrated vector; ``changed``: switches whose guard fell.

        ``held`` tells what the phase is handed.

        Switches whose guards the new phase breaks change over, too, until none does; if that goes round in
        circles, all modes are tried, those with the fewest changes first.

        Raises `SimulationError`, with what is wrong with each, if no mode is consistent.
        """
        tried: dict[On, str] = {}
        on = last ^ changed
        while on not in tried:
            phase, vector, broken = self._try(on, now, held, tried)
            if phase is not None and not broken:
                return phase, vector
            if phase is None:
                break
            on = on ^ broken
        for on in self._all_modes(last):
            if on not in tried:
                phase, vector, broken = self._try(on, now, held, tried)
                if phase is not None and not broken:
                    return phase, vector
        complaints = "; ".join(f"{_listed(on)}: {text}" for on, text in list(tried.items())[:8])
        raise SimulationError(
            f"at t = {now.t:.9g} no mode of the switches is consistent; tried {complaints}. "
            "A switch that both modes send back needs a hysteresis: an off of its own"
        )

    def _all_modes(self, last: On) -> Iterator[On]:
        most = len(self.names) if len(self.names) <= MOST_SWITCHES else 1
        for count in range(most + 1):
            for changed in combinations(self.names, count):
                yield last ^ frozenset(changed)

    def _try(
        self, on: On, now: Moment, held: Keeping, tried: dict[On, str]
    ) -> tuple[Phase | None, Array, On]:
        """A mode at one instant, and the switches whose guards it breaks; None for one without equations."""
        try:
            phase = self[on]
            vector, broken = enter(phase, now, held(phase))
        except BondGraphError as error:
            tried[on] = str(error)
            return None, np.zeros(0), frozenset()
        names = frozenset(self.names[k] for k in broken)
        tried[on] = f"{_listed(names)} would change over at once"
        return phase, vector, names


def enter(phase: Phase, start: Moment, held: Held) -> tuple[Array, frozenset[int]]:
    """The vector with which a phase begins, and the guards that have fallen there already.

    A guard in which an impulse shows is judged by the impulse, one at zero by what it does next.
    """
    model, t = phase.simulator.closed, start.t
    given = [start.pieces[name] for name in phase.simulator.inputs]
    given += [one.piece(t) for one in phase.simulator.sources(start.begin, start.end)]
    own = np.array([held.own[name.name] for name in model.program.law_states])
    before = np.array([held.momenta[name] for name in phase.handover.storages])
    s = phase.handover.begin(t, before, own, *model.given(t, given))
    peaks, mode = Peaks.none(model), _friction_mode(phase, t, s, given)
    peaks.see(model, t, s, given, mode)
    leg = Leg(model, given, mode, start.settings, start.begin, peaks)
    peaks.time = time_constant(leg.fastest(t, s), t - start.begin)
    values, limits = guard_values(model, t, s, given, mode, peaks)
    fallen = values < -limits
    tied = np.abs(values) <= limits
    if tied.any():
        ahead = look_ahead(peaks.time, t, start.following)
        later = a_moment_later(model, t, s, given, mode, ahead)
        fallen |= tied & (model.guards(t + ahead, later) < -limits)
    pushed = _pushed(phase, start, s, given, mode, before, held)
    fallen = np.where(pushed == 0, fallen, pushed < 0)
    return s, frozenset(np.flatnonzero(fallen).tolist())


def _pushed(
    phase: Phase, start: Moment, s: Array, given: Sequence[Piece], mode: Mode, before: Array,
    held: Held,
) -> Array:  # fmt: skip
    """The way that impulses drive each guard at the beginning of a phase; zero for most."""
    now = phase.simulator.closed.at(start.t, s, given, mode)
    after = phase.handover.momenta(start.t, now)
    seen = np.array([held.peaks.get(name, 0.0) for name in phase.handover.storages])
    size = np.maximum(seen, phase.handover.sizes(start.t, now))
    change = after - before
    change[np.abs(change) <= TOLERANCE * (np.abs(before) + size)] = 0.0
    pushed = phase.handover.falling(start.t, now, change)
    pushed[np.abs(pushed) <= TOLERANCE] = 0.0
    return pushed


def _friction_mode(phase: Phase, t: float, s: Array, pieces: Sequence[Piece]) -> Mode:
    """How friction ports stick and slip as the phase begins."""
    model = phase.simulator.closed
    slipping, peaks = tuple(1 for _ in model.program.friction), Peaks.none(model)
    peaks.see(model, t, s, pieces, slipping)
    return decide(model, t, s, pieces, slipping, frozenset(), LOOK_AHEAD * 1e-3, peaks)


def _listed(on: On) -> str:
    return ", ".join(sorted(map(repr, on))) or "none"
