"""Events of many runs in one stretch: told at once where all is sure, else one by one."""

from typing import NamedTuple

import numpy as np

from codegen.abreast.falling import roots, together, told
from codegen.abreast.systems import Strides, Systems
from codegen.numbers.arrays import Array, Flags, dot
from codegen.runs.falls import Falls
from codegen.standalone.arrays import Places


class Stop(NamedTuple):
    """The event of a run: its place in a stretch, when [s], and its ports.

    ``state``: at the step before; ``since`` [s]: how long before.
    """

    place: int
    t: float
    state: Array
    since: float
    ports: frozenset[int]


class Lookout:
    """What is watched in a stretch of runs, and the events that they came to.

    ``limits``: below these triggers count as zero where the stretch begins, at ``t`` [s] with ``z``. ``time``
    [s]: shortest time constants.
    """

    def __init__(self, system: Systems, z: Array, limits: Array, t: Array, time: Array) -> None:
        self._ports, self._limits, self._t, self._time = system.ports, limits, t, time
        self._values = dot(system.triggers, z)
        self._armed: Flags = np.asarray(self._values >= limits)
        self._ready: Flags = np.asarray(self._armed.all(axis=1))
        self._falls = dict[int, Falls]()
        self.stops = list[Stop]()
        #: The runs that have to be done by themselves.
        self.left = list[int]()

    def look(
        self, places: Places, strides: Strides, states: Array, valid: Places, begin: Array,
        done: int,
    ) -> Flags:  # fmt: skip
        """Which runs come to an event in steps from these states, of which so many of each are ``valid``.

        Or are left: what rests so near an event that rounding decides is told by the run itself.
        ``begin`` [s]: of the first step; ``done``: so many were taken before.
        """
        stopped = np.zeros(len(places), dtype=bool)
        if not self._ports:
            return stopped
        shapes = strides.shapes(states[:, :-1])
        least = shapes.reshape(len(places), -1).min(axis=1)
        k = np.flatnonzero(~((least > 0) & self._ready[places]))
        if not len(k):
            return stopped
        own = places[k]
        shapes = shapes[k].reshape(len(k), shapes.shape[1], len(self._ports), -1)
        # What was looked at closer is, until all has been well above zero.
        closer = np.isin(own, [*self._falls])
        armed, noise = self._armed[own] | closer[:, None], strides.noise(states)[k]
        found = told(shapes, valid[k], armed, self._limits[own], noise)
        found.doubtful[closer & ~self._ready[own]] = True
        for j in k[found.doubtful].tolist():
            seen = states[j, : valid[j]]
            stopped[j] = self._closer(int(places[j]), strides, j, seen, float(begin[j]), done)
        stopped[k[found.near]] = True
        self.left += own[found.near].tolist()
        sure = ~(found.near | found.doubtful)
        self._armed[own[sure]] = self._ready[own[sure]] = True
        ended = sure & (found.step >= 0)
        if ended.any():
            j, whole = k[ended], found.step[ended]
            self._stop(
                places[j], strides, j, states[j, whole], found.due[ended], begin[j], done + whole
            )
            stopped[j] = True
        return stopped

    def _stop(
        self, places: Places, strides: Strides, rows: Places, states: Array, due: Flags,
        begin: Array, done: Places,
    ) -> None:  # fmt: skip
        """Note the events in steps from these states, at triggers that surely fall there."""
        steps, taus = strides.steps[rows], np.zeros(due.shape)
        powers = dot(strides.powers[:, rows], states).transpose(1, 2, 0)
        taus[due] = roots(powers[due])
        tau, whose = together(taus, due, begin + done * steps, steps)
        times, since = begin + (done + tau) * steps, tau * steps
        for k, place in enumerate(places.tolist()):
            ports = frozenset(self._ports[row] for row in np.flatnonzero(whose[k]).tolist())
            self.stops.append(Stop(place, float(times[k]), states[k], float(since[k]), ports))

    def _closer(
        self, place: int, strides: Strides, row: int, states: Array, begin: float, done: int
    ) -> bool:
        """Whether one run comes to an event in steps from these states, told as in a run by itself."""
        step, rows = float(strides.steps[row]), strides.powers[:, row]
        powers = states @ rows.reshape(-1, states.shape[1]).T
        powers = powers.reshape(len(states), *rows.shape[:2]).transpose(0, 2, 1)
        falls = self._falls_of(place)
        found = falls.first(powers, begin + done * step, step)
        if falls.ready:
            self._armed[place] = self._ready[place] = True
        if found is None:
            return False
        whole, tau, ports = found
        t = begin + (done + whole + tau) * step
        self.stops.append(Stop(place, t, states[whole], tau * step, ports))
        return True

    def _falls_of(self, place: int) -> Falls:
        if place not in self._falls:
            limits = self._limits[place]
            values = np.where(self._armed[place], np.inf, self._values[place])
            t, time = float(self._t[place]), float(self._time[place])
            self._falls[place] = Falls(self._ports, lambda: limits, t, time, values)
        return self._falls[place]
