"""Networks that switch, and their currents and voltages without the toolkit.

Between events a mode's motion is exact, by matrix exponentials; events are roots of exactly propagated
triggers. At each, and at each command or step of a source, that mode begins which no port is against.

Assumed: ideal branches with constant values; positive C, L, R; levels of friction that are constant, and
equal to those of breakaway. Charges and currents are as told before the run, and jump at its first instant
to what the first mode allows, as at any other: charge and flux stay with those that an impulse joins. Between
two steps, a twentieth of the fastest swing apart, a trigger turns round no more than once. Where ports
share what is held (in a loop of branches without voltage), any share that each could bear is borne; a port
whose mode nothing determines is told as ``loose``, and its events are a matter of taste. Nothing of a bond
graph is here: networks and numbers in, voltages, currents and events out.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from references.switched.choice import Choice, Mode
from references.switched.modes import Motion
from references.switched.network import Branch, Network, measured, units
from references.switched.pencil import Array, Layout
from references.switched.triggers import first_left

Event = tuple[float, str, str]

EVENTS = 20_000


@dataclass
class Course:
    """What a run found: columns over the times, events ``(time, port, kind)``, ports that were loose."""

    columns: dict[str, Array] = field(default_factory=dict)
    events: list[Event] = field(default_factory=list)
    loose: set[str] = field(default_factory=set)
    modes: list[Mode] = field(default_factory=list)


class Oracle:
    """A network's solution."""

    def __init__(self, network: Network) -> None:
        self._units = units(network)
        self._layout = Layout(measured(network, self._units))
        self._choice = Choice(self._layout)

    def run(self, times: Array) -> Course:
        """Voltages ``u_`` and currents ``i_`` of all branches, just after each time, and the events."""
        seconds = np.asarray(times, dtype=float) / self._units.second
        t, end, course, rows = float(seconds[0]), float(seconds[-1]), Course(), []
        y, first, still = self._layout.start(), True, 0
        mode = self._commanded(tuple(self._before(b, y) for b in self._choice.ports), t)
        breaks = [at for at in self._layout.network.breaks if t < at < end]
        while True:
            y = self._layout.drive(y, t)
            new, y = self._choice.begin(self._commanded(mode, t), y)
            if not first:
                course.events += self._changes(t, mode, new)
            mode, first = new, False
            course.loose |= self._choice.loose(mode, y)
            motion = self._choice.motion(mode)
            assert isinstance(motion, Motion)
            c = motion.read @ y
            stop = min([at for at in breaks if at > t] + [end])
            left = first_left(motion, c, stop - t, (end - float(seconds[0])) / 400)
            later = stop if left is None else min(t + left, stop)
            inside = seconds[(seconds >= t) & ((seconds < later) | (later >= end))]
            rows += [motion.Q @ motion.after(s - t) @ c for s in inside]
            course.modes += [mode] * len(inside)
            if later >= end:
                break
            still = still + 1 if later <= t + 1e-12 * max(1.0, end) else 0
            y, t = motion.Q @ motion.after(later - t) @ c, later
            if still > 20 or len(course.events) > EVENTS:
                raise RuntimeError(f"the judge makes no progress at {t * self._units.second}")
        course.columns = self._columns(np.array(rows))
        return course

    def _before(self, b: Branch, y: Array) -> int:
        """What a port does before the run: what is turned by a voltage or a current goes by what is told."""
        return int(b.kind == "G" and b.sense * (self._layout.stored(b.watched) @ y) > b.value)

    def _commanded(self, mode: Mode, t: float) -> Mode:
        ports = zip(self._choice.ports, mode, strict=True)
        return tuple(int(b.commanded(t)) if b.kind == "K" else way for b, way in ports)

    def _changes(self, t: float, old: Mode, new: Mode) -> list[Event]:
        found = []
        for b, was, now in zip(self._choice.ports, old, new, strict=True):
            if was == now:
                continue
            if b.kind == "F":
                kind = "stick" if now == 0 else "slip" if was == 0 else "cross"
            else:
                kind = "on" if now else "off"
            found.append((t * self._units.second, b.name, kind))
        return found

    def _columns(self, table: Array) -> dict[str, Array]:
        found, by = {}, self._units
        for b in self._layout.network.branches:
            found[f"u_{b.name}"] = table @ self._layout.voltage(b) * by.volt
            found[f"i_{b.name}"] = table @ self._layout.flow(b) * by.ampere
        return found
