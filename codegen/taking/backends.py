"""One run by each backend: C by exact steps or with events located, and numpy."""

from collections.abc import Callable

from codegen.engine.fallback import Stopped
from codegen.engine.located import METHODS as LOCATED_METHODS
from codegen.engine.located import LocatedRuns
from codegen.engine.runs import CRuns, not_affine
from codegen.engine.status import Status
from codegen.modes.closed import ClosedModel
from codegen.program.records import stepped_in_python
from codegen.runs.hybrid import run_hybrid
from codegen.runs.methods import EXACT
from codegen.taking.asked import Request
from codegen.taking.blocks import Blocks, Sink
from codegen.taking.exact import run_exact
from codegen.taking.located import run_located


def run_into(
    model: ClosedModel, asked: Request, engine: CRuns | None, located: LocatedRuns | None, sink: Sink,
    tell: Callable[[Stopped], None],
) -> tuple[str, Stopped | None]:  # fmt: skip
    """A run into a sink: what ran it, and why C did not, if that was asked to.

    ``tell`` is called of a limit of C's own before numpy begins. Raises `SimulationError` where the run
    cannot go on.
    """
    if located is None:
        in_numpy(model, asked, sink)
        return "numpy", None
    stopped = in_c(model, asked, engine, located, sink)
    if stopped is None:
        return "c", None
    if stopped.limit:
        tell(stopped)
    in_numpy(model, asked, sink)
    return "numpy", stopped


def in_numpy(model: ClosedModel, asked: Request, sink: Sink) -> None:
    """The run in numpy, into a sink; `SimulationError` where it cannot go on."""
    taker = Blocks(model, asked.times, asked.signals, sink)
    taker.begin()
    run_hybrid(
        model, asked.times, asked.begun.s, asked.signals, asked.settings, first=asked.begun.mode,
        keeping=asked.events, corners=asked.corners, taker=taker,
    )  # fmt: skip


def in_c(
    model: ClosedModel, asked: Request, engine: CRuns | None, located: LocatedRuns, sink: Sink
) -> Stopped | None:
    """The run in C, into a sink; or why it cannot go on there."""
    method, first = asked.settings.method, asked.begun.mode
    stopped = Stopped(_unknown(model, method), limit=method != EXACT)
    if model.program.steps:
        return Stopped(f"{stepped_in_python(model.program)}, which C cannot call", limit=True)
    if engine is not None and method in ("auto", EXACT):
        found = run_exact(
            engine, Blocks(model, asked.times, asked.signals, sink), asked.times, asked.begun.s,
            asked.signals, first, asked.events, method == EXACT,
        )  # fmt: skip
        if found.status == Status.OK:
            return None
        stopped = found.stopped
        if found.status == Status.ENDLESS:
            # Step control would have no end either; the loop in Python tells why.
            return stopped
    if method not in LOCATED_METHODS:
        return stopped
    return run_located(located, sink, asked)


def _unknown(model: ClosedModel, method: str) -> str:
    """Why C does not go by a method; exact steps of an affine model may have ended for other reasons."""
    reason = not_affine(model.program) if method == EXACT else None
    return f"C has no method {method!r}{f': {reason}' if reason else ''}"
