"""Where all states rest under constant inputs, with friction and switches as they would be there."""

from collections.abc import Hashable, Mapping, Sequence

import numpy as np

from bondgraph.errors import SimulationError
from codegen.inputs.pieces import Piece
from codegen.model.snapshot import Mode, Snapshot
from codegen.modes.closed import ClosedModel
from codegen.modes.steady import choices, steady_modes
from codegen.modes.trials import Sight
from codegen.modes.verdicts import look_at
from codegen.numbers.arrays import Array
from codegen.standalone.switchings import Broken
from codegen.tuning import TUNING

ITERATIONS = 50

SHOWN = 4
"""So many reasons are told."""


def equilibrium(
    model: ClosedModel, pieces: Sequence[Piece], start: Array,
    mode: Mapping[Hashable, str] | None = None,
) -> Snapshot:  # fmt: skip
    """All variables where all states rest, found from the vector ``start``; ``mode``: as `trim` takes it.

    Raises `StructureError` for a mode that there is not, `SimulationError` if no steady state was found, with
    the ports that would leave it.
    """
    allowed = choices(model, mode)
    left: dict[str, None] = {}
    with np.errstate(all="ignore"):
        tries = steady_modes(model, pieces, start, allowed)
        tried = next(tries)
        while True:
            found, wrong = _point(model, pieces, tried, start)
            if found is not None and not wrong:
                return found
            if wrong:
                left.setdefault(_told(model, tried, wrong))
            try:
                tried = tries.send(frozenset(i for i in wrong if model.switching[i] is not None))
            except StopIteration:
                break
    raise SimulationError(
        "no steady state was found: a state may drift without end (a free rotation, an integrator), or "
        "the search needs a closer start in initial, such as where a run ends"
        + "".join(f"; {reason}" for reason in list(left)[:SHOWN])
    )


def _point(
    model: ClosedModel, pieces: Sequence[Piece], mode: Mode, start: Array
) -> tuple[Snapshot | None, Broken]:
    """Where all rests in a mode, if it does, and the ports that would leave the mode there."""
    try:
        rest = _rest(model, pieces, mode, start)
        if rest is None:
            return None, frozenset()
        now = model.at(0.0, rest, pieces, mode)
        return now, _broken(model, mode, now) | _switched(model, pieces, mode, rest)
    except SimulationError:
        # Laws without a solution in a mode: it is none.
        return None, frozenset()


def _switched(model: ClosedModel, pieces: Sequence[Piece], mode: Mode, s: Array) -> Broken:
    """The switches that would change over."""
    if not model.program.switched:
        return frozenset()
    look = look_at(Sight(model, 0.0, s, pieces), mode)
    ports = range(len(mode))
    return frozenset(i for i in ports if model.switching[i] is not None and look.verdict(i) < 0)


def _told(model: ClosedModel, mode: Mode, wrong: Broken) -> str:
    """Which ports would leave a mode where all rests in it."""
    words = []
    for i in sorted(wrong):
        port = model.program.friction[i]
        if (taken := port.transition) is not None:
            words.append(f"{taken.machine.name!r} would not stay, {taken.words} is taken")
        elif port.jumps:
            words.append(f"{port.name!r} would not {'stay on its side' if mode[i] else 'slide'}")
        elif port.slides:
            words.append(f"{port.name!r} would not {'stick' if mode[i] else 'slip so'}")
        elif port.switch is not None:
            words.append(f"{port.name!r} would not stay {port.switch.word(mode[i])}")
        else:
            words.append(f"{port.name!r} would not {'slip so' if mode[i] else 'stick'}")
    return " and ".join(words)


def _rest(model: ClosedModel, pieces: Sequence[Piece], mode: Mode, start: Array) -> Array | None:
    """Newton's iteration for rates, and slips of sticking ports, that vanish; None if it fails."""
    s = start.copy()
    left, size = _residual(model, pieces, mode, s)
    for _ in range(ITERATIONS):
        if not np.isfinite(left).all():
            return None
        if (np.abs(left) <= TUNING.close * size).all():
            return s
        step = np.linalg.lstsq(
            _slopes(model, pieces, mode, s, left), -left, rcond=TUNING.independent
        )[0]
        for shorter in 0.5 ** np.arange(30):
            tried, tried_size = _residual(model, pieces, mode, s + shorter * step)
            # Terms that vanish at the start say nothing about what is small: the largest seen do.
            largest = np.maximum(size, tried_size)
            if np.linalg.norm(tried / largest) < np.linalg.norm(left / largest):
                break
        else:
            return None
        s, left, size = s + shorter * step, tried, largest
    return None


def _residual(
    model: ClosedModel, pieces: Sequence[Piece], mode: Mode, s: Array
) -> tuple[Array, Array]:
    """Rates, held slips and closed gaps, and what these are small against."""
    now = model.at(0.0, s, pieces, mode)
    held = [i for i, sign in enumerate(mode) if sign == 0]
    stuck = [model.friction_readings[i] for i in held]
    numbers, n = now.numbers, len(now.x)
    terms = np.abs(numbers.P) @ np.abs(now.x) + np.abs(numbers.Q) @ np.abs(now.u)
    rates = np.concatenate([terms, np.ones(len(now.rate) - n)])
    slips = np.abs(numbers.F[stuck]) @ np.abs(now.x) + np.abs(numbers.D[stuck]) @ np.abs(now.u)
    for at, i in enumerate(held):
        if i in model.hung:
            row = np.abs(model.hung_rows(now))[[*model.hung].index(i)]
            slips[at] = row @ np.append(np.abs(s), 1.0)
    rate, gaps = _settled(model, mode, now, s)
    left = np.concatenate([rate, model.hangs_on(0.0, now)[held], gaps])
    return left, np.concatenate([rates, slips, np.ones(len(gaps))]) + TUNING.trim_floor


def _settled(model: ClosedModel, mode: Mode, now: Snapshot, s: Array) -> tuple[Array, Array]:
    """Rates, in place of those of what tasks set how these change it; and the gaps of stops that touch."""
    stops = [(one, mode[i]) for i in model.stopping if (one := model.switching[i]) is not None]
    touching = [one for one, sign in stops if not one.is_on(sign)]
    if not model.ticked and not touching:
        return now.rate, np.zeros(0)
    told, rate = model.guards(0.0, now), now.rate.copy()
    for reset in model.program.resets:
        if reset.port < 0:
            rate[reset.place] = told[reset.value] - s[reset.place]
    return rate, np.array([told[one.guard] for one in touching])


def _slopes(
    model: ClosedModel, pieces: Sequence[Piece], mode: Mode, s: Array, left: Array
) -> Array:
    slopes = np.empty((len(left), len(s)))
    for j in range(len(s)):
        step = TUNING.difference * (abs(s[j]) + TUNING.residual_floor)
        ahead, behind = s.copy(), s.copy()
        ahead[j], behind[j] = s[j] + step, s[j] - step
        over, under = (_residual(model, pieces, mode, at)[0] for at in (ahead, behind))
        slopes[:, j] = (over - under) / (2 * step)
    return np.nan_to_num(slopes)


def _broken(model: ClosedModel, mode: Mode, now: Snapshot) -> Broken:
    """The friction ports whose slip has another sign, or that would need more than they can to hold."""
    slips, efforts = model.hangs_on(0.0, now), now.u[model.friction_inputs]
    return frozenset(
        i for i, m in enumerate(mode)
        if model.switching[i] is None
        and not (
            slips[i] * m > 0 if m else abs(efforts[i]) <= now.caps[i] * (1 + TUNING.consistent)
        )
    )  # fmt: skip
