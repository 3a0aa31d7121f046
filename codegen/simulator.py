"""`Simulator`: a model with numbers, ready to run."""

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bondgraph.declare.switching import checked_modes
from bondgraph.errors import SignalError
from codegen.called.function import followed
from codegen.delays.course import Make
from codegen.delays.found import found as found_delays
from codegen.delays.readings import Reading, readings
from codegen.delays.stepper import LateStepper
from codegen.energy.ledger import Ledger
from codegen.engine.fallback import Stopped, tell
from codegen.engine.located import LocatedRuns
from codegen.engine.runs import CRuns
from codegen.inputs.pieces import Piece, constant_piece
from codegen.inputs.signal import Signal
from codegen.inputs.signals import Constant
from codegen.instants.equilibrium import equilibrium
from codegen.model.sources import source_signals
from codegen.model.starts import by_states, told_starts
from codegen.modes.closed import ClosedModel
from codegen.modes.rates import rates
from codegen.numbers.arrays import Array, is_finite, is_number, read_only
from codegen.program.units import told_units
from codegen.record.beyond import refuse_all_beyond
from codegen.record.columns import listed_columns, named_columns, with_switches
from codegen.record.replay import Run
from codegen.record.resting import tell_resting, tell_rests
from codegen.record.result import Result
from codegen.record.whence import whence
from codegen.runs.arguments import (
    checked_times,
    initial_values,
    named_numbers,
    numbers_of,
    settings_of,
    signals_for,
)
from codegen.runs.completion import started, tell_completed
from codegen.runs.impulses import refuse_impulses
from codegen.runs.track import Settings
from codegen.stepping.in_numpy import NumpyGoing
from codegen.stepping.known import Sources
from codegen.stepping.plan import Plan
from codegen.stepping.state import Start
from codegen.stepping.stepper import Origin, Stepper
from codegen.stepping.ways import going_of
from codegen.streaming.files import checked_ending
from codegen.streaming.stream import streamed, wanted_signals
from codegen.streaming.streamed import Streamed
from codegen.taking.asked import Request
from codegen.taking.backends import run_into
from codegen.taking.blocks import Sink, Whole
from codegen.tuning import TUNING

EQUILIBRIUM = "equilibrium"
"""In place of initial values: where all states rest."""


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
        before = self.closed.program.before(checked_modes(self.switches, initially_on))
        return rates(self.closed, t, s, pieces, before)

    def run(
        self,
        time: ArrayLike,
        initial: Mapping[str, float] | str | None = None,
        inputs: Mapping[str, object] | None = None,
        method: str = "auto",
        rtol: float = TUNING.rtol,
        atol: float = TUNING.atol,
        initially_on: Iterable[Hashable] = (),
        events: bool = True,
        corners: bool = False,
    ) -> Result:
        """Integrate over the given times [s] and sample every signal at them.

        ``initial``: states by name, the rest start as the graph says, or at 0; "equilibrium": where all rest
        under the inputs as they begin. ``inputs``: a signal or a number for each
        of ``inputs``. ``method``: "exact" (matrix exponentials, for models that are affine in each friction
        mode), "DOP853", "Radau" (stiff models), "auto" of these, or "CVODE" (SUNDIALS; the extra
        ``sundae``): backward differences, Adams's formulas where a mode is affine and not stiff.
        ``initially_on``: the switches that are on at first, as far as their conditions let them; each
        switch is a column of the result, 1 or 0. States that are not named then follow what these hold:
        the result's ``completed`` has them, and a `ModelWarning` tells. One tells, too, of a switch that
        stays on while its command rests at zero. ``events``: whether the result keeps what happened; without,
        a run of any length takes no more memory than its samples and inputs. ``corners``: whether it
        keeps, too, where laws with `abs`, `max`, `min`, `sign` or `Piecewise` come over a corner, where the
        integration stops and goes on, asked for or not.

        What backend "c" cannot go on with is run by numpy, and a `BackendWarning` tells why.

        Raises `SignalError` for unusable arguments, `SimulationError` if the run can't go on,
        `MissingExtraError` for what the method needs.
        """
        done = self.run_telling(
            tell, time, initial, inputs, method, rtol, atol, initially_on, events, corners
        )
        tell_completed(done.completed)
        tell_resting(self.closed, done)
        return done

    def run_telling(
        self,
        tell: Callable[[Stopped], None],
        time: ArrayLike,
        initial: Mapping[str, float] | str | None = None,
        inputs: Mapping[str, object] | None = None,
        method: str = "auto",
        rtol: float = TUNING.rtol,
        atol: float = TUNING.atol,
        initially_on: Iterable[Hashable] = (),
        events: bool = True,
        corners: bool = False,
    ) -> Result:
        """As `run`; ``tell`` is called where numpy runs what C was asked to.

        Of a limit of C's own it is called before numpy starts, else once numpy has not refused it, too.
        """
        asked, given = self._asked(
            time, initial, inputs, settings_of(method, rtol, atol), initially_on, events, corners
        )
        times, whole = asked.times, Whole(len(asked.times))
        with np.errstate(all="ignore"):
            backend, stopped = run_into(self.closed, asked, self.engine, self.located, whole, tell)
            columns, observer = named_columns(self.closed, times, whole.shots)
        if stopped is not None and not stopped.limit:
            tell(stopped)
        program = self.closed.program
        shown, inner = listed_columns(with_switches(columns, program, whole.modes), program)
        laws, numbers, start = self.laws, self.closed.parameters, read_only(asked.begun.s)
        run = Run(laws, numbers, times, start, tuple(given), asked.settings, asked.begun.mode)
        result = Result(
            times,
            self.states,
            self.inputs,
            self.outputs,
            tuple(whole.events),
            shown,
            observer,
            self.ledger(run),
            told_units(self.closed.equations),
            backend,
            asked.begun.completed,
            inner,
        )
        refuse_all_beyond(self.closed, result)
        return result

    def stream(
        self,
        path: str | PathLike[str],
        time: ArrayLike,
        initial: Mapping[str, float] | str | None = None,
        inputs: Mapping[str, object] | None = None,
        *,
        signals: Iterable[str] | None = None,
        method: str = "auto",
        rtol: float = TUNING.rtol,
        atol: float = TUNING.atol,
        initially_on: Iterable[Hashable] = (),
        events: bool = True,
        corners: bool = False,
    ) -> Streamed:
        """Run as `run` does, but write samples to a file as the run goes on; they are nowhere else.

        So memory is what the times and the inputs take, however many samples and events there are; with
        delays also what these reach back to. ``path``: a file that ends in .csv or .parquet (the extra
        ``tables``), with a column for the time, "t", and one for each of ``signals``: any that a `Result`
        has by name, all its columns if none are told. The numbers are those of `run`, bit for bit. Events go
        to a file beside it, ``run.events.csv`` beside ``run.csv``, as time, port, kind and impulse; without
        ``events`` to none, and one of an earlier run is removed. All else as for `run`.

        While the run goes on, and if it ends halfway, the files have names that tell it, ``run.partial.csv``;
        what was there before takes their place only by whole ones.

        Raises what `run` raises, `SignalError` for a signal or kind of file that there is not,
        `MissingExtraError` without pyarrow, `WriteError` where a file cannot be written.

        >>> import bondgraph as bg, tempfile
        >>> from codegen import simulator
        >>> mass = bg.graph([bg.Se("force", "F"), bg.One("mass"), bg.I("m", "m", flow="v")],
        ...                 "force > mass > m")
        >>> model = simulator(bg.derive(mass), {"m": 2})
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     done = model.stream(f"{folder}/run.csv", [0, 1, 2], inputs={"F": 4}, signals=["v"])
        ...     done.read()
        {'t': array([0., 1., 2.]), 'v': array([0., 2., 4.])}
        >>> done.samples, done.events, done.final["v"]
        (3, 0, 4.0)
        """
        target = Path(path)
        checked_ending(target)
        names = wanted_signals(self.closed, signals)
        settings = settings_of(method, rtol, atol)
        asked, _ = self._asked(time, initial, inputs, settings, initially_on, events, corners)

        def run(sink: Sink) -> str:
            with np.errstate(all="ignore"):
                found = run_into(self.closed, asked, self.engine, self.located, sink, tell)
            backend, stopped = found
            if stopped is not None and not stopped.limit:
                tell(stopped)
            return backend

        done, written = streamed(self.closed, asked, target, names, run)
        tell_completed(done.completed)
        tell_rests(written.resting)
        return done

    def _asked(
        self, time: ArrayLike, initial: Mapping[str, float] | str | None,
        inputs: Mapping[str, object] | None, settings: Settings, initially_on: Iterable[Hashable],
        events: bool, corners: bool,
    ) -> tuple[Request, Sequence[Signal]]:  # fmt: skip
        """A run that is ready to begin, and what it was given as ``inputs``."""
        times = checked_times(time)
        wanted_inputs = {} if inputs is None else inputs
        if self.located is None:
            wanted_inputs = followed(wanted_inputs, times)
        given = signals_for(wanted_inputs, self.inputs, self.whence)
        if self.closed.program.delayed:
            given = self._with_late(given, times, initial, settings, initially_on)
        signals = [*given, *self.sources(float(times[0]), float(times[-1]), found=True)]
        refuse_impulses(self.closed, signals, times)
        on = checked_modes(self.switches, initially_on)
        begin = float(times[0])
        told = self._told(initial, signals, begin)
        with np.errstate(all="ignore"):
            states, begun = started(self.closed, begin, told, signals, on)
        return Request(times, states, begun, signals, settings, events, corners), given

    def stepper(
        self,
        initial: Mapping[str, float] | str | None = None,
        inputs: Mapping[str, object] | None = None,
        *,
        time: float = 0.0,
        method: str = "auto",
        rtol: float = TUNING.rtol,
        atol: float = TUNING.atol,
        initially_on: Iterable[Hashable] = (),
    ) -> Stepper:
        """The model at ``time`` [s], to be stepped from outside under inputs that may change at each step.

        Arguments as of `run`; ``inputs`` are those that hold until others are told. What backend "c" cannot
        step is stepped by numpy, and a `BackendWarning` tells why.

        Raises what `run` raises of a start, and `SignalError` for a time that is no finite number.
        """
        made = self.stepping(initial, inputs, time, method, rtol, atol, initially_on)
        tell_completed(made.completed)
        return made

    def stepping(
        self,
        initial: Mapping[str, float] | str | None,
        inputs: Mapping[str, object] | None,
        time: float,
        method: str,
        rtol: float,
        atol: float,
        initially_on: Iterable[Hashable],
    ) -> Stepper:
        """As `stepper`, without a word on states that were completed."""
        if not is_number(time) or not is_finite(time):
            raise SignalError(f"the time must be a finite number, not {time!r}")
        if len(self.inputs) < len(self.closed.program.asked):
            return self._stepping_late(initial, inputs, time, method, rtol, atol, initially_on)
        given = signals_for({} if inputs is None else inputs, self.inputs, self.whence)
        sources = Sources(partial(self.sources, found=True), float(time))
        told = named_numbers(
            self._told(initial, [*given, *sources.signals], float(time)), self.states
        )
        on = checked_modes(self.switches, initially_on)
        start = Start(tuple(told.items()), on)
        plan = Plan(self.closed)
        settings = settings_of(method, rtol, atol)
        going = going_of(plan, settings, self.engine, self.located, NumpyGoing)
        origin = Origin(self.closed, self.inputs, plan, going, float(time), start)
        return Stepper(origin, given, sources)

    def _stepping_late(
        self, initial: Mapping[str, float] | str | None, inputs: Mapping[str, object] | None, time: float,
        *settings: Any,
    ) -> Stepper:  # fmt: skip
        """The same of a model with delays, which the stepper itself looks after."""
        own = {} if inputs is None else inputs
        signals_for(own, self.inputs, self.whence)
        delays, make = self._told_late(initial, own, time, *settings)
        clocks, sources = self.closed.program.clocks, partial(self.sources, found=True)
        begin = float(time)
        return LateStepper(make, delays, clocks, self.inputs, Sources(sources, begin), begin)

    def _told_late(
        self, initial: Any, own: Mapping[str, object], time: float, *settings: Any
    ) -> tuple[Sequence[Reading], Make]:
        """What delays read, and what makes a stepper that is told what they give beside its ``own``."""
        model = replace(self, inputs=tuple(name.name for name in self.closed.program.asked))

        def make(told: Mapping[str, object]) -> Stepper:
            return model.stepping(initial, {**own, **told}, time, *settings)

        return readings(self.closed.equations.delays, self.closed.parameters), make

    def _told(self, initial: Any, signals: Sequence[Signal], begin: float) -> Any:
        """Initial values by states, as told for a run under these signals."""
        wanted: Any = {} if initial is None else initial
        return self.starting(self._resting(signals, begin) if initial == EQUILIBRIUM else wanted)

    def whence(self, name: str) -> str:
        """Who reads an input, and what else its name may have been meant to be, as messages say it."""
        return whence(name, self.closed.equations, self.laws or {}, self.closed.parameters)

    def ledger(self, run: Run) -> Ledger:
        """What integrates accounts of a run that is over."""
        program = self.closed.program
        names = (*program.states, *program.law_states, *program.inputs, *program.asked)
        told = tuple(name.name for name in names)
        return Ledger(self.closed.declared, told, run.again, self.closed.parameters)

    def steady(
        self, inputs: Mapping[str, float], initial: Mapping[str, float]
    ) -> tuple[list[Piece], Array]:
        """Constant inputs as pieces, and the integrated vector at these states."""
        signals = signals_for(inputs, self.inputs, self.whence)
        pieces = [constant_piece(0.0, signal(0.0)) for signal in signals]
        pieces += [signal.piece(0.0) for signal in self.sources(0.0, 0.0)]
        given = np.array([piece(0.0) for piece in pieces])
        return pieces, self.vector(0.0, initial_values(self.starting(initial), self.states), given)

    def _resting(self, signals: Sequence[Signal], t: float) -> dict[str, float]:
        """The states of an equilibrium under the inputs of one instant, found from the declared starts."""
        pieces = [constant_piece(t, signal(t)) for signal in signals]
        given = np.array([piece(t) for piece in pieces])
        start = self.vector(t, initial_values(self.starting({}), self.states), given)
        found = equilibrium(self.closed, pieces, start)
        return dict(zip(self.states, [*found.x.tolist(), *found.z.tolist()], strict=True))

    def starting(self, initial: Any) -> Any:
        """These initial values by states, with declared ones where nothing else is told."""
        if not isinstance(initial, Mapping):
            return initial
        equations, parameters = self.closed.equations, self.closed.parameters
        told = by_states(equations, parameters, initial)
        return {**told_starts(equations, parameters), **told} if equations.starts else told

    def _with_late(
        self, given: Sequence[Signal], times: Array, initial: Any, settings: Settings,
        on: Iterable[Hashable],
    ) -> list[Signal]:  # fmt: skip
        """The inputs of a run with those that delays give, found by stepping it."""
        begin, end, program = float(times[0]), float(times[-1]), self.closed.program
        own = dict(zip(self.inputs, given, strict=True))
        delays, make = self._told_late(
            initial, own, begin, settings.method, settings.rtol, settings.atol, tuple(on)
        )
        known = [*given, *self.sources(begin, end, found=True)]
        every = own | found_delays(program, delays, make, known, begin, end)
        return [every[name.name] for name in program.asked]

    def sources(self, begin: float, end: float, found: bool = False) -> list[Signal]:
        """What known sources do from ``begin`` to ``end`` [s]; their pieces follow those of the inputs.

        ``found``: whether what delays give is among these.
        """
        return source_signals(self.closed.program, self.closed.parameters, begin, end, found)

    def vector(self, t: float, state: Array, given: Array) -> Array:
        """The integrated vector at a state: x less what inputs that drive dependent storages add."""
        return self.closed.vector(t, state, given)
