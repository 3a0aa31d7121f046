"""An instant in its parts: a mode with its impacts, what that sets states to, the mode after that, and so on.

What a reset becomes is told by the values just before it, after the impacts; all that one part sets
is set together.
"""

from collections.abc import Callable, Collection, Sequence
from typing import NamedTuple

import numpy as np

from bondgraph.errors import SimulationError
from codegen.instants.called import told_by_steps
from codegen.model.snapshot import Impact, Mode
from codegen.modes.choices import Decision, Occasion
from codegen.modes.closed import ClosedModel
from codegen.modes.impact import impact
from codegen.modes.rounding import Peaks
from codegen.modes.trials import Sight
from codegen.numbers.arrays import Array
from codegen.standalone.switchings import Reset, first_taken
from codegen.tuning import TUNING

AROUND = 12
"""So many parts of an instant without end are told."""

Decide = Callable[[Occasion, Sight], Decision]


class Part(NamedTuple):
    """From one mode to another, by impacts; the integrated vector after these, and after resets if any."""

    before: Mode
    mode: Mode
    impacts: tuple[Impact, ...]
    s: Array
    reset: Array | None = None
    #: Whether all that could change the mode is far from doing so.
    clear: bool = False

    @property
    def end(self) -> Array:
        """The integrated vector with which it ends."""
        return self.s if self.reset is None else self.reset


def parts_of(
    decide: Decide, now: Occasion, here: Sight, due: Collection[int] = (), begins: bool = False
) -> list[Part]:
    """The parts of an instant at which ports may have events; the last has no resets.

    ``decide``: what decides a mode. ``due``: the tasks whose instant it is: they set what they set once no
    event is left. ``begins``: whether a run begins, which is no event of any port, but may be that of a state
    machine.

    Raises `SimulationError` where there is no mode, where what is set contradicts what is held or is set
    twice, and where resets set off one another without end.
    """
    found: list[Part] = []
    fired: list[Reset] = []
    for _ in range(TUNING.renewals):
        decided = decide(now, here)
        mode = first_taken(now.model.switching, now.previous, decided.mode)
        part = Part(now.previous, mode, decided.impacts, decided.s, clear=decided.clear)
        fired = _fired(now.model, part, begins and not found)
        if not fired and due:
            fired, due = [one for one in now.model.program.resets if -1 - one.port in due], ()
        if not fired:
            return [*found, part]
        seen = here if part.s is here.s else now.seen(part.s)
        part = part._replace(reset=_reset(seen, part.mode, fired, now.peaks))
        found.append(part)
        assert part.reset is not None
        here = now.seen(part.reset)
        now = now._replace(previous=part.mode, touched=frozenset())
    if taken := now.model.taken_by(
        [one for part in found[-AROUND:] for one in _fired(now.model, part)]
    ):
        raise SimulationError(
            f"at t = {now.t:.9g} the transitions of {taken} lead to one another without end; let no guard be "
            "above zero where another transition has just led"
        )
    names = sorted({repr(now.model.owner(one)) for one in fired})
    raise SimulationError(
        f"at t = {now.t:.9g} resets at {', '.join(names)} set off one another without end; let what is "
        "set be away from where it is set off"
    )


def hits(
    model: ClosedModel, before: Mode, mode: Mode, impacts: Sequence[Impact]
) -> dict[int, float]:
    """The stops that took a shock of more than rounding and stay as they were, and their impulses."""
    rest = np.zeros(len(mode))
    for one in impacts:
        given = one.strike.given[model.friction_inputs]
        given[list(one.thrown)] = 0.0
        rest += given
    least = TUNING.rounding * float(np.abs(rest).max(initial=0.0))
    return {
        i: float(rest[i]) for i in model.stopping if mode[i] == before[i] and abs(rest[i]) > least
    }


def _fired(model: ClosedModel, part: Part, begins: bool = False) -> list[Reset]:
    """The resets of ports that changed over, and of stops that were hit; as a run begins of transitions."""
    if not model.program.resets:
        return []
    struck = {i for one in part.impacts for i in one.thrown}
    struck |= hits(model, part.before, part.mode, part.impacts).keys()
    found = []
    for one in model.program.resets:
        if one.port < 0:
            continue
        switching = model.switching[one.port]
        if begins and not (switching is not None and switching.machine):
            continue
        off = switching is not None and not switching.is_on(one.sign)
        if part.mode[one.port] == one.sign != part.before[one.port] or (one.port in struck and off):
            found.append(one)
    return found


def _reset(here: Sight, mode: Mode, fired: Sequence[Reset], peaks: Peaks | None) -> Array:
    """The integrated vector with what these resets set."""
    model, now = here.model, here.at(mode)
    due = {-1 - one.port for one in fired if one.port < 0}
    values = told_by_steps(model.program, here.t, due, model.guards(here.t, now))
    x = np.concatenate((now.x, now.z))
    s, owners = here.s.copy(), dict[int, Reset]()
    for one in fired:
        value = float(values[one.value])
        first = owners.setdefault(one.place, one)
        if float(values[first.value]) != value:
            ports = [repr(model.owner(r)) for r in (first, one)]
            raise SimulationError(
                f"at t = {here.t:.9g} {' and '.join(ports)} reset {model.place_name(one.place)} to "
                f"{float(values[first.value]):.6g} and {value:.6g} at once; let one of them do it"
            )
        # Less what inputs that drive dependent storages add.
        s[one.place] = value + (here.s[one.place] - x[one.place])
    _check_held(here, Sight(model, here.t, s, here.pieces), mode, fired, peaks)
    return s


def _check_held(
    here: Sight, after: Sight, mode: Mode, fired: Sequence[Reset], peaks: Peaks | None
) -> None:
    """Refuse what moves a port that is held both ways: it would be stopped at once by an impulse."""
    model = here.model
    ports = zip(mode, model.switching, strict=True)
    held = tuple(sign if one is not None and not one.side else 1 for sign, one in ports)
    if impact(after, held, peaks) is None:
        return
    names = [repr(model.program.friction[i].name) for i, sign in enumerate(held) if sign == 0]
    states = sorted({model.place_name(one.place) for one in fired})
    raise SimulationError(
        f"at t = {here.t:.9g} the reset of {' and '.join(states)} contradicts what {' and '.join(names)} "
        "holds; reset all that it binds alike, or as it lets go"
    )
