"""Which ports hold and which are let go, and which way these slip: one consistent mode at one instant."""

from collections.abc import Collection, Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from bondgraph.errors import SimulationError
from codegen.model.snapshot import Impact, Mode, Snapshot
from codegen.modes.blocks import blocks_of, slipping_as, turned_to, ways_to_rub
from codegen.modes.bounce import (
    closed_up,
    closing,
    creeping,
    hardly_leaving,
    met,
    opening,
    stopped,
    thrown_back,
)
from codegen.modes.choices import Decision, Occasion, Rested, Tried
from codegen.modes.impact import impact, pushed
from codegen.modes.rounding import scales
from codegen.modes.timed import told
from codegen.modes.trials import Sight, sides
from codegen.modes.verdicts import Look, look_at, ruled_out, ruled_out_later, torn, with_leaps
from codegen.ports.refusals import SlopeNeededError
from codegen.standalone.switchings import Broken, switchings
from codegen.tuning import TUNING

NONE: Broken = frozenset()


class _Refusal(NamedTuple):
    """Why there is no mode with the switches so, and which of them would have to change over."""

    reason: str
    broken: Broken


class _Finding(NamedTuple):
    """Why a mode is not consistent, None if it is; the switches that alone contradict it.

    ``none``: it cannot be evaluated. ``turned``: where friction ports that contradict it would go.
    """

    reason: str | None
    broken: Broken = NONE
    none: bool = False
    turned: Mapping[int, int] = MappingProxyType({})


MOST_TOLD = 30
"""So many modes that were tried are told."""


def decide(now: Occasion, here: Sight) -> Decision:
    """The mode just after an instant, of what is seen there with the integrated vector before it.

    Every loose port at rest sticks if it can, else slips the way it is pushed; other ports slip the way
    their slip shows. Where several modes are consistent, ports not touched keep their state, and so do all
    switches. A mode that cannot be evaluated is none: laws without a solution in it,
    ports without unique holding efforts.

    After an impact it is decided again: what passed an impulse may well not stay as it was for that.

    Raises `SimulationError`, with the numbers, if no mode is consistent.
    """
    if not now.previous:
        return Decision((), here.s, ())
    free = now.model.switches
    if now.model.timed:
        previous, known = told(now.model, now.t, now.pieces, now.previous, now.ahead, now.touched)
        if previous != now.previous:
            now = now._replace(previous=previous)
        free = [i for i in free if i not in known]
    if now.model.stopping:
        return _struck(now, here, free)
    found = _decided(now, here, free)
    impacts = found.impacts
    if not impacts:
        return found
    for _ in range(TUNING.impacts):
        now = now._replace(previous=found.mode, touched=frozenset())
        found = _decided(now, now.seen(found.s), free)
        if not found.impacts:
            break
        impacts += found.impacts
    return found._replace(impacts=impacts)


def _struck(now: Occasion, here: Sight, free: Sequence[int]) -> Decision:
    """The same where stops are met: what joins comes first, then what closes is thrown back; and again.

    Raises `SimulationError` where that does not end.
    """
    met_now = met(here, now.previous, now.touched, now.peaks)
    apart = frozenset(now.model.stopping) - met_now
    impacts: tuple[Impact, ...] = ()
    joined = 0
    for _ in range(TUNING.bounces):
        slow = creeping(here, now.previous, met_now, now.peaks)
        if slow and (stilled := thrown_back(here, now.previous, slow)) is not None:
            impacts += (stilled,)
            here = now.seen(stilled.s)
        wanted = closing(here, now.previous, met_now, now.peaks)
        opens = opening(here, now.previous, met_now, now.peaks)
        now = now._replace(barred=apart | wanted.keys() | opens)
        found = _decided(now, here, [i for i in free if i not in now.barred])
        impacts += found.impacts
        joined += len(found.impacts)
        here, now = now.seen(found.s), now._replace(previous=found.mode, touched=frozenset())
        wanted = closing(here, found.mode, wanted.keys() | opens, now.peaks)
        thrown = thrown_back(here, found.mode, wanted) if wanted else None
        if thrown is None and not found.impacts and impacts:
            wanted = hardly_leaving(here, found.mode, met_now, now.peaks)
            thrown = stopped(here, found.mode, wanted) if wanted else None
        if thrown is not None:
            impacts += (thrown,)
            here = now.seen(thrown.s)
        elif not found.impacts or joined > TUNING.impacts:
            s = closed_up(here, found.mode, met_now)
            return found._replace(s=s, impacts=impacts, clear=found.clear and not met_now)
    raise SimulationError(
        f"at t = {now.t:.9g} stops were struck {TUNING.bounces} times, and what meets them still closes"
    )


def _decided(now: Occasion, here: Sight, switches: list[int]) -> Decision:
    """The first consistent mode, at most one impact later; time alone has told the other switches."""
    if (again := _again(now, here, switches)) is not None:
        return again
    refused: dict[Mode, str] = {}
    tries = switchings(now.previous, switches, now.model.guarded)
    mode, glanced = next(tries), True
    while True:
        found = _glanced(now, here, mode, switches)
        if found is None:
            found, glanced = _tried(now, here, mode, switches), False
        if isinstance(found, Decision):
            if glanced and now.choices is not None and now.peaks is not None:
                now.choices.keep(now.previous, switches, [*refused, mode], here, now.peaks)
            return found
        refused[mode] = found.reason
        try:
            mode = tries.send(found.broken)
        except StopIteration:
            every = [i for i in now.model.switches if i not in now.barred]
            if now.glances is not None or len(switches) < len(every):
                # Why not is told by a closer look, at what time alone tells, too.
                closer = now._replace(glances=None, choices=None)
                return _decided(closer, here, every)
            raise _none_consistent(now, refused) from None


def _again(now: Occasion, here: Sight, switches: list[int]) -> Decision | None:
    """What was decided before in a like case, if it would be again."""
    if now.choices is None or now.peaks is None:
        return None
    mode = now.choices.again(now.previous, switches, here, now.peaks)
    return None if mode is None else Decision(mode, here.s, (), clear=True)


def _none_consistent(now: Occasion, refused: dict[Mode, str]) -> SimulationError:
    if not now.model.program.switched:
        return SimulationError(next(iter(refused.values())))
    ports = now.model.program.friction
    told = []
    for mode, reason in list(refused.items())[:8]:
        on = [
            repr(port.name) for port, sign in zip(ports, mode, strict=True)
            if port.switch is not None and port.switch.is_on(sign)
        ]  # fmt: skip
        told.append(f"on {', '.join(on) or 'none'}: {reason}")
    return SimulationError(
        f"at t = {now.t:.9g} no mode of the switches is consistent; tried {'; '.join(told)}. "
        "A switch that both modes send back needs a hysteresis: an off of its own"
    )


def _glanced(
    now: Occasion, here: Sight, mode: Mode, switches: list[int]
) -> Decision | _Refusal | None:
    """What the first look at a mode tells; None where it takes a closer one."""
    if now.glances is None or now.peaks is None:
        return None
    seen = now.glances.seen(here, mode, switches, now.peaks)
    if seen is None:
        return None
    if seen.real and not seen.broken:
        return Decision(mode, here.s, (), clear=True)
    return _Refusal("", seen.broken)


def _tried(now: Occasion, here: Sight, switched: Mode, switches: list[int]) -> Decision | _Refusal:
    """The first consistent mode with the switches as in this one; those listed may contradict it."""
    model = now.model
    try:
        jump = impact(here, switched, now.peaks)
        here = here if jump is None else now.seen(jump.s)
        known, shot = here.evaluated(switched)
    except SlopeNeededError:
        raise
    except SimulationError as error:
        return _Refusal(str(error), NONE)
    away = sides(here, known, now.loose)
    undecided = _undecided(now, here, known, away) if model.rubbing else []
    mode = slipping_as(model, shot, switched, away)
    blocks = blocks_of(model, shot.numbers, undecided)
    if len(blocks) > 1:
        found = _in_blocks(now, here, mode, blocks)
        if isinstance(found, _Refusal):
            return found
        mode, blocks = found, [[]]
    found = _in_block(now, here, mode, blocks[0], [*undecided, *switches], jump)
    if isinstance(found, _Refusal):
        return found
    return Decision(found, here.s, () if jump is None else (jump,))


def _undecided(now: Occasion, here: Sight, mode: Mode, away: Collection[int]) -> list[int]:
    """The friction ports that may stick: at rest, or moved by efforts at once, and not ``away``."""
    model, shot = now.model, here.at(mode)
    slips = np.abs(shot.y[model.friction_readings])
    near = with_leaps(scales(model, shot, now.t, now.peaks), here, shot, now.peaks).slip
    near[list(now.loose)] *= TUNING.wide
    found = [
        i
        for i, slip in enumerate(slips)
        if model.switching[i] is None
        and i not in away
        and (model.coupled_directly(i) or slip <= near[i])
    ]
    if now.log is not None:
        now.log(Rested(mode, tuple(found)))
    return found


def _in_blocks(now: Occasion, here: Sight, mode: Mode, blocks: list[list[int]]) -> Mode | _Refusal:
    """The first way of each block; where some ports depend on others only as they hold, of all at once."""
    found = _side_by_side(now, here, mode, blocks)
    if found is None:
        found = _one_by_one(now, here, mode, blocks)
    if found is None:
        every = sorted(i for block in blocks for i in block)
        return _in_block(now, here, mode, every, every, None)
    return found


def _side_by_side(now: Occasion, here: Sight, mode: Mode, blocks: list[list[int]]) -> Mode | None:
    """The first way of each block, all looked at together: at an instant none touches another."""
    tries = [ways_to_rub(now.previous, block, now.touched) for block in blocks]
    mode = turned_to(mode, *(next(tried) for tried in tries))
    own = {i: tried for block, tried in zip(blocks, tries, strict=True) for i in block}
    every = [i for block in blocks for i in block]
    while True:
        found = _looked_at(now, here, mode, every, None)
        if found.reason is None:
            return mode
        if not found.turned:
            return None
        turned = {tried: found.turned for i in found.turned if (tried := own[i])}
        try:
            mode = turned_to(mode, *[tried.send(way) for tried, way in turned.items()])
        except StopIteration:
            return None


def _one_by_one(now: Occasion, here: Sight, mode: Mode, blocks: list[list[int]]) -> Mode | None:
    """The first way of each block after those before it, where a whole way cannot be looked at.

    None where they contradict one another: what a switch holds may join blocks that nothing else does.
    """
    for block in blocks:
        told = _in_block(now, here, mode, block, block, None)
        if isinstance(told, _Refusal):
            return None
        mode = told
    every = [i for block in blocks for i in block]
    return mode if _looked_at(now, here, mode, every, None).reason is None else None


def _in_block(
    now: Occasion, here: Sight, mode: Mode, block: list[int], asked: list[int], jump: Impact | None
) -> Mode | _Refusal:
    """The first way of sticking and slipping in a block that contradicts none of the ports asked."""
    tried: dict[Mode, _Finding] = {}
    tries = ways_to_rub(now.previous, block, now.touched)
    candidate = turned_to(mode, next(tries))
    while True:
        found = _looked_at(now, here, candidate, asked, jump)
        if found.reason is None:
            return candidate
        tried[candidate] = found
        try:
            candidate = turned_to(mode, tries.send(found.turned))
        except StopIteration:
            return _refused(here, tried)


def _refused(here: Sight, told: dict[Mode, _Finding]) -> _Refusal:
    """Why no way is consistent; with it the switches that contradict the first that friction lets be."""
    broken = next((found.broken for found in told.values() if found.broken), NONE)
    reasons = {str(found.reason) for found in told.values()}
    if len(told) == 1 or (len(reasons) == 1 and all(found.none for found in told.values())):
        return _Refusal(reasons.pop(), broken)
    names = ", ".join(repr(p.name) for p in here.model.program.friction if p.switch is None)
    listed = "; ".join(f"{mode}: {found.reason}" for mode, found in list(told.items())[:MOST_TOLD])
    first = next(iter(told))
    slips = here.evaluated(first)[1].y[here.model.friction_readings]
    return _Refusal(
        f"at t = {here.t:.9g} no way of sticking and slipping at {names} is consistent "
        f"(slips {slips.tolist()}); tried {listed}",
        broken,
    )


def _looked_at(
    now: Occasion, here: Sight, mode: Mode, asked: Sequence[int], jump: Impact | None
) -> _Finding:
    """What contradicts a mode, of the ports asked."""
    model = now.model
    try:
        look = look_at(here, mode, now.peaks)
        wrong = ruled_out(look) or torn(look)
        if wrong is not None:
            return _noted(now, mode, _Finding(wrong))
        later: dict[int, int] = {}
        shocks = [0] * len(mode) if jump is None else pushed(look, now.t, jump)
        verdicts = {i: shocks[i] or look.verdict(i) for i in asked}
        contrary = [i for i, sure in verdicts.items() if sure < 0]
        tied = [i for i, sure in verdicts.items() if sure == 0]
        if not contrary and (tied or len(look.ruled[0])):
            then = _moment_later(now, look)
            wrong = ruled_out_later(look, then)
            later = {i: look.later_verdict(i, then, now.ahead) for i in tied}
            contrary = [i for i, sure in later.items() if sure < 0]
    except SlopeNeededError:
        raise
    except SimulationError as error:
        return _noted(now, mode, _Finding(str(error), none=True))
    if wrong is not None or not contrary:
        return _noted(now, mode, _Finding(wrong), verdicts, later)
    rubbing = [i for i in contrary if model.switching[i] is None]
    broken = NONE if rubbing else frozenset(contrary)
    reason = _contradiction(look, (rubbing or contrary)[0])
    found = _Finding(reason, broken, turned=_turned(look, rubbing))
    return _noted(now, mode, found, verdicts, later)


def _noted(
    now: Occasion, mode: Mode, found: _Finding, verdicts: Mapping[int, int] | None = None,
    later: Mapping[int, int] = MappingProxyType({}),
) -> _Finding:  # fmt: skip
    """What was found, once note is taken of it."""
    if now.log is not None:
        now.log(Tried(mode, verdicts, later))
    return found


def _turned(look: Look, ports: Sequence[int]) -> dict[int, int]:
    """Where ports that contradict a mode would go: one that slips sticks, one that sticks slips as pushed."""
    efforts = look.now.u[look.model.friction_inputs]
    return {i: 0 if look.mode[i] else 1 if efforts[i] > 0 else -1 for i in ports}


def _moment_later(now: Occasion, look: Look) -> Look:
    """The same mode a little later, with what counts as zero now."""
    later = a_moment_later(look.here, look.mode, now.ahead)
    return Look(look.here, look.mode, now.t + now.ahead, later, look.size, now.peaks)


def _contradiction(look: Look, port: int) -> str:
    name, sign = look.model.program.friction[port].name, look.mode[port]
    if look.model.switching[port] is not None:
        return f"{name!r} would change over at once"
    if sign:
        return f"{name!r} would not slip in the direction {sign:+d}"
    effort = look.now.u[look.model.friction_inputs[port]]
    return f"{name!r} would need {effort:.6g} of at most {look.now.caps[port]:.6g} to stick"


def a_moment_later(here: Sight, mode: Mode, ahead: float) -> Snapshot:
    """The model a little later in a mode, by one midpoint step."""
    model, t, s, pieces = here.model, here.t, here.s, here.pieces
    half = s + 0.5 * ahead * here.at(mode).rate
    moved = s + ahead * model.at(t + 0.5 * ahead, half, pieces, mode).rate
    return model.at(t + ahead, moved, pieces, mode)
