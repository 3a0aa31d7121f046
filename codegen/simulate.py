"""`simulator` and what it returns: a model with numbers, ready to run, and the record of a run."""

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bondgraph.analyse.turned import turned
from bondgraph.declare.switching import checked_modes
from bondgraph.equations import StateEquations
from bondgraph.errors import ParameterError, SignalError
from codegen.energy.ledger import Ledger
from codegen.engine.fallback import Stopped, tell
from codegen.engine.located import METHODS as LOCATED_METHODS
from codegen.engine.located import LocatedLibrary, LocatedRuns, Recorded
from codegen.engine.runs import CRuns
from codegen.engine.status import Status
from codegen.inputs.pieces import Piece, constant_piece
from codegen.inputs.signal import Signal
from codegen.inputs.signals import Constant
from codegen.model.doubts import warn_of_doubts
from codegen.model.snapshot import Mode
from codegen.model.sources import source_signals
from codegen.modes.choose import Occasion, decide
from codegen.modes.closed import ClosedModel
from codegen.modes.rounding import Peaks
from codegen.modes.trials import Sight
from codegen.numbers.arrays import Array, is_finite, is_number, read_only
from codegen.program.lower import lower
from codegen.program.records import Program
from codegen.program.units import told_units
from codegen.record.columns import named_columns, with_switches
from codegen.record.replay import Run
from codegen.record.resting import tell_resting
from codegen.record.result import Result
from codegen.record.snapshots import snapshots
from codegen.runs.arguments import (
    check_names,
    checked_times,
    initial_values,
    numbers_of,
    settings_of,
    signals_for,
)
from codegen.runs.completion import Beginning, beginning, tell_completed
from codegen.runs.hybrid import run_hybrid
from codegen.runs.impulses import refuse_impulses
from codegen.runs.methods import EXACT
from codegen.runs.track import Settings, Track
from codegen.tuning import TUNING

BACKENDS = ("numpy", "c")
"""What runs models."""


@dataclass(frozen=True)
class Simulator:
    """A model with numbers for its parameters; every call returns fresh arrays.

    ``states``: names in the order of ``x``, states that laws own last. ``inputs``: names in the order
    of ``u``, what the model must be given. ``switches``: switches and controlled junctions. ``laws``: over
    those declared. ``engine`` and ``located``: the C that runs it, exactly where it is affine, and with
    step control.
    """

    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    switches: tuple[Hashable, ...]
    closed: ClosedModel
    laws: Mapping[Any, object] | None = field(default=None, repr=False, compare=False)
    engine: CRuns | None = field(default=None, repr=False, compare=False)
    located: LocatedRuns | None = field(default=None, repr=False, compare=False)

    def rhs(
        self, t: float, x: ArrayLike, u: ArrayLike = (), initially_on: Iterable[Hashable] = ()
    ) -> Array:
        """The rate of the states at one instant, inputs held; friction sticks where it can.

        Switches are as the states, the inputs and the time tell; where their conditions leave it open,
        those in ``initially_on`` are on, the others off. Where one holds what still moves, the rate
        is the one just after the impact.

        Raises `SignalError` for arrays of another length than ``states`` and ``inputs``, `StructureError`
        for a switch that there is not, `SimulationError` where there are no rates.
        """
        state, given = numbers_of(x, "x"), numbers_of(u, "u")
        for array, names, what in ((state, self.states, "states"), (given, self.inputs, "inputs")):
            if array.shape != (len(names),):
                raise SignalError(
                    f"{what} must have shape ({len(names)},), not {array.shape}: {names}"
                )
            if not np.isfinite(array).all():
                raise SignalError(f"{what} must be finite, not {array.tolist()}: {names}")
        if not is_number(t) or not is_finite(t):
            raise SignalError(f"the time must be a finite number, not {t!r}")
        pieces = [Constant(float(value)).pieces[0] for value in given]
        sources = self.sources(t, t)
        pieces += [signal.piece(t) for signal in sources]
        given = np.append(given, [signal(t) for signal in sources])
        s = self.vector(t, state, given)
        on = checked_modes(self.switches, initially_on)
        slipping, peaks = self.closed.program.before(on), Peaks.none(self.closed)
        with np.errstate(all="ignore"):
            here = Sight(self.closed, t, s, pieces)
            peaks.see(here, slipping)
            ahead = TUNING.look_ahead * TUNING.standing
            mode, s, *_ = decide(Occasion(self.closed, t, pieces, slipping, ahead, peaks), here)
            now = self.closed.at(t, s, pieces, mode)
        n = len(self.closed.program.states)
        rate = now.rate[: len(self.states)].copy()
        if not self.closed.program.varying:
            rate[:n] += now.numbers.R @ now.du
        return rate

    def run(
        self,
        time: ArrayLike,
        initial: Mapping[str, float] | None = None,
        inputs: Mapping[str, object] | None = None,
        method: str = "auto",
        rtol: float = TUNING.rtol,
        atol: float = TUNING.atol,
        initially_on: Iterable[Hashable] = (),
        events: bool = True,
    ) -> Result:
        """Integrate over the given times [s] and sample every signal at them.

        ``initial``: states by name, the rest start at 0. ``inputs``: a signal or a number for each
        of ``inputs``. ``method``: "exact" (matrix exponentials, for models that are affine in each friction
        mode), "DOP853", "Radau" (stiff models), "auto" of these, or "CVODE" (SUNDIALS; the extra
        ``sundae``): backward differences, Adams's formulas where a mode is affine and not stiff.
        ``initially_on``: the switches that are on at first, as far as their conditions let them; each
        switch is a column of the result, 1 or 0. States that are not named then follow what these hold:
        the result's ``completed`` has them, and a `ModelWarning` tells. One tells, too, of a switch that
        stays on while its command rests at zero. ``events``: whether the result keeps what happened; without,
        a run of any length takes no more memory than its samples and inputs.

        What backend "c" cannot go on with is run by numpy, and a `BackendWarning` tells why.

        Raises `SignalError` for unusable arguments, `SimulationError` if the run can't go on,
        `MissingExtraError` for what the method needs.
        """
        done = self.run_telling(
            tell, time, initial, inputs, method, rtol, atol, initially_on, events
        )
        tell_completed(done.completed)
        tell_resting(self.closed, done)
        return done

    def run_telling(
        self,
        tell: Callable[[Stopped], None],
        time: ArrayLike,
        initial: Mapping[str, float] | None = None,
        inputs: Mapping[str, object] | None = None,
        method: str = "auto",
        rtol: float = TUNING.rtol,
        atol: float = TUNING.atol,
        initially_on: Iterable[Hashable] = (),
        events: bool = True,
    ) -> Result:
        """As `run`; ``tell`` is called where numpy runs what C was asked to.

        Of a limit of C's own it is called before numpy starts, else once numpy has not refused it, too.
        """
        times = checked_times(time)
        signals = signals_for({} if inputs is None else inputs, self.inputs)
        asked = signals
        signals = [*asked, *self.sources(float(times[0]), float(times[-1]))]
        settings = settings_of(method, rtol, atol)
        refuse_impulses(self.closed, signals, times)
        at_start = np.array([signal(times[0]) for signal in signals])
        on = checked_modes(self.switches, initially_on)
        initial = {} if initial is None else initial
        states = initial_values(initial, self.states)
        begin = float(times[0])
        start = self.vector(begin, states, at_start)
        with np.errstate(all="ignore"):
            pieces = [signal.piece(begin) for signal in signals]
            begun = beginning(self.closed, begin, start, pieces, on, {str(n) for n in initial})
            states = states + begun.moved
            found = self._in_c(times, states, begun.s, signals, settings, begun.mode, events)
            if not isinstance(found, Recorded):
                stopped = found
                if stopped is not None and stopped.limit:
                    tell(stopped)
                found = self._in_numpy(times, begun, signals, settings, events)
                if stopped is not None and not stopped.limit:
                    tell(stopped)
            columns, observer = named_columns(self.closed, times, found.shots)
        columns = with_switches(columns, self.closed.program, found.modes)
        laws, numbers, start = self.laws, self.closed.parameters, read_only(begun.s)
        run = Run(laws, numbers, times, start, tuple(asked), settings, begun.mode)
        return Result(
            times,
            self.states,
            self.inputs,
            self.outputs,
            found.events,
            columns,
            observer,
            self._ledger(run),
            told_units(self.closed.equations),
            found.backend,
            begun.completed,
        )

    def _ledger(self, run: Run) -> Ledger:
        program = self.closed.program
        names = (*program.states, *program.law_states, *program.inputs, *program.asked)
        return Ledger(self.closed.declared, tuple(name.name for name in names), run.again)

    def _in_numpy(
        self, times: Array, begun: Beginning, signals: Sequence[Signal], settings: Settings,
        events: bool,
    ) -> Recorded:  # fmt: skip
        model = self.closed
        run = run_hybrid(model, times, begun.s, signals, settings, first=begun.mode, keeping=events)
        return self._recorded(times, signals, run.track, "numpy")

    def _in_c(
        self, times: Array, states: Array, start: Array, signals: Sequence[Signal],
        settings: Settings, first: Mode, events: bool,
    ) -> Recorded | Stopped | None:  # fmt: skip
        """The run in C, or why it cannot go on there; None where it was not asked for."""
        if self.located is None:
            return None
        stopped = Stopped(f"C has no method {settings.method!r}", limit=settings.method != EXACT)
        if self.engine is not None and settings.method in ("auto", EXACT):
            found = self.engine.run(times, start, signals, first, events)
            if found.track is not None:
                return self._recorded(times, signals, found.track, "c")
            stopped = found.stopped
            if found.status == Status.ENDLESS:
                # Step control would have no end either; the loop in Python tells why.
                return stopped
        if settings.method not in LOCATED_METHODS:
            return stopped
        return self.located.run(times, states, signals, settings, first, events)

    def _recorded(
        self, times: Array, signals: Sequence[Signal], track: Track, backend: str
    ) -> Recorded:
        shots = snapshots(self.closed.within(track), times, signals, track)
        events = tuple(track.events) if track.keeping else ()
        return Recorded(events, shots, backend, tuple(track.modes))

    def steady(
        self, inputs: Mapping[str, float], initial: Mapping[str, float]
    ) -> tuple[list[Piece], Array]:
        """Constant inputs as pieces, and the integrated vector at these states."""
        signals = signals_for(inputs, self.inputs)
        pieces = [constant_piece(0.0, signal(0.0)) for signal in signals]
        pieces += [signal.piece(0.0) for signal in self.sources(0.0, 0.0)]
        given = np.array([piece(0.0) for piece in pieces])
        return pieces, self.vector(0.0, initial_values(initial, self.states), given)

    def sources(self, begin: float, end: float) -> list[Signal]:
        """What known sources do from ``begin`` to ``end`` [s]; their pieces follow those of the inputs."""
        return source_signals(self.closed.program, self.closed.parameters, begin, end)

    def vector(self, t: float, state: Array, given: Array) -> Array:
        """The integrated vector at a state: x less what inputs that drive dependent storages add."""
        return self.closed.vector(t, state, given)


def simulator(
    equations: StateEquations,
    parameters: Mapping[str, object],
    laws: Mapping[Any, object] | None = None,
    backend: str = "numpy",
) -> Simulator:
    """A simulator of these equations with these numbers.

    ``parameters``: name to number. ``laws``: node (or the input it gives) to an expression or
    `DryFriction`, over the laws declared in the graph. A name in a law that parameters don't have is
    an input. ``backend``: "numpy", or "c", whose runs are generated C and much faster; it needs a C
    compiler and the extra ``c``.

    Warns (`ModelWarning`) of storages whose energy is not positive at these numbers, and of laws that give
    a signal from itself with several solutions, by name.

    Raises `ParameterError`, `StructureError` or `DependentSourceError` for what cannot be used,
    `SignalError` for what the backend cannot run, `MissingExtraError` for what it needs.
    """
    if backend not in BACKENDS:
        raise SignalError(f"unknown backend {backend!r}; there is {', '.join(BACKENDS)}")
    ready = bare_simulator(equations, parameters, laws)
    warn_of_doubts(ready.closed.program, equations, ready.closed.parameters)
    return with_engine(ready, backend)


def with_engine(ready: Simulator, backend: str, library: LocatedLibrary | None = None) -> Simulator:
    """The simulator with what runs it; ``library``: of one with the same program, if there is one."""
    if backend != "c":
        return ready
    located = LocatedRuns(ready.closed, library)
    if located.library.affine:
        return replace(ready, engine=CRuns(ready.closed), located=located)
    # Written now, so that what C cannot have is refused before there is a run.
    _ = located.library.sources
    return replace(ready, located=located)


def bare_simulator(
    equations: StateEquations,
    parameters: Mapping[str, object],
    laws: Mapping[Any, object] | None,
    timed: bool = True,
) -> Simulator:
    """A simulator in numpy, without a word on what is doubtful; ``timed``: as `lower` takes it."""
    if not isinstance(parameters, Mapping):
        raise ParameterError(f"parameters must map names to numbers, not be {parameters!r}")
    equations = turned(equations, laws)
    return bound(lower(equations, laws, parameters, timed), equations, parameters, laws)


def bound(
    program: Program, equations: StateEquations, parameters: Mapping[str, object],
    laws: Mapping[Any, object] | None = None,
) -> Simulator:  # fmt: skip
    """A simulator of a program that was lowered for parameters of these names, with these laws."""
    closed = ClosedModel(program, equations, parameters)
    check_names(program, equations)
    return Simulator(
        tuple(name.name for name in (*program.states, *program.law_states)),
        tuple(name.name for name in program.asked),
        tuple(name.name for name in program.outputs),
        tuple(port.name for port in program.switches),
        closed,
        None if laws is None else MappingProxyType(dict(laws)),
    )
