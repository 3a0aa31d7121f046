"""The event-driven loop: smooth legs between breakpoints, and what ports do where these meet."""

import math
from collections import deque
from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from bondgraph.errors import SimulationError
from codegen.inputs.pieces import Piece
from codegen.inputs.present import Inputs, Present
from codegen.inputs.signal import Signal
from codegen.instants.parts import Part, hits, parts_of
from codegen.model.kept import Kept
from codegen.model.snapshot import Mode, Snapshot
from codegen.modes.choices import Choices, Occasion
from codegen.modes.choose import decide
from codegen.modes.closed import ClosedModel
from codegen.modes.crossings import Crossings
from codegen.modes.glances import Glances
from codegen.modes.pace import hardly_apart, look_ahead, time_constant
from codegen.modes.rounding import Peaks, scales
from codegen.modes.trials import Sight, sides
from codegen.numbers.arrays import Array
from codegen.numbers.latest import Latest
from codegen.program.records import FrictionPort
from codegen.runs.clock import NONE, Clock
from codegen.runs.cornered import CorneredLeg
from codegen.runs.exact import ExactLeg
from codegen.runs.free import FreeLeg
from codegen.runs.legs import Leg, leg_of
from codegen.runs.methods import EXACT
from codegen.runs.stretches import Stretches
from codegen.runs.track import BLOCK, LATEST, Accumulating, Event, Settings, Taker, Track
from codegen.standalone.switchings import way_of
from codegen.tuning import TUNING


@dataclass(frozen=True)
class Stretch:
    """A run to its end: what it recorded, and the integrated vector and the mode there."""

    track: Track
    s: Array
    mode: Mode


def run_hybrid(
    model: ClosedModel,
    times: Array,
    start: Array,
    signals: Sequence[Signal],
    settings: Settings,
    tally: Accumulating | None = None,
    first: Mode | None = None,
    keeping: bool = True,
    corners: bool = False,
    taker: Taker | None = None,
) -> Stretch:
    """Integrate over ``times`` [s], recording the vector at each of them.

    At a breakpoint or an event a sample shows the instant just after. ``tally``: what is integrated on
    the way. ``first``: how switches are before the run begins, friction as it likes; all let go unless told.
    ``keeping``: whether events are kept; without them nothing grows with the length of a run but its samples.
    ``corners``: whether those of laws are among them. ``taker``: takes samples and events as the run goes
    on, so that it keeps none.
    """
    course = Course(model, times, start, signals, settings, first, taker)
    course.track.tally, course.track.keeping, course.track.cornered = tally, keeping, corners
    if tally is not None:
        tally.within(course.track)
    course.arrive()
    course.settle()
    course.track.record(course.s, course.mode)
    if tally is not None:
        tally.record()
    course.track.hand_over()
    return Stretch(course.track, course.s, course.mode)


class Course:
    """Where a run is: time, integrated vector, mode; and the ports whose event it has come to.

    It may pause where it ends, and go on from there.
    """

    def __init__(
        self, model: ClosedModel, times: Array, start: Array, signals: Sequence[Signal],
        settings: Settings, first: Mode | None, taker: Taker | None = None,
    ) -> None:  # fmt: skip
        begin = float(times[0])
        self.t, self.s, self.end = begin, start, float(times[-1])
        self.mode: Mode = tuple(1 for _ in model.friction_inputs) if first is None else first
        room = len(times) if taker is None else min(len(times), BLOCK + 1)
        self.track = Track(np.zeros((room, model.size)), [], np.abs(start), taker=taker)
        self._model, self._times, self._inputs = model.within(self.track), times, Inputs(signals)
        self._settings, self._origin = settings, begin
        self._clock, self._stretches = Clock(self._model), Stretches(self._model)
        self._crossings = Crossings(self._model)
        glances = Glances(self._model) if self._model.switches else None
        self._first_looks = glances, None if glances is None else Choices(glances)
        self._changes = Latest[tuple[Mode, Mode], list[tuple[Hashable, str]]]()
        self._clear = False
        self._touched = frozenset[int]()
        self._settled: float | None = None
        #: Up to when [s] tasks have set what they set.
        self._done = -math.inf
        #: Whether the mode of the present instant is none that could go on, as a run may end with.
        self._excused = False
        #: The instant at which it paused, where that is decided again.
        self._paused: float | None = None
        self._before: Sequence[Piece] | None = None
        self._peaks, self._rounds = Peaks.none(model), deque[float](maxlen=TUNING.stalled)

    def arrive(self) -> None:
        """Go on to the end, where the mode is not decided yet."""
        while self.t < self.end:
            if self._touched or self.t != self._settled:
                self.settle()
            self.advance()

    def on_to(self, end: float) -> None:
        """Go on from the present instant, with nothing recorded but what happens."""
        self.end, self._times = end, np.array([self.t, end])
        self.track.recorded = 1
        self.track.modes, self.track.events = [self.mode], []

    def under(self, signals: Sequence[Signal]) -> None:
        """Other inputs from the present instant on."""
        self._inputs = Inputs(signals)

    def kept(self) -> Kept:
        """Where the run is, to go on from there."""
        decided = self._settled == self.t and not self._touched and not self._excused
        return Kept(
            self.t,
            self._origin,
            self._done,
            tuple(self.s.tolist()),
            self.mode,
            self._touched,
            self._settled is not None,
            decided,
            tuple(self.track.largest.tolist()),
            self._peaks.kept(),
            self._crossings.kept(),
            tuple(self._rounds),
        )

    def take_up(self, kept: Kept) -> None:
        """Be where a run was that was kept, under the inputs as they are."""
        self.t, self._origin, self.s = kept.t, kept.began, np.array(kept.s)
        self._done = kept.done
        self.mode, self._touched = kept.mode, kept.touched
        self._settled = kept.t if kept.decided else -math.inf if kept.begun else None
        self._clear, self._excused = False, False
        self._paused = None if kept.decided else kept.t
        self.track.largest = np.array(kept.largest)
        self._peaks = Peaks.again(kept.peaks)
        self._crossings.take_up(kept.crossings)
        self._rounds = deque(kept.rounds, maxlen=TUNING.stalled)
        self._here = Sight(self._model, self.t, self.s, self._inputs.at(self.t).pieces)

    def look(self) -> Snapshot:
        """Everything at the present instant, which is decided."""
        return self._here.at(self.mode)

    @property
    def _slipping(self) -> frozenset[int]:
        """Ports that slip, but for those whose slip efforts change at once."""
        coupled = self._model.coupled_directly
        return frozenset(i for i, sign in enumerate(self.mode) if sign and not coupled(i))

    def settle(self) -> None:
        """Decide the mode just after t, and bring ports that hold to rest."""
        model, t, peaks, present = self._model, self.t, self._peaks, self._inputs.at(self.t)
        pieces, self._excused = present.pieces, False
        here = Sight(model, t, self.s, pieces)
        peaks.see(here, self.mode)
        if self.mode:
            peaks.time = time_constant(self._fastest(here, present), t - self._origin)
        ahead = look_ahead(peaks.time, t, present.following)
        if (t >= self.end or t == self._paused) and self._settled is not None:
            # The search may have missed an event at the very end by a rounding.
            self._touched |= _still(here, self.mode, self._slipping, peaks)
        # A breakpoint may set the slips anew, so sticking ports are decided again with the others.
        loose = self._touched | {i for i, sign in enumerate(self.mode) if sign == 0}
        occasion = Occasion(
            model, t, pieces, self.mode, ahead, peaks, loose, self._touched, *self._first_looks
        )
        due = self._due()
        parts = self._decided(occasion, here, due)
        self._done = t if due else self._done
        new, self._clear = parts[-1].mode, parts[-1].clear
        self._note(parts, self._settled is None)
        counted = self._touched - self._crossings.of(self.mode, new)
        thrown = any(one.thrown for part in parts for one in part.impacts)
        if self._settled is not None and counted and not thrown:
            _check_progress(self._rounds, t, hardly_apart(peaks.time), self.track.events)
        if parts[-1].s is not here.s:
            here = Sight(model, t, parts[-1].s, pieces)
        self._crossings.take(here, new, self._touched, peaks)
        self._come_to_rest(here, parts)
        rests = any(self.mode[i] and new[i] == 0 for i in model.hung)
        self.mode, self._touched, self._settled = new, frozenset(), t
        self._here = here if self.s is here.s else Sight(model, t, self.s, pieces)
        if rests:
            # What was left of a leap is gone, and what goes with it may rest, too.
            self.settle()

    def _due(self) -> frozenset[int]:
        """The tasks whose instant the present one is, and which have not set yet what they set."""
        if self.t <= self._done:
            return NONE
        clocks = self._model.program.clocks
        return frozenset(at for at, one in enumerate(clocks) if one.strikes(self.t))

    def _decided(self, now: Occasion, here: Sight, due: frozenset[int]) -> list[Part]:
        """What an instant comes to; the last mode where a run ends so soon that none needs to go on.

        As where a level comes down to zero at the end: what would follow, a level below, does not. A
        run begins with no event.
        """
        if self._settled is None:
            return parts_of(decide, now, here, due, begins=True)
        try:
            return parts_of(decide, now, here, due)
        except SimulationError:
            if self.t + now.ahead < self.end:
                raise
            here.at(self.mode)
            self._excused = True
            return [Part(self.mode, self.mode, (), here.s)]

    def _note(self, parts: Sequence[Part], begins: bool) -> None:
        """Tell what has happened; as a run begins what state machines do before all else."""
        for part in parts:
            modes = part.before, part.mode
            if begins and part is parts[0]:
                taken = _transitions(self._model.program.friction, *modes)
                self.track.note([Event(self.t, *one) for one in taken])
                continue
            changes = self._changes.of(modes, partial(changes_of, self._model, *modes))
            self.track.note(_told(self._model, self.t, changes, part))

    def _fastest(self, here: Sight, present: Present) -> float:
        """The largest rate [1/s] of what can be evaluated here, and of the inputs."""
        try:
            affine = self._model.affine_map(self.mode, len(present.pieces))
        except SimulationError:
            affine = None
        if affine is not None and not affine.limited:
            # It surely has values.
            return max(affine.fastest, present.fastest)
        mode, _ = here.evaluated(self.mode, slipping=False)
        return self._leg(present.pieces, mode).fastest(here.t, here.s)

    def _come_to_rest(self, here: Sight, parts: Sequence[Part]) -> None:
        before, tally, pieces, mode = self.s, self.track.tally, here.pieces, parts[-1].mode
        self.s = _at_rest(here, mode)
        # What happens before the first sample is not of the run.
        if tally is not None and self._before is not None:
            tally.step(self.t, self._before, pieces, before, mode)
            for part in parts:
                for impact in part.impacts:
                    tally.impact(self.t, pieces, mode, before, impact)
                    before = impact.s
                if part.reset is not None:
                    tally.reset(self.t, pieces, mode, part.s, part.reset)
                before = part.end
            tally.rest(self.t, pieces, mode, here.s, self.s)
        self._before = pieces

    def advance(self) -> None:
        """Integrate to the next breakpoint or event."""
        present = self._inputs.at(self.t)
        pieces, stop = present.pieces, min(present.following, self.end)
        instant, timed = self._clock.following(self.t, pieces, self.mode, stop)
        tick = min((c.following(self.t) for c in self._model.program.clocks), default=math.inf)
        stop = min(stop, instant, tick)
        exact = self._exact(pieces, stop)
        if exact is not None:
            begin, s, first = self.t, self.s, self.track.recorded
            self.t, self.s, ended = exact.run(stop, self._times, self.track)
            self._touched = ended or (timed if self.t == instant else NONE)
            self._back_to_sample(begin)
            self._integrate(pieces, begin, s, first)
        else:
            begin, leg = self.t, self._leg(pieces, self.mode)
            self.t, self.s, ended = leg.run(self.t, self.s, stop, self._times, self.track)
            self._touched = ended or (timed if self.t == instant else NONE)
            self._back_to_sample(begin)

    def _back_to_sample(self, begin: float) -> None:
        """Where a switch changes over a rounding after a sample, that shows the instant just after, too."""
        track, switching = self.track, self._model.switching
        due = self._due()
        if not track.recorded or not (due or any(switching[i] for i in self._touched)):
            return
        last = float(self._times[track.recorded - 1])
        if last > begin and self.t - last <= TUNING.together * max(abs(self.t), self.t - begin):
            self.t = self.t if due else last
            track.unrecord()

    def _integrate(self, pieces: Sequence[Piece], begin: float, s: Array, first: int) -> None:
        """An exact stretch is integrated from sample to sample, however it was stepped."""
        tally, own = self.track.tally, slice(first, self.track.recorded)
        if tally is not None:
            points = np.concatenate([[begin], self._times[own], [self.t]])
            vectors = np.vstack([s, self.track.vectors[own], self.s])
            tally.exact(pieces, self.mode, points, vectors)

    def _leg(self, pieces: Sequence[Piece], mode: Mode) -> Leg | CorneredLeg:
        return leg_of(self._model, pieces, mode, self._settings, self._origin, self._peaks)

    def _exact(self, pieces: Sequence[Piece], stop: float) -> ExactLeg | FreeLeg | None:
        """The stretch ahead as an exact one, where the mode is affine and exact steps are asked for."""
        model, method = self._model, self._settings.method
        if method not in ("auto", EXACT):
            return None
        affine = model.affine_map(self.mode, len(pieces))
        if affine is not None and model.program.guards_affine:
            leg = ExactLeg(self._here, self.mode, affine, self._stretches, self._peaks, self._clear)
            if not self.mode and leg.steps(stop) > TUNING.rounded and model.sharp_rates is not None:
                return FreeLeg(model.sharp_rates, pieces, self.t, self.s)
            return leg if leg.quick(stop, method == EXACT) else None
        if method == EXACT:
            reset = ", or what one resets a state to," if model.program.resets else ""
            reason = f"a condition of a switch{reset} is not affine"
            if affine is None:
                reason = "the model is not affine, or ports that stick share a load"
            raise SimulationError(
                f"at t = {self.t:.9g} {reason} for exact steps; let method be auto"
            )
        return None


def _still(here: Sight, mode: Mode, ports: frozenset[int], peaks: Peaks) -> frozenset[int]:
    """Those of the ports that are at rest, or close enough for it to be the event's own rounding.

    A stop is met where its gap is closed, not where it is at rest; what keeps a switch with a condition of
    its own is that.
    """
    ports -= {*here.model.stopping, *here.model.guarded}
    if not ports:
        return frozenset()
    known, now = here.evaluated(mode)
    model = here.model
    ports -= sides(here, known, ports).keys()
    slips = np.abs(now.y[model.friction_readings])
    limits = TUNING.wide * scales(model, now, here.t, peaks).slip
    return frozenset(
        i for i in ports
        if i in model.hung or slips[i] <= limits[i] or model.coupled_directly(i)
    )  # fmt: skip


def _at_rest(here: Sight, mode: Mode) -> Array:
    """Remove what slip is left at sticking ports, along ``A^-1 F^T``: no energy but the slip's own."""
    model = here.model
    if all(mode) or not model.stops(mode):
        return here.s
    now = here.at(mode)
    held = model.hold(mode, now.numbers)
    n = len(here.model.program.states)
    s = here.s.copy()
    s[:n] += held.take_away @ held.slips(now.x, now.u)
    return s


def _transitions(ports: Sequence[FrictionPort], old: Mode, new: Mode) -> list[tuple[Hashable, str]]:
    """The transitions that state machines have taken, by the machine."""
    return [
        (taken.machine.name, taken.words)
        for port, before, after in zip(ports, old, new, strict=True)
        if (taken := port.transition) is not None
        and port.switch is not None and before != after and port.switch.is_on(after)
    ]  # fmt: skip


def changes_of(model: ClosedModel, old: Mode, new: Mode) -> list[tuple[Hashable, str]]:
    """What happens to ports whose mode is another: to switches, then what friction does about it."""
    switching: list[tuple[Hashable, str]] = []
    rubbing: list[tuple[Hashable, str]] = []
    for i, port in enumerate(model.program.friction):
        before, after = old[i], new[i]
        if port.slides:
            # Which way it slips by the modes of both, told by the first.
            before, after = (way_of(mode, i) if port.way > 0 else 0 for mode in (old, new))
        if before == after:
            continue
        if port.transition is not None:
            switching += _transitions((port,), (before,), (after,))
        elif port.switch is not None and not port.slides:
            switching.append((port.name, port.switch.word(after)))
        else:
            kind = port.words[0 if after == 0 else (1 if before == 0 else 2)]
            rubbing += [(port.name, kind)] if kind else []
    return switching + rubbing


def _told(
    model: ClosedModel, t: float, changes: Sequence[tuple[Hashable, str]], part: Part
) -> list[Event]:
    """What has happened at an instant: first what was thrown back, impact by impact.

    The rest of a port's impulses goes with its change; of a stop that does not change, it is a hit.
    """
    if not part.impacts:
        return [Event(t, port, kind) for port, kind in changes]
    names = [port.name for port in model.program.friction]
    told, rest = list[Event](), dict[Hashable, float]()
    for one in part.impacts:
        given = one.strike.given[model.friction_inputs]
        for i in np.flatnonzero(given).tolist():
            if i in one.thrown:
                told.append(Event(t, names[i], "hit", float(given[i])))
            else:
                rest[names[i]] = rest.get(names[i], 0.0) + float(given[i])
    for i, impulse in hits(model, part.before, part.mode, part.impacts).items():
        told.append(Event(t, names[i], "hit", impulse))
    return told + [Event(t, port, kind, rest.get(port, 0.0)) for port, kind in changes]


def _check_progress(rounds: deque[float], t: float, least: float, events: list[Event]) -> None:
    """Refuse to go on when too many of the latest legs end in an event within ``least`` [s]."""
    rounds.append(t)
    if len(rounds) == TUNING.stalled and t - rounds[0] < least:
        latest = ", ".join(f"{e.kind} {e.port!r} at {e.time:.12g}" for e in events[-LATEST:])
        raise SimulationError(
            f"{TUNING.stalled} events within {least:.3g} s of t = {t:.12g}: the run makes no progress "
            f"(latest: {latest or 'none that changed a mode'})"
        )
