"""Which friction ports stick and which way the others slip: one consistent mode at one instant."""

from collections.abc import Iterator, Sequence
from itertools import product

from bondgraph.errors import SimulationError
from codegen.inputs.pieces import Piece
from codegen.model.snapshot import Mode, Snapshot
from codegen.modes.closed import ClosedModel
from codegen.modes.rounding import Peaks, scales
from codegen.modes.trials import evaluated
from codegen.modes.verdicts import Look, ruled_out, ruled_out_later
from codegen.numbers.arrays import Array
from codegen.ports.refusals import SlopeNeededError


def decide(
    model: ClosedModel,
    t: float,
    s: Array,
    pieces: Sequence[Piece],
    previous: Mode,
    at_zero: frozenset[int],
    ahead: float,
    peaks: Peaks | None = None,
    touched: frozenset[int] = frozenset(),
) -> Mode:
    """The mode just after t: every port in ``at_zero`` sticks if it can, else slips the way it is pushed.

    Other ports slip the way their slip shows. Where several modes are consistent, ports not ``touched``
    by the event keep their state. ``ahead`` [s] is how far to look where the instant itself
    does not decide. A mode that cannot be evaluated is none: laws without a solution in it, ports without
    unique holding efforts. Raises `SimulationError`, with the numbers, if no mode is consistent.
    """
    if not previous:
        return ()
    undecided = set(at_zero) | {i for i in range(len(previous)) if model.coupled_directly(i)}
    _, now = evaluated(model, t, s, pieces, previous)
    slips = now.y[model.friction_readings]
    near = scales(model, now, t, peaks).slip
    undecided |= {i for i, slip in enumerate(slips) if abs(slip) <= near[i]}
    tried: dict[Mode, str] = {}
    errors: set[str] = set()
    for mode in _candidates(previous, slips, sorted(undecided), touched):
        try:
            complaint = _complaint(model, t, s, pieces, mode, sorted(undecided), ahead, peaks)
        except SlopeNeededError:
            raise
        except SimulationError as error:
            complaint = str(error)
            errors.add(complaint)
        if complaint is None:
            return mode
        tried[mode] = complaint
    if errors == set(tried.values()) and len(errors) == 1:
        raise SimulationError(errors.pop())
    names = ", ".join(repr(port.name) for port in model.program.friction)
    listed = "; ".join(f"{mode}: {complaint}" for mode, complaint in tried.items())
    raise SimulationError(
        f"at t = {t:.9g} no way of sticking and slipping at {names} is consistent "
        f"(slips {slips.tolist()}); tried {listed}"
    )


def _candidates(
    previous: Mode, slips: Array, undecided: list[int], touched: frozenset[int]
) -> Iterator[Mode]:
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
        mode = [1 if slip > 0 else -1 for slip in slips]
        for i, sign in zip(undecided, choice, strict=True):
            mode[i] = sign
        yield tuple(mode)


def _complaint(
    model: ClosedModel,
    t: float,
    s: Array,
    pieces: Sequence[Piece],
    mode: Mode,
    undecided: Sequence[int],
    ahead: float,
    peaks: Peaks | None,
) -> str | None:
    """What contradicts a mode; None if it is consistent. Raises `SimulationError` if it is no mode."""
    now = model.at(t, s, pieces, mode)
    look = Look(model, mode, now, scales(model, now, t, peaks))
    wrong = ruled_out(look)
    if wrong is not None:
        return wrong
    verdicts = {i: look.verdict(i) for i in undecided}
    wrong = next((_contradiction(look, i) for i, sure in verdicts.items() if sure < 0), None)
    tied = [i for i, sure in verdicts.items() if sure == 0]
    if wrong is not None or not (tied or len(look.ruled[0])):
        return wrong
    later = a_moment_later(model, t, s, pieces, mode, ahead)
    wrong = ruled_out_later(look, later)
    lost = (_contradiction(look, i) for i in tied if look.later_verdict(i, later) < 0)
    return wrong or next(lost, None)


def _contradiction(look: Look, port: int) -> str:
    name, sign = look.model.program.friction[port].name, look.mode[port]
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
