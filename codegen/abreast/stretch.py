"""Smooth stretches of many runs at once, each to the end that they share or to its own first event.

What a run comes to rests on its own numbers alone, never on which others are beside it.
"""

import numpy as np

from codegen.abreast.fleet import Fleet
from codegen.abreast.lookout import Lookout
from codegen.abreast.systems import Strides, Systems, parts_of_steps
from codegen.numbers.arrays import Array, Flags
from codegen.standalone.arrays import Places
from codegen.tuning import TUNING

BLOCK = 64
"""So many steps of each run are taken before events are looked for."""


class Walk:
    """Runs of a fleet ``at`` these places from where they are to ``stop`` [s], in one mode.

    ``parts``: so many steps from sample to sample. ``z``: states and the inputs' components where they begin.
    """

    def __init__(
        self, fleet: Fleet, at: Places, system: Systems, parts: int, z: Array, limits: Array,
        times: Array, stop: float,
    ) -> None:  # fmt: skip
        self._fleet, self._at, self._system, self._parts = fleet, at, system, parts
        self._times, self._stop = times, stop
        self._begin, self._z = fleet.t[at].copy(), z
        self._lookout = Lookout(system, z, limits, fleet.t[at], fleet.time[at])
        self._last = int(times.searchsorted(stop))
        self._step = float(times[-1] - times[0]) / (len(times) - 1)

    def go(self) -> dict[frozenset[int], Places]:
        """Step there: the runs that came to an event, by its ports; the fleet is where its runs are."""
        last, times, step = self._last, self._times, self._step
        first = self._first_samples()
        on = first < last
        target = np.where(on, times[np.minimum(first, len(times) - 1)], self._stop)
        lengths = target - self._begin
        on &= np.abs(lengths - step) <= TUNING.alike * step
        # To the first sample, or where there is none to the end, each its own way.
        heads = np.flatnonzero(~on)
        heads = self._once(heads, lengths[heads], first[heads])
        self._begin[heads] = target[heads]
        first[heads] += 1
        heads = heads[target[heads] < self._stop]
        here = np.sort(np.concatenate([np.flatnonzero(on), heads]))
        tail = self._stop - float(times[last - 1])
        whole = abs(tail - step) <= TUNING.alike * step
        counts = (last - first[here] + whole) * self._parts
        steps = np.full(len(here), step / self._parts)
        even = self._steps(here, steps, counts, first[here], self._parts)
        if not whole and tail > 2 * np.spacing(self._stop):
            self._begin[even] = times[last - 1]
            self._once(even, np.full(len(even), tail), np.full_like(even, last))
        return self._arrived()

    def _once(self, places: Places, lengths: Array, first: Places) -> Places:
        """So far [s] in each run, to a sample or not; the places of those that come to no event."""
        parts = np.maximum(np.ceil(self._system.norms[places] * lengths), 1.0)
        left = self._steps(places, lengths / parts, parts.astype(int), first, 0)
        self._record(left, self._z[left, None], first[np.isin(places, left)])
        return left

    def _first_samples(self) -> Places:
        """Each run's next sample; one that is where it begins, but for the rounding of time, is recorded."""
        times, begin = self._times, self._begin
        first = times.searchsorted(begin)
        due = times[np.minimum(first, len(times) - 1)]
        now = (first < self._last) & (due - begin <= 2 * np.spacing(due))
        self._record(np.flatnonzero(now), self._z[now, None], first[now])
        return np.asarray(first + now)

    def _record(self, places: Places, states: Array, first: Places) -> None:
        """Samples of runs, from each one's first on; none from where the stretch ends on."""
        count, last = states.shape[1], self._last
        if not count or not len(places):
            return
        fleet, runs = self._fleet, self._at[places]
        if self._system.caps.shape[1]:
            levels = states @ self._system.caps[places].transpose(0, 2, 1)
            samples = first[:, None] + np.arange(count)
            below = (levels < 0).any(axis=2) & (samples < last)
            fleet.alone[runs] |= below.any(axis=1)
        own = states[:, :, : fleet.s.shape[1]]
        if (first == first[0]).all():
            end = max(min(int(first[0]) + count, last), int(first[0]))
            fleet.vectors[runs, first[0] : end] = own[:, : end - int(first[0])]
            return
        samples = first[:, None] + np.arange(count)
        rows, columns = np.nonzero(samples < last)
        fleet.vectors[runs[rows], samples[rows, columns]] = own[rows, columns]

    def _steps(
        self, places: Places, steps: Array, total: Places, first: Places, every: int
    ) -> Places:
        """So many steps [s] of each of these runs; the places of those that come to no event.

        ``every``: after so many steps there is a sample, the first of them ``first``; 0: there is none.
        """
        going = np.flatnonzero(total > 0)
        if not len(going):
            return places
        left, total, first = places[going], total[going], first[going]
        z, strides = self._z[left], Strides(self._system, steps[going], left)
        beyond, change = np.zeros_like(z), strides.change(z)
        # Powers of two, so that products have the same shapes whatever other runs do.
        block = min(BLOCK, 1 << (int(total.max()) - 1).bit_length())
        done, ended = 0, list[Places]()
        while len(left):
            states, change = strides.take(change, block)
            base, beyond = z + beyond, beyond + states[:, -1]
            states += base[:, None]
            valid = np.minimum(total - done, block)
            stopped = self._lookout.look(left, strides, states, valid, self._begin[left], done)
            if every:
                begun = done // every
                samples = np.arange(begun + 1, (done + block) // every + 1) * every - done
                self._record(left, states[:, samples], first + begun)
            through = ~stopped & (total <= done + block)
            self._z[left[through]] = states[through, valid[through]]
            ended.append(left[stopped])
            done, more = done + block, ~(stopped | through)
            if not more.all():
                left, total, first = left[more], total[more], first[more]
                z, beyond, change = z[more], beyond[more], change[more]
                strides.keep(more)
        return np.setdiff1d(places, np.concatenate(ended))

    def _arrived(self) -> dict[frozenset[int], Places]:
        """Bring the fleet to where its runs are."""
        fleet, at, n, stops = self._fleet, self._at, self._fleet.s.shape[1], self._lookout.stops
        fleet.t[at], fleet.s[at] = self._stop, self._z[:, :n]
        fleet.alone[at[self._lookout.left]] = True
        found: dict[frozenset[int], list[int]] = {}
        if not stops:
            return {}
        places = np.array([one.place for one in stops])
        states = np.array([one.state for one in stops])
        since = np.array([one.since for one in stops])
        ends = parts_of_steps(self._system.M[places], states, since)
        fleet.s[at[places]] = ends[:, :n]
        fleet.t[at[places]] = [one.t for one in stops]
        for one in stops:
            found.setdefault(one.ports, []).append(int(at[one.place]))
        return {ports: np.array(runs) for ports, runs in found.items()}


def parted(system: Systems, step: float) -> dict[int, Flags]:
    """Runs by how many steps of ``|M| h <= 1`` they take from sample to sample, ``step`` [s] apart."""
    parts = np.maximum(np.ceil(system.norms * step), 1.0)
    # Of many some more, so that few numbers of steps differ: four digits in binary.
    digits = 2.0 ** np.maximum(np.floor(np.log2(parts)) - 3, 0)
    parts = np.ceil(parts / digits) * digits
    return {int(count): parts == count for count in np.unique(parts).tolist()}
