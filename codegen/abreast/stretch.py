"""Smooth stretches of many runs at once, each to the end that they share or to its own first event."""

from typing import NamedTuple

import numpy as np

from codegen.abreast.falling import roots, together, told
from codegen.abreast.fleet import Fleet
from codegen.abreast.systems import Strides, Systems, parts_of_steps
from codegen.numbers.arrays import Array
from codegen.runs.falls import Falls
from codegen.tuning import TUNING


class Stop(NamedTuple):
    """The event of a run: its place in a stretch, when [s], the state at the step before, how long before [s],
    and the ports."""

    place: int
    t: float
    state: Array
    since: float
    ports: frozenset[int]


class Walk:
    """Runs of a fleet ``at`` these places from where they are to ``stop`` [s], in one mode.

    ``z``: states and the inputs' components where they begin. ``limits``: below these their triggers count as
    zero there.
    """

    def __init__(
        self, fleet: Fleet, at: Array, system: Systems, z: Array, limits: Array, times: Array
    ) -> None:
        self._fleet, self._at, self._system, self._times = fleet, at, system, times
        self._begin, self._z, self._limits = fleet.t[at].copy(), z, limits
        self._n = fleet.s.shape[1]
        self._values = np.einsum("rji,ri->rj", system.triggers, z)
        self._armed = self._values >= limits
        self._ready = self._armed.all(axis=1)
        self._falls = dict[int, Falls]()
        self._stops = list[Stop]()

    def to(self, stop: float) -> dict[frozenset[int], Array]:
        """Go there. The runs that came to an event, by its ports; fleet's times and vectors are where they are."""
        fleet, at, times = self._fleet, self._at, self._times
        last = int(times.searchsorted(stop))
        first = self._first_samples(last)
        here, t = np.arange(len(at)), self._begin
        step = float(times[-1] - times[0]) / (len(times) - 1)
        target = np.where(first < last, times[np.minimum(first, len(times) - 1)], stop)
        lengths = target - t
        off = np.abs(lengths - step) > TUNING.alike * step
        if (off | (first >= last)).any():
            # To the first sample, each its own way; from there all alike.
            here = self._steps(here, lengths, np.ones(len(here), dtype=int), first, last)
            t, first = target[here], first[here] + 1
            here, t, first = self._beyond(here, t, first, last, stop)
        else:
            first = first[here]
        if len(here):
            tail = stop - float(times[last - 1])
            whole = abs(tail - step) <= TUNING.alike * step
            counts = np.maximum(last - first, 0) + whole
            going = here[counts > 0]
            resting = here[counts == 0]
            ended = self._steps(
                going, np.full(len(going), step), counts[counts > 0], first[counts > 0], last
            )
            here = np.sort(np.concatenate([ended, resting]))
            if not whole and tail > 2 * np.spacing(stop) and len(here):
                ones = np.ones(len(here), dtype=int)
                here = self._steps(here, np.full(len(here), tail), ones, ones * last, last)
        return self._arrived(stop)

    def _beyond(
        self, here: Array, t: Array, first: Array, last: int, stop: float
    ) -> tuple[Array, Array, Array]:
        """The runs that have not come to the end yet."""
        left = t < stop
        return here[left], t[left], first[left]

    def _first_samples(self, last: int) -> Array:
        """Each run's next sample; one that is where it begins, but for the rounding of time, is recorded."""
        fleet, at, times = self._fleet, self._at, self._times
        first = times.searchsorted(self._begin)
        due = np.minimum(first, len(times) - 1)
        now = (first < last) & (times[due] - self._begin <= 2 * np.spacing(times[due]))
        self._record(np.flatnonzero(now), self._z[now, None], first[now], last)
        return np.asarray(first + now)

    def _record(self, places: Array, states: Array, first: Array, last: int) -> None:
        """Samples of runs, from each one's first on; none from ``last`` on."""
        count = states.shape[1]
        if not count or not len(places):
            return
        fleet, runs = self._fleet, self._at[places]
        if len(self._system.caps[0]):
            levels = states @ self._system.caps[places].transpose(0, 2, 1)
            fleet.alone[runs] |= levels.reshape(len(places), -1).min(axis=1) < 0
        own = states[:, :, : self._n]
        if (first == first[0]).all():
            end = min(int(first[0]) + count, last)
            fleet.vectors[runs, first[0] : end] = own[:, : max(end - int(first[0]), 0)]
            return
        samples = first[:, None] + np.arange(count)
        rows, columns = np.nonzero(samples < last)
        fleet.vectors[runs[rows], samples[rows, columns]] = own[rows, columns]

    def _steps(self, places: Array, h: Array, counts: Array, first: Array, last: int) -> Array:
        """So many steps of h [s] of each of these runs; the places of those that come to no event.

        ``first``: the sample at the end of the first step.
        """
        if not len(places):
            return places
        norms = self._system.norms[places]
        parts = max(1, int(np.ceil((norms * h).max())))
        steps, total = h / parts, counts * parts
        strides = Strides(self._system, steps, places)
        z, begin = self._z[places], self._begin[places]
        beyond, change = strides.begun(z)
        live, done = np.arange(len(places)), 0
        survivors = np.zeros(len(places), dtype=bool)
        ends = begin + counts * h
        while len(live):
            block = max(1, min(TUNING.abreast // len(live), int(total[live].max()) - done))
            states, change = strides.take(change, block)
            base, beyond = z[live] + beyond, beyond + states[:, -1]
            states += base[:, None]
            valid = np.minimum(total[live] - done, block)
            stopped = self._look(places[live], strides, states, valid, begin[live], steps[live], done)
            begun = done // parts + 1
            samples = np.arange(begun, (done + block) // parts + 1) * parts - done
            self._record(places[live], states[:, samples], first[live] + begun - 1, last)
            through = ~stopped & (total[live] <= done + block)
            rows = live[through]
            self._z[places[rows]] = states[through, valid[through]]
            self._begin[places[rows]], survivors[rows] = ends[rows], True
            left = ~(stopped | through)
            done += block
            if not left.all():
                change, beyond, live = change[left], beyond[left], live[left]
                strides.keep(left)
        return places[survivors]

    def _look(
        self, places: Array, strides: Strides, states: Array, valid: Array, begin: Array,
        steps: Array, done: int,
    ) -> Array:  # fmt: skip
        """Which runs come to an event in steps from these states, each so many; it is noted."""
        stopped = np.zeros(len(places), dtype=bool)
        if not self._system.ports:
            return stopped
        shapes = strides.shapes(states[:, :-1])
        least = shapes.reshape(len(places), -1).min(axis=1)
        k = np.flatnonzero(~((least > 0) & self._ready[places]))
        if not len(k):
            return stopped
        own, count = places[k], len(self._system.ports)
        shapes = shapes[k].reshape(len(k), shapes.shape[1], count, -1)
        found = told(shapes, valid[k], self._armed[own], self._limits[own])
        for j in k[found.doubtful].tolist():
            t = float(begin[j]), done, float(steps[j])
            stopped[j] = self._closer(int(places[j]), strides, j, states[j, : valid[j]], *t)
        sure = k[~found.doubtful]
        self._armed[places[sure]] = self._ready[places[sure]] = True
        ended = ~found.doubtful & (found.step >= 0)
        if ended.any():
            j, whole = k[ended], found.step[ended]
            stopped[j] = True
            t = begin[j], done + whole, steps[j]
            self._stop(places[j], strides, j, states[j, whole], found.due[ended], *t)
        return stopped

    def _stop(
        self, places: Array, strides: Strides, rows: Array, states: Array, due: Array,
        begin: Array, done: Array, steps: Array,
    ) -> None:  # fmt: skip
        """Note the events in steps from these states, at triggers that surely fall there."""
        powers = np.matmul(strides.powers[:, rows], states[:, :, None])[..., 0].transpose(1, 2, 0)
        taus = np.zeros(due.shape)
        taus[due] = roots(powers[due])
        tau, whose = together(taus, due, begin + done * steps, steps)
        times = begin + (done + tau) * steps
        for k, place in enumerate(places.tolist()):
            ports = frozenset(self._system.ports[row] for row in np.flatnonzero(whose[k]).tolist())
            since = float(tau[k] * steps[k])
            self._stops.append(Stop(place, float(times[k]), states[k], since, ports))

    def _closer(
        self, place: int, strides: Strides, row: int, states: Array, begin: float, done: int,
        step: float,
    ) -> bool:  # fmt: skip
        """Whether one run comes to an event in steps from these states, told as in a run by itself."""
        rows = strides.powers[:, row]
        powers = (states @ rows.reshape(-1, states.shape[1]).T).reshape(len(states), *rows.shape[:2])
        falls = self._falls_of(place)
        found = falls.first(powers.transpose(0, 2, 1), begin + done * step, step)
        self._ready[place] = falls.ready
        if found is None:
            return False
        whole, tau, ports = found
        t = begin + (done + whole + tau) * step
        self._stops.append(Stop(place, t, states[whole], tau * step, ports))
        return True

    def _falls_of(self, place: int) -> Falls:
        if place not in self._falls:
            run, limits = self._at[place], self._limits[place]
            self._falls[place] = Falls(
                self._system.ports, lambda: limits, float(self._fleet.t[run]),
                float(self._fleet.time[run]),
                np.where(self._armed[place], np.inf, self._values[place]),
            )  # fmt: skip
        return self._falls[place]

    def _arrived(self, stop: float) -> dict[frozenset[int], Array]:
        """Bring the fleet to where its runs are."""
        fleet, at, n = self._fleet, self._at, self._n
        fleet.t[at], fleet.s[at] = stop, self._z[:, :n]
        if not self._stops:
            return {}
        places = np.array([one.place for one in self._stops])
        states = np.array([one.state for one in self._stops])
        since = np.array([one.since for one in self._stops])
        ends = parts_of_steps(self._system.M[places], states, since)
        fleet.s[at[places]] = ends[:, :n]
        fleet.t[at[places]] = [one.t for one in self._stops]
        found: dict[frozenset[int], list[int]] = {}
        for one in self._stops:
            found.setdefault(one.ports, []).append(int(at[one.place]))
        return {ports: np.array(runs) for ports, runs in found.items()}
