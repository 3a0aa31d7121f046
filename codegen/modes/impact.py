"""What happens to states as switches come to hold: the impulses that stop what they must not let through.

Held, the ports S of a mode have ``y_S = F x + D u = 0``. What no effort of theirs rules at once, the
combinations N with ``N^T D_SS = 0``, rules the states: ``x+ = x- + A^-1 B_S p`` with ``N^T (F x+ + D u) = 0``
and ``D_SS p = 0``. Friction takes no part: what it gives is finite.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from codegen.inputs.pieces import Piece
from codegen.model.snapshot import Impact, Mode, Snapshot
from codegen.modes.closed import ClosedModel
from codegen.modes.rounding import Peaks, scales
from codegen.modes.trials import evaluated
from codegen.modes.verdicts import Look
from codegen.numbers.arrays import Array
from codegen.tuning import TUNING


def impact(
    model: ClosedModel, t: float, s: Array, pieces: Sequence[Piece], mode: Mode,
    peaks: Peaks | None = None,
) -> Impact | None:  # fmt: skip
    """What the switches that a mode holds do to the states; None where nothing has to jump."""
    held = tuple(
        sign if switch is not None else 1
        for sign, switch in zip(mode, model.switching, strict=True)
    )
    if 0 not in held:
        return None
    slipping, now = evaluated(model, t, s, pieces, tuple(1 for _ in mode))
    hold = model.hold(held, now.numbers)
    slips = hold.slip_x @ now.x + hold.slip_u @ now.u
    near = np.abs(hold.mix) @ scales(model, now, t, peaks).slip[hold.ports]
    if (np.abs(slips) <= TUNING.wide * near).all():
        return None
    ports = model.friction_inputs
    columns = np.array([ports[i] for i in hold.ports.tolist()])
    moved = now.numbers.Q[:, columns] @ hold.free
    amounts = -np.linalg.lstsq(hold.slip_x @ moved, slips, rcond=TUNING.nothing)[0]
    impulses = hold.free @ amounts
    given = np.zeros(len(ports))
    given[hold.ports] = impulses
    received = now.numbers.D[:, columns] @ impulses
    after = s.copy()
    n, m = len(model.program.states), len(model.program.law_rates)
    after[:n] += moved @ amounts
    after[n : n + m] += received[list(model.program.law_rates)]
    later = model.at(t, after, pieces, slipping)
    return Impact(after, given, received, _taken(model, now, later, given))


def _taken(model: ClosedModel, before: Snapshot, after: Snapshot, given: Array) -> float:
    """An impulse works on the mean of what its port receives before and after."""
    mean = 0.5 * (before.y + after.y)[model.friction_readings]
    return float(given @ mean)


FAR = 2.0**40
"""An impulse is looked at as a value so much larger than all others."""


def pushed(look: Look, t: float, jump: Impact) -> NDArray[np.int_]:
    """For each switch 1 where its impulse goes with its mode, -1 where against it, 0 where it has none."""
    model = look.model
    size = float(np.abs(jump.given).max())
    terms = np.abs(look.now.numbers.D[:, model.friction_inputs]) @ np.abs(jump.given)
    found = np.zeros(len(look.mode), dtype=int)
    guards = _pushed_at(look, t, jump)
    for i, switch in enumerate(model.switching):
        if switch is None:
            continue
        reading = model.friction_readings[i]
        if not switch.side:
            way, least = -guards[switch.guard + (switch.on == (look.mode[i] == 0))], TUNING.rounding
        elif look.mode[i]:
            way, least = switch.side * jump.received[reading], TUNING.rounding * terms[reading]
        else:
            way, least = -switch.side * jump.given[i], TUNING.rounding * size
        found[i] = 0 if abs(way) <= least else 1 if way > 0 else -1
    return found


def _pushed_at(look: Look, t: float, jump: Impact) -> Array:
    """How conditions change with the impulses, per unit of the largest."""
    model, now = look.model, look.now
    if not len(look.guards):
        return look.guards
    size = max(float(np.abs(jump.received).max(initial=0.0)), float(np.abs(jump.given).max()))
    far = FAR * (1 + float(np.abs(now.y).max(initial=0.0)))
    u = now.u.copy()
    u[model.friction_inputs] += far / size * jump.given
    moved = replace(now, u=u, y=now.y + far / size * jump.received)
    return np.asarray((model.guards(t, moved) - look.guards) / far, dtype=float)
