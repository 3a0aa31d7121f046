"""What happens to states as switches come to hold: the impulses that stop what they must not let through.

Held, the ports S of a mode have ``y_S = F x + D u = 0``. What no effort of theirs rules at once, the
combinations N with ``N^T D_SS = 0``, rules the states: ``x+ = x- + A^-1 B_S p`` with ``N^T (F x+ + D u) = 0``
and ``D_SS p = 0``. Friction takes no part: what it gives is finite.
"""

import numpy as np

from codegen.model.snapshot import Impact, Mode, Snapshot
from codegen.modes.rounding import Peaks, scales
from codegen.modes.trials import Sight, taken
from codegen.modes.verdicts import Look
from codegen.standalone.striking import Strike, shocks
from codegen.tuning import TUNING


def impact(here: Sight, mode: Mode, peaks: Peaks | None = None) -> Impact | None:
    """What the switches that a mode holds do to the states; None where nothing has to jump."""
    model = here.model
    held = tuple(
        sign if switch is not None else 1
        for sign, switch in zip(mode, model.switching, strict=True)
    )
    if 0 not in held:
        return None
    first = _struck(here, held, peaks)
    if first is None:
        return None
    slipping, now, strike = first
    after = here.s + strike.gained(len(here.s), model.law_rates)
    # Where rows turn as states jump, each strike leaves what is bent of its way.
    for _ in range(TUNING.impacts if model.program.varying else 0):
        more = _struck(Sight(model, here.t, after, here.pieces), held, peaks)
        if more is None:
            break
        after = after + more[2].gained(len(after), model.law_rates)
        strike = strike.followed(more[2])
    later = model.at(here.t, after, here.pieces, slipping)
    return Impact(after, strike, taken(here, now, later, strike))


def _struck(here: Sight, held: Mode, peaks: Peaks | None) -> tuple[Mode, Snapshot, Strike] | None:
    """What stops the slips of what is held, by its rows as they are; None where that is nothing."""
    model = here.model
    slipping, now = here.evaluated((1,) * len(held))
    hold = model.hold(held, now.numbers)
    if not len(hold.mix):
        return None
    slips = hold.slips(now.x, now.u)
    near = np.abs(hold.mix) @ scales(model, now, here.t, peaks).slip[hold.ports]
    if (np.abs(slips) <= TUNING.wide * near).all():
        return None
    return slipping, now, model.exchange(held, now.instant(here.t))


def pushed(look: Look, t: float, jump: Impact) -> list[int]:
    """For each switch 1 where its impulse goes with its mode, -1 where against it, 0 where it has none."""
    model = look.model
    inputs, readings = (
        np.array(at, dtype=np.intp) for at in (model.friction_inputs, model.friction_readings)
    )
    places, now = (inputs, readings), look.now.instant(t)
    return shocks(jump.strike, now, look.mode, model.switching, places, model.guards_at)
