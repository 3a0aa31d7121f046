"""Many runs of one affine model from their starts to the end that they share, as `runs.hybrid` does one."""

from collections.abc import Callable, Sequence

import numpy as np

from codegen.abreast.fleet import Fleet
from codegen.abreast.leading import Instant, Leader, Outcome, Precedents, outcomes
from codegen.abreast.modes import ModesAbreast
from codegen.abreast.seen import Group, Seen
from codegen.abreast.stretch import Walk, parted
from codegen.abreast.systems import systems
from codegen.inputs.generators import Generator, generator
from codegen.inputs.present import Inputs, Present
from codegen.inputs.signal import Signal
from codegen.model.snapshot import Mode
from codegen.modes.pace import hardly_apart, look_ahead, time_constant
from codegen.numbers.arrays import Array, dot
from codegen.program.layout import INPUTS, STATES
from codegen.runs.hybrid import changes_of
from codegen.runs.track import Event
from codegen.standalone.arrays import Places
from codegen.tuning import TUNING

NONE = frozenset[int]()

Due = dict[Instant, list[Places]]
"""Runs at whose times something is to be decided, by what they have in common."""


class Course:
    """The loop over many runs: their modes are decided and they are stepped together as far as that goes.

    ``signals``: the external inputs that all share, of which each run has its own sizes. ``precedents``: what
    runs came to before. ``lead``: a run by itself at its time. Runs of which anything is doubtful are left
    alone.
    """

    def __init__(
        self, modes: ModesAbreast, fleet: Fleet, signals: Sequence[Signal], times: Array,
        precedents: Precedents, lead: Callable[[int], Leader],
    ) -> None:  # fmt: skip
        self._model, self._modes, self._fleet = modes.model, modes, fleet
        self._precedents = precedents
        self._times, self._lead, self._inputs = times, lead, Inputs(signals)
        self._begin, self._end = float(times[0]), float(times[-1])
        self._present, self._made = self._driven(self._begin)
        self._settled = False

    def run(self) -> None:
        """To the end of all runs that are not alone."""
        fleet, t = self._fleet, self._begin
        every: Places = np.arange(len(fleet.t))
        modes = {self._model.program.before(()): every}
        while modes:
            self._present, self._made = self._driven(t)
            stop = min(self._present.following, self._end)
            modes, t = self._to(stop, modes, t >= self._end), stop
        fleet.vectors[:, -1] = fleet.s

    def _driven(self, t: float) -> tuple[Present, Generator]:
        """What inputs do from a time on, and the system that gives them."""
        present = self._inputs.at(t)
        return present, generator(present.pieces, present.begin)

    def _to(self, stop: float, modes: dict[Mode, Places], ends: bool) -> dict[Mode, Places]:
        """Runs that are at one time go on to ``stop`` [s], from event to event; ``ends``: they are there."""
        due: Due = {Instant(mode, NONE): [at] for mode, at in modes.items()}
        arrived: dict[Mode, list[Places]] = {}
        while due:
            came: Due = {}
            for now, parts in due.items():
                for mode, at, limits in self._settle(now, self._together(parts), ends):
                    if ends:
                        continue
                    there = self._advance(mode, at, limits, stop, came)
                    arrived.setdefault(mode, []).append(there)
            due, self._settled = came, True
        joined = {mode: self._together(parts) for mode, parts in arrived.items()}
        return {mode: at for mode, at in joined.items() if len(at)}

    def _together(self, parts: list[Places]) -> Places:
        """Runs that are not alone, in their order."""
        at: Places = np.sort(np.concatenate(parts))
        return at[~self._fleet.alone[at]]

    def _settle(self, now: Instant, at: Places, ends: bool) -> list[tuple[Mode, Places, Array]]:
        """Decide the modes of runs just after their times: runs by mode, with what counts as zero there."""
        if not len(at):
            return []
        group = self._seen(now, at)
        if ends:
            self._check_end(now, group)
        found = []
        lead = self._lead
        known = self._precedents
        for one in outcomes(now, group, self._modes, known, lambda place: lead(int(at[place]))):
            runs = at[one.places]
            if one.mode is None:
                self._fleet.alone[runs] = True
                continue
            self._take(now, runs, one)
            found.append((one.mode, runs, one.limits))
        return found

    def _seen(self, now: Instant, at: Places) -> Group:
        """The runs as they are, once their magnitudes and time constants are taken into account."""
        fleet, model = self._fleet, self._model
        vectors = np.hstack([fleet.s[at], self._given(fleet.t[at])])
        forwards = self._modes.of(tuple(sign or 1 for sign in now.mode))
        before = self._modes.of(now.mode)
        assert forwards is not None
        assert before is not None
        maps, sizes = forwards.maps, np.abs(vectors)
        inputs = len(model.program.external)
        sizes[:, -1 - inputs : -1] = 0.0
        x = dot(maps.rows(STATES)[at], vectors)
        terms = dot(np.abs(maps.rows(INPUTS)[at]), sizes)
        fleet.both[at] = np.maximum(fleet.both[at], np.hstack([np.abs(x), terms]))
        if now.mode:
            fastest = np.maximum(before.fastest[at], self._present.fastest)
            elapsed = (fleet.t[at] - self._begin).tolist()
            pairs = zip(fastest.tolist(), elapsed, strict=True)
            fleet.time[at] = [time_constant(rate, age) for rate, age in pairs]
        following = self._present.following
        pairs = zip(fleet.time[at].tolist(), fleet.t[at].tolist(), strict=True)
        ahead = np.array([look_ahead(time, t, following) for time, t in pairs])
        parts = fleet.t[at], fleet.s[at], fleet.both[at], fleet.time[at]
        return Group(at, *parts, ahead, self._given, tuple(sorted(now.loose)))

    def _given(self, times: Array) -> Array:
        """The external inputs that all runs share, their rates and 1, [w, w', 1], at times [s] by rows."""
        g, C = self._components(times), self._made.C[None]
        w = dot(C, g)
        dw = dot(C @ self._made.G, g) if self._model.program.rated else np.zeros_like(w)
        return np.hstack([w, dw, np.ones((len(times), 1))])

    def _components(self, times: Array) -> Array:
        """Those of the inputs' system, at times [s] by rows."""
        return self._made.at(times - self._present.begin)

    def _check_end(self, now: Instant, group: Group) -> None:
        """What may be an event at the very end, missed by a rounding, is looked at by itself."""
        slipping = [i for i, sign in enumerate(now.mode) if sign]
        before = self._modes.of(now.mode)
        assert before is not None
        if slipping:
            seen = Seen(self._modes, before, now.mode, group)
            near = TUNING.surely * TUNING.wide * seen.scales.slip[:, slipping]
            self._fleet.alone[group.at] |= (np.abs(seen.slips[:, slipping]) <= near).any(axis=1)

    def _take(self, now: Instant, runs: Places, found: Outcome) -> None:
        """The runs go on in the mode that they have come to."""
        fleet, mode = self._fleet, found.mode
        assert mode is not None
        n = len(self._model.program.states)
        fleet.s[runs, :n] += found.added
        changes = changes_of(self._model, now.mode, mode) if self._settled else []
        samples = self._times.searchsorted(fleet.t[runs]).tolist()
        moments = [hardly_apart(time) for time in fleet.time[runs].tolist()]
        times = fleet.t[runs].tolist()
        for run, sample, t, moment in zip(runs.tolist(), samples, times, moments, strict=True):
            fleet.note(run, sample, mode)
            fleet.events[run] += [Event(t, port, kind) for port, kind in changes]
            if now.touched:
                fleet.alone[run] |= t - fleet.latest[run] < moment
                fleet.latest[run] = t

    def _advance(self, mode: Mode, at: Places, limits: Array, stop: float, came: Due) -> Places:
        """Step to ``stop`` [s] or to events, which are added to what came; the runs that arrive."""
        fleet, found = self._fleet, self._modes.of(mode)
        assert found is not None
        system = systems(self._model, found, at, self._made, mode)
        limits, step = limits[:, list(system.ports)], float(np.diff(self._times[[0, -1]])[0])
        work = system.norms * (stop - fleet.t[at])
        fleet.alone[at] |= stop - fleet.t[at] <= 8 * np.spacing(stop)
        fleet.alone[at] |= work > (TUNING.many if mode else TUNING.rounded) / TUNING.surely
        z = np.hstack([fleet.s[at], self._components(fleet.t[at])])
        gone = list[Places]()
        for parts, of in parted(system, step / (len(self._times) - 1)).items():
            own = of & ~fleet.alone[at]
            if own.any():
                given = fleet, at[own], system.part(own), parts, z[own], limits[own]
                events = Walk(*given, self._times, stop).go()
                for ports, runs in events.items():
                    came.setdefault(Instant(mode, ports), []).append(runs)
                gone += events.values()
        fleet.alone[at] |= ~np.isfinite(fleet.s[at]).all(axis=1)
        return np.setdiff1d(at, np.concatenate(gone)) if gone else at
