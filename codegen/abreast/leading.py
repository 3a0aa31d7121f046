"""What an instant comes to in many runs: decided for one of them, and for all in which the same decides.

One run leads: its mode is decided as in a run by itself, and note is taken of what decided. Of the others those
follow in which all of that is told alike, far from a tie; one of the rest leads next.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from bondgraph.errors import BondGraphError
from codegen.abreast.modes import ModesAbreast
from codegen.abreast.seen import Group, Seen
from codegen.inputs.present import Present
from codegen.model.snapshot import Mode
from codegen.modes.choices import Decision, Occasion, Rested, Tried
from codegen.modes.choose import decide
from codegen.modes.closed import ClosedModel
from codegen.modes.rounding import Peaks
from codegen.modes.trials import Sight
from codegen.numbers.arrays import Array

NOTHING: Array = np.zeros((0, 0))

Log = Sequence[Rested | Tried]


class Leader(NamedTuple):
    """One run by itself: its model, its vector, and what its inputs do."""

    model: ClosedModel
    s: Array
    present: Present


class Outcome(NamedTuple):
    """Runs of a group, by their places in it, and the mode that they come to; None: by themselves.

    ``added``: to their states, so that ports that stick are at rest. ``limits``: below these what is watched of
    their ports counts as zero.
    """

    places: Array
    mode: Mode | None
    added: Array = NOTHING
    limits: Array = NOTHING


class Instant(NamedTuple):
    """What all runs of a group have in common: the mode before, and the ports whose event it is."""

    mode: Mode
    touched: frozenset[int]

    @property
    def loose(self) -> frozenset[int]:
        """Ports that stick if they are at rest and can."""
        return self.touched | {i for i, sign in enumerate(self.mode) if sign == 0}


def outcomes(
    now: Instant, group: Group, modes: ModesAbreast, lead: Callable[[int], Leader]
) -> list[Outcome]:
    """What every run of a group comes to; ``lead``: the run at a place of it by itself."""
    left, found = np.arange(len(group.at)), list[Outcome]()
    while len(left):
        first = int(left[0])
        leader = lead(first)
        told = _decided(now, group, leader, first)
        part = group.part(left)
        follow, seen = np.zeros(len(left), dtype=bool), None
        if told is not None:
            mode, log = told
            follow, seen = _following(now, part, modes, leader.model, log, mode)
        if not follow[0]:
            found.append(Outcome(left[:1], None))
            left = left[1:]
            continue
        assert told is not None and seen is not None
        parts = seen.settled()[follow], seen.limits[follow]
        found.append(Outcome(left[follow], told[0], *parts))
        left = left[~follow]
    return found


def _decided(
    now: Instant, group: Group, leader: Leader, place: int
) -> tuple[Mode, Log] | None:
    """The mode that one run comes to, and what decided; None where a look at the instant is not enough."""
    model, s, present = leader
    t, log = float(group.t[place]), list[Rested | Tried]()
    if not now.mode:
        return (), log
    n = len(model.program.states)
    peaks = Peaks(group.both[place].copy(), n, float(group.time[place]))
    ahead = float(group.ahead[place])
    here = Sight(model, t, s, present.pieces)
    occasion = Occasion(
        model, t, present.pieces, now.mode, ahead, peaks, now.loose, now.touched, log=log
    )
    try:
        found: Decision = decide(occasion, here)
    except BondGraphError:
        return None
    sure = all(isinstance(one, Rested) or _is_clear(one) for one in log)
    return (found.mode, log) if sure and not found.impacts else None


def _is_clear(one: Tried) -> bool:
    return one.verdicts is not None


def _following(
    now: Instant, group: Group, modes: ModesAbreast, model: ClosedModel, log: Log, mode: Mode
) -> tuple[Array, Seen | None]:
    """Which runs of a group come to the same mode by the same as its first, and what they are in it."""
    found, known = np.ones(len(group.at), dtype=bool), dict[Mode, Seen]()

    def seen(one: Mode) -> Seen | None:
        if one not in known:
            made = modes.of(one)
            if made is None:
                return None
            found[:] &= made.sound[group.at]
            known[one] = Seen(model, modes, made, one, group)
        return known[one]

    for one in log:
        look = seen(one.mode)
        if look is None:
            return np.zeros_like(found), None
        if isinstance(one, Rested):
            found &= look.rests(one.ports, sorted(now.loose))
            found &= _alike(look.sides([i for i in range(len(mode)) if i not in one.ports]))
            if len(one.ports) > 1:
                ports = np.ix_(group.at, one.ports, one.ports)
                found &= _alike(modes.touching[ports].reshape(len(found), -1))
        else:
            assert one.verdicts is not None
            found &= look.tells(one)
            told = {**one.verdicts, **one.later}
            found &= _alike(look.ways([i for i, sign in told.items() if sign < 0]))
    return found, seen(mode)


def _alike(values: Array) -> Array:
    """Which rows are like the first."""
    return np.asarray((values == values[:1]).all(axis=1))
