"""Where modes are decided, and choices that a first look makes again where every mode tells the same.

What a mode tells are signs of combinations that are linear in the integrated vector and the inputs, as long
as none of them is near zero: those of all modes that were tried are looked at in one product.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from codegen.inputs.pieces import Piece
from codegen.model.snapshot import Impact, Mode
from codegen.modes.closed import ClosedModel
from codegen.modes.glances import GENEROUS, Bounds, Glances, Judged
from codegen.modes.rounding import Peaks
from codegen.modes.trials import Sight
from codegen.numbers.arrays import Array, all_of
from codegen.numbers.latest import Latest, room_for

LONGEST = 8
"""So many modes are tried on the way to one that is kept, at the most."""

VAIN = 255
"""After so many that were kept in vain at the most, another one is."""


class Told(NamedTuple):
    """What a mode tells: ``rows`` over [s, w, w', 1] are above ``least``, and ``sizes`` up to ``most``."""

    rows: Array
    least: Array
    sizes: Array
    most: Array


@dataclass(frozen=True)
class Choice:
    """The mode that a choice comes to, and what has to be so for it: as in `Told`, rows and sizes in one.

    ``both``: magnitudes up to which bounds hold; ``units``: what these are in.
    """

    mode: Mode
    rows: Array
    least: Array
    most: Array
    both: Array
    units: Array

    def holds(self, vector: Array, units: Array, both: Array) -> bool:
        """Whether it is made again."""
        if units is not self.units:
            return False
        values, count = self.rows.dot(vector), len(self.least)
        return (
            all_of(values[:count] > self.least)
            and all_of(np.abs(values[count:]) <= self.most)
            and all_of(both <= self.both)
        )


class Choices:
    """The latest choices of a run, by the mode before and the switches that were asked."""

    def __init__(self, glances: Glances) -> None:
        self._glances = glances
        self._kept = Latest[tuple[Mode, tuple[int, ...]], Choice](room_for(16 * glances.size**2))
        self._looked = self._vain = 0

    def again(self, before: Mode, asked: Sequence[int], here: Sight, peaks: Peaks) -> Mode | None:
        """The mode, where a choice is made again."""
        choice = self._kept.get((before, tuple(asked)))
        if choice is None:
            return None
        units = self._glances.units_at(peaks.time, here.t)
        if not choice.holds(here.vector, units, peaks.both):
            return None
        self._vain = 0
        return choice.mode

    def keep(
        self, before: Mode, asked: Sequence[int], modes: Sequence[Mode], here: Sight, peaks: Peaks
    ) -> None:
        """Keep what a first look at one mode after the other came to; ever more rarely if it is in vain."""
        self._looked += 1
        if self._looked % (self._vain + 1) or len(modes) > LONGEST:
            return
        self._vain = min(2 * self._vain + 1, VAIN)
        units, both = self._glances.units_at(peaks.time, here.t), peaks.both
        told = []
        for mode in modes:
            judged = self._glances.judged(mode)
            one = None if judged is None else _told(judged, here.vector, units, both, asked)
            if one is None:
                return
            told.append(one)
        rows = np.vstack([*(one.rows for one in told), *(one.sizes for one in told)])
        least, most = (np.concatenate([one[part] for one in told]) for part in (1, 3))
        key = before, tuple(asked)
        made = Choice(modes[-1], rows, least, most, GENEROUS * both, units)
        self._kept.put(key, made)


def _told(
    judged: Judged, vector: Array, units: Array, both: Array, asked: Sequence[int]
) -> Told | None:
    """What a mode tells at a vector, beside bounds for larger magnitudes; None where signs do not tell."""
    found, first, ports = judged.glance, judged.first, judged.glance.shock.shape[1]
    ways = [found.rows]
    if len(found.shock) == 1:
        # After the impact that stops the one slip.
        ways.append(found.rows + np.outer(found.jump[0], found.rows[ports]))
    values = [rows.dot(vector) for rows in ways]
    sizes = np.max([np.abs(one[first:]) for one in values], axis=0)
    bounds, most = judged.larger(sizes, units, both)
    signs = _signs(judged, ways, values, bounds, asked)
    if signs is None:
        return None
    rows = np.array([row for row, _ in signs]).reshape(-1, found.rows.shape[1])
    least = np.array([below for _, below in signs])
    return Told(rows, least, np.vstack([one[first:] for one in ways]), np.tile(most, len(ways)))


def _signs(
    judged: Judged, ways: list[Array], values: list[Array], bounds: Bounds, asked: Sequence[int]
) -> list[tuple[Array, float]] | None:
    """Rows and what they are above; None where an impact is a matter of several slips."""
    found, ports = judged.glance, judged.glance.shock.shape[1]
    rows, now = ways[0], values[0]
    if found.ruled:
        # One that is not zero is enough.
        at = int(np.argmax(np.abs(now[: judged.first]) - bounds.least))
        return [(np.copysign(1.0, now[at]) * rows[at], bounds.least[at])]
    slips, told = now[ports : ports + len(found.shock)], list[tuple[Array, float]]()
    shocked: Sequence[float] = [0.0] * ports
    if all_of(np.abs(slips) <= bounds.still):
        for k, least in enumerate(bounds.still.tolist()):
            told += [(rows[ports + k], -least), (-rows[ports + k], -least)]
    elif len(slips) == 1:
        told = [(np.copysign(1.0, slips[0]) * rows[ports], float(bounds.struck[0]))]
        rows, now, shocked = ways[1], values[1], found.shock[0].tolist()
    else:
        return None
    # Which way an impulse goes is told by the slip.
    free = [i for i in asked if not shocked[i]]
    return told + [(np.copysign(1.0, now[i]) * rows[i], bounds.least[i]) for i in free]


class Rested(NamedTuple):
    """That these ports were told to be at rest, with friction slipping as in ``mode``."""

    mode: Mode
    ports: tuple[int, ...]


class Tried(NamedTuple):
    """What each port that was asked told of a mode, as `Look.verdict` has it; None where it is none.

    ``later``: what ties told a moment later, where they were asked.
    """

    mode: Mode
    verdicts: Mapping[int, int] | None
    later: Mapping[int, int]


class Occasion(NamedTuple):
    """An instant at which a mode is to be decided.

    ``loose``: friction ports that stick if they are at rest and can. ``touched``: ports whose event it
    is. ``ahead`` [s]: how far to look where the instant itself does not decide.
    """

    model: ClosedModel
    t: float
    pieces: Sequence[Piece]
    previous: Mode
    ahead: float
    peaks: Peaks | None = None
    loose: frozenset[int] = frozenset()
    touched: frozenset[int] = frozenset()
    #: What a first look at affine modes needs.
    glances: Glances | None = None
    #: What it has come to.
    choices: Choices | None = None
    #: Stops that are apart, or about to throw back what meets them, and so let go.
    barred: frozenset[int] = frozenset()
    #: What takes note of all that decided, in turn, if it is asked for.
    log: Callable[[Rested | Tried], object] | None = None

    def seen(self, s: Array) -> Sight:
        """The model at this instant with another integrated vector."""
        return Sight(self.model, self.t, s, self.pieces)


class Decision(NamedTuple):
    """A mode, the integrated vector with which it begins, and the impact that led to it, if any."""

    mode: Mode
    s: Array
    impacts: tuple[Impact, ...]
    #: Whether all that could change it is far from doing so.
    clear: bool = False
