"""Which ports hold and which are let go, and which way these slip: one consistent mode at one instant."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np

from bondgraph.errors import SimulationError
from codegen.inputs.pieces import Piece
from codegen.model.snapshot import Impact, Mode, Snapshot
from codegen.modes.closed import ClosedModel
from codegen.modes.impact import impact, pushed
from codegen.modes.rounding import Peaks, scales
from codegen.modes.trials import evaluated
from codegen.modes.verdicts import Look, look_at, ruled_out, ruled_out_later
from codegen.numbers.arrays import Array
from codegen.ports.refusals import SlopeNeededError
from codegen.standalone.switchings import Broken, switchings
from codegen.tuning import TUNING

NONE: Broken = frozenset()


@dataclass(frozen=True)
class Occasion:
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


class Decision(NamedTuple):
    """A mode, the integrated vector with which it begins, and the impact that led to it, if any."""

    mode: Mode
    s: Array
    impact: Impact | None


class _Refusal(NamedTuple):
    """Why there is no mode with the switches so, and which of them would have to change over."""

    reason: str
    broken: Broken


def decide(now: Occasion, s: Array) -> Decision:
    """The mode just after an instant, of the integrated vector s before it.

    Every loose port at rest sticks if it can, else slips the way it is pushed; other ports slip the way
    their slip shows. Where several modes are consistent, ports not touched keep their state, and so do all
    switches. A mode that cannot be evaluated is none: laws without a solution in it,
    ports without unique holding efforts.

    Raises `SimulationError`, with the numbers, if no mode is consistent.
    """
    if not now.previous:
        return Decision((), s, None)
    switching = now.model.switching
    switches = [i for i, switch in enumerate(switching) if switch is not None]
    refused: dict[Mode, str] = {}
    tries = switchings(now.previous, switches)
    mode = next(tries)
    while True:
        found = _tried(now, s, mode)
        if isinstance(found, Decision):
            return found
        refused[mode] = found.reason
        try:
            mode = tries.send(found.broken)
        except StopIteration:
            raise _none_consistent(now, refused) from None


def _none_consistent(now: Occasion, refused: dict[Mode, str]) -> SimulationError:
    if not now.model.program.switches:
        return SimulationError(next(iter(refused.values())))
    ports = now.model.program.friction
    told = []
    for mode, reason in list(refused.items())[:8]:
        on = [
            repr(port.name) for port, sign in zip(ports, mode, strict=True)
            if port.switch is not None and port.switch.word(sign) == "on"
        ]  # fmt: skip
        told.append(f"on {', '.join(on) or 'none'}: {reason}")
    return SimulationError(
        f"at t = {now.t:.9g} no mode of the switches is consistent; tried {'; '.join(told)}. "
        "A switch that both modes send back needs a hysteresis: an off of its own"
    )


def _tried(now: Occasion, before: Array, switched: Mode) -> Decision | _Refusal:
    """The first consistent mode with the switches as in this one."""
    model = now.model
    try:
        jump = impact(model, now.t, before, now.pieces, switched, now.peaks)
        s = before if jump is None else jump.s
        slips, undecided = _undecided(now, s, switched)
    except SlopeNeededError:
        raise
    except SimulationError as error:
        return _Refusal(str(error), NONE)
    tried: dict[Mode, str] = {}
    errors: set[str] = set()
    broken = NONE
    for mode in _candidates(switched, model, slips, undecided, now.touched):
        try:
            complaint, wrong = _complaint(now, s, mode, undecided, jump)
        except SlopeNeededError:
            raise
        except SimulationError as error:
            complaint, wrong = str(error), NONE
            errors.add(complaint)
        if complaint is None:
            return Decision(mode, s, jump)
        tried[mode], broken = complaint, broken or wrong
    if len(tried) == 1 or (errors == set(tried.values()) and len(errors) == 1):
        return _Refusal(next(iter(tried.values())), broken)
    names = ", ".join(repr(port.name) for port in model.program.friction if port.switch is None)
    listed = "; ".join(f"{mode}: {complaint}" for mode, complaint in tried.items())
    return _Refusal(
        f"at t = {now.t:.9g} no way of sticking and slipping at {names} is consistent "
        f"(slips {slips.tolist()}); tried {listed}",
        broken,
    )


def _undecided(now: Occasion, s: Array, switched: Mode) -> tuple[Array, list[int]]:
    """The slips, and the friction ports that may stick: at rest, or moved by efforts at once."""
    model = now.model
    _, shot = evaluated(model, now.t, s, now.pieces, switched)
    slips = shot.y[model.friction_readings]
    near = scales(model, shot, now.t, now.peaks).slip
    wide = np.where([i in now.loose for i in range(len(slips))], TUNING.wide, 1.0)
    return slips, [
        i for i, slip in enumerate(slips)
        if model.switching[i] is None
        and (model.coupled_directly(i) or abs(slip) <= wide[i] * near[i])
    ]  # fmt: skip


def _candidates(
    previous: Mode, model: ClosedModel, slips: Array, undecided: list[int],
    touched: frozenset[int],
) -> Iterator[Mode]:  # fmt: skip
    """Modes by the number of ports that stick, most first; then those that change least."""

    def rank(choice: tuple[int, ...]) -> tuple[int, int]:
        kept = [i for i in undecided if i not in touched]
        changed = sum(choice[undecided.index(i)] != previous[i] for i in kept)
        return -choice.count(0), changed

    choices = sorted(
        product(*((0, previous[i] or 1, -(previous[i] or 1)) for i in undecided)),
        key=rank,
    )
    for choice in choices:
        mode = [
            sign if switch is not None else 1 if slip > 0 else -1
            for sign, switch, slip in zip(previous, model.switching, slips, strict=True)
        ]
        for i, sign in zip(undecided, choice, strict=True):
            mode[i] = sign
        yield tuple(mode)


def _complaint(
    now: Occasion, s: Array, mode: Mode, undecided: Sequence[int], jump: Impact | None
) -> tuple[str | None, Broken]:
    """What contradicts a mode, None if it is consistent; and the switches that do.

    Raises `SimulationError` if it is no mode.
    """
    model = now.model
    look = look_at(model, now.t, s, now.pieces, mode, now.peaks)
    wrong = ruled_out(look)
    if wrong is not None:
        return wrong, NONE
    verdicts = {i: look.verdict(i) for i in undecided}
    switches = [i for i, switch in enumerate(model.switching) if switch is not None]
    shocks = np.zeros(len(mode), dtype=int) if jump is None else pushed(look, now.t, jump)
    verdicts |= {i: int(shocks[i]) or look.verdict(i) for i in switches}
    contrary = [i for i, sure in verdicts.items() if sure < 0]
    tied = [i for i, sure in verdicts.items() if sure == 0]
    if not contrary and (tied or len(look.ruled[0])):
        later = a_moment_later(model, now.t, s, now.pieces, mode, now.ahead)
        guards = model.guards(now.t + now.ahead, later) if len(look.guards) else look.guards
        then = Look(model, mode, later, look.size, guards, look.near)
        wrong = ruled_out_later(look, then)
        contrary = [i for i in tied if look.later_verdict(i, then) < 0]
    if wrong is not None or not contrary:
        return wrong, NONE
    rubbing = [i for i in contrary if model.switching[i] is None]
    broken = NONE if rubbing else frozenset(contrary)
    return _contradiction(look, (rubbing or contrary)[0]), broken


def _contradiction(look: Look, port: int) -> str:
    name, sign = look.model.program.friction[port].name, look.mode[port]
    if look.model.switching[port] is not None:
        return f"{name!r} would change over at once"
    if sign:
        return f"{name!r} would not slip in the direction {sign:+d}"
    effort = look.now.u[look.model.friction_inputs[port]]
    return f"{name!r} would need {effort:.6g} of at most {look.now.caps[port]:.6g} to stick"


def a_moment_later(
    model: ClosedModel, t: float, s: Array, pieces: Sequence[Piece], mode: Mode, ahead: float
) -> Snapshot:
    """The model a little later in a mode, by one midpoint step."""
    half = s + 0.5 * ahead * model.at(t, s, pieces, mode).rate
    moved = s + ahead * model.at(t + 0.5 * ahead, half, pieces, mode).rate
    return model.at(t + ahead, moved, pieces, mode)
