"""Many runs of one mode at an instant each, and whether what decided one of them decides the others."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from codegen.abreast.modes import ModeMap, ModesAbreast
from codegen.model.snapshot import Mode
from codegen.modes.choices import Tried
from codegen.modes.rounding import Scales, scales_by
from codegen.numbers.arrays import Array, Flags, dot
from codegen.program.layout import CAPS, INPUTS, RATE, RATES_OF_INPUTS, READINGS, STATES
from codegen.standalone.arrays import Places
from codegen.tuning import TUNING


@dataclass(frozen=True)
class Group:
    """Runs that are looked at together: their places, times [s] and integrated vectors, by rows.

    ``both``: the largest magnitudes of their states and inputs. ``time`` [s]: their shortest time constants.
    ``ahead`` [s]: how far to look where the instant itself does not decide. ``inputs``: [w, w', 1] at times,
    those of each run in the size that all share.
    """

    at: Places
    t: Array
    s: Array
    both: Array
    time: Array
    ahead: Array
    inputs: Callable[[Array], Array]
    #: Ports that are at rest to an event's own rounding.
    loose: tuple[int, ...]

    def part(self, places: Places) -> "Group":
        """Some of them."""
        t, s, both, time, ahead = (
            values[places] for values in (self.t, self.s, self.both, self.time, self.ahead)
        )
        return Group(self.at[places], t, s, both, time, ahead, self.inputs, self.loose)

    def moved(self, s: Array, after: Array) -> "Group":
        """The same after a time [s], with other vectors."""
        return replace(self, t=self.t + after, s=s)

    @cached_property
    def vectors(self) -> Array:
        """What affine modes are maps of."""
        return np.hstack([self.s, self.inputs(self.t)])


class Seen:
    """A group in one mode: what its ports give, may give and receive, and what counts as zero of it."""

    def __init__(self, modes: ModesAbreast, found: ModeMap, mode: Mode, group: Group) -> None:
        self._modes, self._found, self.mode, self._group = modes, found, mode, group
        maps, at, model = found.maps, group.at, modes.model
        #: The runs whose numbers leave no doubt.
        self.sound = found.sound[at]
        values = dot(maps.matrix[at], group.vectors)
        parts = (STATES, INPUTS, RATES_OF_INPUTS, READINGS, CAPS, RATE)
        x, u, du, y, self.caps, self._rate = (values[:, maps.parts[part]] for part in parts)
        self.x, self.u = x, u
        self.efforts, self.slips = u[:, model.friction_inputs], y[:, model.friction_readings]
        by = modes.moves
        self.rates = dot(by.slips[at], np.hstack([x, u]))
        if by.by_rates is not None:
            self.rates = self.rates + dot(by.by_rates[at], du)

    @cached_property
    def scales(self) -> Scales:
        """Below these slips, margins and rates of slips count as zero, by runs and ports."""
        group, moves = self._group, self._modes.moves
        by = type(moves)(
            moves.slips,
            None,
            moves.terms[group.at],
            moves.pushes[group.at],
            moves.mobility[group.at],
        )
        sizes = np.maximum(np.abs(np.hstack([self.x, self.u])), group.both)
        late = TUNING.late * np.spacing(np.abs(group.t))[:, None] * np.abs(self.rates)
        efforts = np.abs(self.efforts) + self.caps
        return scales_by(by, sizes, self.x.shape[1], efforts, late, group.time[:, None])

    @cached_property
    def limits(self) -> Array:
        """Below these what is watched of a port counts as zero."""
        stuck = np.array([sign == 0 for sign in self.mode])
        return np.where(stuck, self.scales.effort, self.scales.slip)

    def settled(self) -> Array:
        """What is added to the states so that ports that stick are at rest."""
        hold = self._found.hold
        if hold is None:
            return np.zeros_like(self.x)
        at = self._group.at
        slips = dot(hold.slip_x[at], self.x) + dot(hold.slip_u[at], self.u)
        return dot(hold.take_away[at], slips)

    def rests(self, ports: Sequence[int]) -> Flags:
        """Where surely these ports are told to be at rest and no others."""
        near = self.scales.slip.copy()
        near[:, list(self._group.loose)] *= TUNING.wide
        sizes, inside = np.abs(self.slips), np.zeros(near.shape[1], dtype=bool)
        inside[list(ports)] = True
        sure = np.where(inside, TUNING.surely * sizes <= near, sizes > TUNING.surely * near)
        return np.asarray(sure.all(axis=1))

    def tells(self, told: Tried) -> Flags:
        """Where surely the mode's ports tell the same of it."""
        found, size = self._stopped(), self.scales
        for port, sign in (told.verdicts or {}).items():
            sticks = self.mode[port] == 0
            value, least = (
                (self._margin(port), size.effort) if sticks
                else (self.mode[port] * self.rates[:, port], size.acceleration)
            )  # fmt: skip
            near = TUNING.surely * least[:, port]
            found &= sign * value > near if sign else TUNING.surely**2 * np.abs(value) <= near
        for port, sign in told.later.items():
            found &= self._tells_later(port, sign)
        return found

    def _tells_later(self, port: int, sign: int) -> Flags:
        """Where a tie surely tells so a moment later; as `Look.later_verdict`."""
        then, size, way = self._later, self.scales, self.mode[port]
        if way == 0:
            margin, near = then._margin(port), size.effort[:, port]
            holds, slips = TUNING.surely * margin >= -near, margin < -TUNING.surely * near
            return np.asarray(holds if sign > 0 else slips)
        rate, slip = way * then.rates[:, port], way * then.slips[:, port]
        moving, near = TUNING.moving * size.acceleration[:, port], size.slip[:, port]
        if sign > 0:
            return np.asarray((rate > TUNING.surely * moving) | (slip > TUNING.surely * near))
        return np.asarray((TUNING.surely * rate <= moving) & (TUNING.surely * slip <= near))

    def _margin(self, port: int) -> Array:
        """How far what a port gives is below its breakaway effort."""
        return np.asarray(self.caps[:, port] - np.abs(self.efforts[:, port]))

    @cached_property
    def _later(self) -> "Seen":
        """The same a little later, by one midpoint step."""
        group, given = self._group, (self._modes, self._found, self.mode)
        ahead = group.ahead
        half = Seen(*given, group.moved(group.s + 0.5 * ahead[:, None] * self._rate, 0.5 * ahead))
        return Seen(*given, group.moved(group.s + ahead[:, None] * half._rate, ahead))

    def _stopped(self) -> Flags:
        """Where no levels are below zero, and ports that stick surely are at rest."""
        found: Flags = np.asarray((self.caps >= 0).all(axis=1))
        stuck = [i for i, sign in enumerate(self.mode) if sign == 0]
        near = TUNING.wide * self.scales.slip[:, stuck]
        found &= (TUNING.surely * np.abs(self.slips[:, stuck]) <= near).all(axis=1)
        return found

    def ways(self, ports: Sequence[int]) -> Array:
        """The signs of what these ports give."""
        return np.asarray(np.sign(self.efforts[:, list(ports)]))

    def sides(self, ports: Sequence[int]) -> Array:
        """The signs of the slips of all other ports."""
        others = [i for i in range(self.slips.shape[1]) if i not in ports]
        return np.asarray(np.sign(self.slips[:, others]))

    def touching(self, ports: Sequence[int]) -> Array:
        """Which of these ports touch one another, where there are several."""
        count = len(self._group.at)
        if len(ports) < 2:
            return np.zeros((count, 0))
        own = list(ports)
        found = self._modes.touching[self._group.at][:, own][:, :, own]
        return np.asarray(found.reshape(count, -1), dtype=float)
