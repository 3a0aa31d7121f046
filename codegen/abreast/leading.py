"""What an instant comes to in many runs: decided for one of them, and for all in which the same decides.

One run leads: its mode is decided as in a run by itself, and note is taken of what decided. Of the others
those follow in which all of that is told alike, far from a tie; one of the rest leads next. What led once is
a precedent for all later runs.
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
from codegen.standalone.arrays import Places

NOTHING: Array = np.zeros((0, 0))

Log = Sequence[Rested | Tried]


class Leader(NamedTuple):
    """One run by itself: its model, its vector, and what its inputs do."""

    model: ClosedModel
    s: Array
    present: Present


class Outcome(NamedTuple):
    """Runs of a group, by their places in it, and the mode that they come to; None: by themselves.

    ``added``: to their states, so that ports that stick are at rest. ``limits``: below these what is watched
    of their ports counts as zero.
    """

    places: Places
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


class Precedent(NamedTuple):
    """What one run came to, what decided, and the signs that others must have, too, for each part of that."""

    mode: Mode
    log: Log
    signs: tuple[Array, ...]


Precedents = dict[Instant, list[Precedent]]
"""Those of a sweep, the latest first."""

MOST_KEPT = 16
"""So many precedents of one kind of instant are kept."""


def outcomes(
    now: Instant,
    group: Group,
    modes: ModesAbreast,
    known: Precedents,
    lead: Callable[[int], Leader],
) -> list[Outcome]:
    """What every run of a group comes to.

    ``known``: what others have come to. ``lead``: the run at a place of the group by itself.
    """
    left: Places = np.arange(len(group.at))
    found = list[Outcome]()
    kept = known.setdefault(now, [])
    for one in list(kept):
        if len(left):
            left = _follow(one, group, left, modes, found)
    while len(left):
        first = int(left[0])
        told = _decided(now, group, lead, first)
        if told is not None:
            made = _precedent(*told, group.part(left[:1]), modes)
            if made is not None:
                left = _follow(made, group, left, modes, found)
                kept[:] = [made, *kept[: MOST_KEPT - 1]]
        if len(left) and left[0] == first:
            found.append(Outcome(np.array([first]), None))
            left = left[left != first]
    return found


def _follow(
    one: Precedent, group: Group, left: Places, modes: ModesAbreast, found: list[Outcome]
) -> Places:
    """The places of a group that are left once those that surely follow a precedent are found."""
    part = group.part(left)
    follow, known = np.ones(len(left), dtype=bool), dict[Mode, Seen]()
    for told, signs in zip(one.log, one.signs, strict=True):
        look = _seen(told.mode, part, modes, known)
        if look is None:
            return left
        follow &= look.sound & (_signs(told, look) == signs).all(axis=1)
        if isinstance(told, Rested):
            follow &= look.rests(told.ports)
        else:
            follow &= look.tells(told)
    seen = _seen(one.mode, part, modes, known)
    if seen is None or not follow.any():
        return left
    follow &= seen.sound
    found.append(Outcome(left[follow], one.mode, seen.settled()[follow], seen.limits[follow]))
    return left[~follow]


def _precedent(mode: Mode, log: Log, first: Group, modes: ModesAbreast) -> Precedent | None:
    """What the one run of a group came to; None where it has modes that are not looked at here."""
    known, signs = dict[Mode, Seen](), list[Array]()
    for told in log:
        look = _seen(told.mode, first, modes, known)
        if look is None:
            return None
        signs.append(_signs(told, look)[0])
    return Precedent(mode, tuple(log), tuple(signs))


def _seen(mode: Mode, group: Group, modes: ModesAbreast, known: dict[Mode, Seen]) -> Seen | None:
    """A group in a mode."""
    if mode not in known:
        made = modes.of(mode)
        if made is None:
            return None
        known[mode] = Seen(modes, made, mode, group)
    return known[mode]


def _signs(told: Rested | Tried, look: Seen) -> Array:
    """What must be alike where a precedent is followed: which way other ports slip, and what these touch.

    And which way ports that contradict a mode are pushed.
    """
    if isinstance(told, Rested):
        return np.hstack([look.sides(told.ports), look.touching(told.ports)])
    verdicts = {**(told.verdicts or {}), **told.later}
    return look.ways([i for i, sign in verdicts.items() if sign < 0])


def _decided(
    now: Instant, group: Group, lead: Callable[[int], Leader], place: int
) -> tuple[Mode, Log] | None:
    """The mode that one run comes to, and what decided; None where a look at the instant is not enough."""
    t, log = float(group.t[place]), list[Rested | Tried]()
    if not now.mode:
        return (), log
    try:
        model, s, present = lead(place)
    except BondGraphError:
        # Its numbers are refused, which the run by itself tells.
        return None
    n = len(model.program.states)
    peaks = Peaks(group.both[place].copy(), n, float(group.time[place]))
    ahead = float(group.ahead[place])
    here = Sight(model, t, s, present.pieces)
    occasion = Occasion(
        model, t, present.pieces, now.mode, ahead, peaks, now.loose, now.touched, log=log.append
    )
    try:
        found: Decision = decide(occasion, here)
    except BondGraphError:
        return None
    sure = all(isinstance(one, Rested) or _is_clear(one) for one in log)
    return (found.mode, log) if sure and not found.impacts else None


def _is_clear(one: Tried) -> bool:
    return one.verdicts is not None
