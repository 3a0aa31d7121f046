"""One smooth stretch of a run in one friction mode, up to a breakpoint or the first event."""

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import scipy

from bondgraph.errors import SimulationError
from codegen.corners.sides import CornerWatch
from codegen.inputs.pieces import Piece
from codegen.model.snapshot import Mode
from codegen.model.wanting import wanting
from codegen.modes.closed import ClosedModel
from codegen.modes.pace import longest_step
from codegen.modes.rounding import Peaks
from codegen.numbers.arrays import Array
from codegen.runs.cornered import CorneredLeg
from codegen.runs.events import Watch
from codegen.runs.methods import METHODS, Turns, integrator
from codegen.runs.progress import Progress, Rates, difference, no_progress
from codegen.runs.track import Dense, Ended, Settings, Track
from codegen.tuning import TUNING

STEP_BOUND = 1.0
"""An explicit step's length in shortest time constants: beyond, its interpolant is unreliable."""


class Leg:
    """A smooth stretch in one mode; ``origin`` [s] is where the run began.

    ``corners``: watches those of its laws, where it is to end at the next; ``first_step`` [s]: tried first.
    """

    def __init__(
        self,
        model: ClosedModel,
        pieces: Sequence[Piece],
        mode: Mode,
        settings: Settings,
        origin: float,
        peaks: Peaks | None = None,
        corners: CornerWatch | None = None,
        first_step: float | None = None,
    ) -> None:
        self._model, self._pieces, self._mode = model, pieces, mode
        self._settings, self._origin, self._peaks = settings, origin, peaks
        self._corners, self._first_step = corners, first_step
        #: The corners at which it ended, its latest step [s], and the largest rate [1/s].
        self.crossed, self.rate = frozenset[int](), 0.0
        self.step: float | None = first_step
        self._rates = model.rates(pieces, mode)

    def fastest(self, t: float, s: Array) -> float:
        """The largest rate [1/s] of the mode's linearisation and of the inputs."""
        affine = self._model.affine_map(self._mode, len(self._pieces))
        inner = self._fastest(t, s) if affine is None else affine.fastest
        return max(inner, *(piece.fastest for piece in self._pieces), 0.0)

    def _fastest(self, t: float, s: Array) -> float:
        return float(np.abs(np.linalg.eigvals(self._differences(t, s))).max(initial=0.0))

    def _differences(self, t: float, s: Array) -> Array:
        base = self._rate(t, s)
        jacobian = np.empty((len(s), len(s)))
        for j in range(len(s)):
            jacobian[:, j] = difference(self._rates, t, s, j, base, longest_step(t - self._origin))
        return jacobian

    def run(self, t: float, s: Array, stop: float, times: Array, track: Track) -> Ended:
        """Integrate to ``stop`` or the first event; the ports whose event it was come third.

        Samples strictly before the end are recorded: at the end the next leg shows the instant after.
        """
        if stop - t <= 8 * np.spacing(max(abs(t), abs(stop))):
            while track.recorded < len(times) and times[track.recorded] < stop:
                track.record(s, self._mode)
                if track.tally is not None:
                    track.tally.record()
            return stop, s, frozenset()
        self.rate = fastest = self.fastest(t, s)
        name = self._integrator(fastest, float(times[-1] - times[0]))
        trials = Trials(self._rates, self._lost)
        solver = self._solver(name, trials, t, s, stop, fastest, self._first_step)
        turns = Turns(len(s), explicit=name == "DOP853")
        watch = Watch(self._model, self._pieces, self._mode, t, s, self._peaks)
        steps, progress = 0, self._progress(t)
        while solver.status == "running":
            message = _stepped(solver)
            if solver.status == "failed":
                raise trials.refused or _failed(solver, message)
            dense = solver.dense_output()
            self.step = solver.t - solver.t_old
            found = self._next(watch, solver.t_old, solver.t, dense)
            until = solver.t if found is None else found[0]
            track.see(solver.y[None])
            self._sample(times, track, until, dense)
            if track.tally is not None:
                track.tally.smooth(solver.t_old, until, dense, self._pieces, self._mode)
            if found is not None:
                return until, dense(until), found[1]
            steps += 1
            progress.check(solver.t, solver.y)
            if turns.explicit and steps % TUNING.refresh == 0 and not self._model.program.affine:
                fastest = self.fastest(solver.t, solver.y)
            chosen = self._settings.method == "auto" and solver.status == "running"
            error = getattr(solver, "error", np.inf)
            if chosen and turns.over(solver.t, self.step, fastest, error, stop):
                fastest = self.fastest(solver.t, solver.y)
                name = METHODS["auto"][not turns.explicit]
                solver = self._solver(name, trials, solver.t, solver.y, stop, fastest, self.step)
            solver.max_step = self._bound(turns.explicit, fastest, solver.t)
        return stop, solver.y, frozenset()

    def _solver(
        self, name: str, trials: "Trials", t: float, s: Array, stop: float, fastest: float,
        step: float | None,
    ) -> Any:  # fmt: skip
        """An integrator from t on; ``step`` [s]: tried first."""
        first = {} if step is None else {"first_step": min(step, stop - t)}
        return integrator(name)(
            trials, t, s, stop, rtol=self._settings.rtol, atol=self._settings.atol,
            max_step=self._bound(name == "DOP853", fastest, t), **first, **self._jacobian(name),
        )  # fmt: skip

    def _jacobian(self, name: str) -> dict[str, Callable[[float, Array], Array]]:
        """What an implicit method is told of slopes: by formulas where there are some, else nothing."""
        slopes = self._model.slopes(self._pieces, self._mode) if name == "Radau" else None
        if slopes is None:
            return {}

        def jac(t: float, s: Array) -> Array:
            found = slopes(t, s)
            return self._differences(t, s) if found is None else found

        return {"jac": jac}

    def _next(
        self, watch: Watch, t_old: float, t_new: float, dense: Dense
    ) -> tuple[float, frozenset[int]] | None:
        """The first event in a step, of no port where it is a corner."""
        found = watch.first_event(t_old, t_new, dense)
        turn = None if self._corners is None else self._corners.first(t_old, t_new, dense)
        if turn is None or (found is not None and found[0] <= turn[0]):
            return found
        self.crossed = turn[1]
        return turn[0], frozenset()

    def _progress(self, t: float) -> Progress:
        driven = max((piece.fastest for piece in self._pieces), default=0.0)
        settings = self._settings
        return Progress(self._rates, self._origin, driven, settings.rtol, settings.atol, t)

    def _integrator(self, fastest: float, span: float) -> str:
        method = self._settings.method
        stiff = fastest * span > TUNING.stiff_span
        if method == "CVODE" and not self._model.program.affine:
            # Laws may grow stiff on the way; backward differences do not mind where they don't.
            stiff = True
        return METHODS[method][stiff]

    def _bound(self, explicit: bool, fastest: float, t: float) -> float:
        """The longest step: events and inputs must not fall between, nor the interpolant be strained."""
        bound = longest_step(t - self._origin)
        driven = max((piece.fastest for piece in self._pieces), default=0.0)
        if explicit:
            return min(bound, STEP_BOUND / fastest) if fastest > 0 else bound
        # Implicit error estimates are blind to what follows an input at once.
        return min(bound, TUNING.followed / driven) if driven > 0 else bound

    def _sample(self, times: Array, track: Track, until: float, dense: Dense) -> None:
        first = track.recorded
        last = first + int(np.searchsorted(times[first:], until, side="left"))
        if last > first:
            track.take(dense(times[first:last]).T, self._mode)

    def _rate(self, t: float, s: Array) -> Array:
        rate = self._rates(t, s)
        # Of few numbers plain ones are quicker.
        if not math.isfinite(sum(rate.tolist())) and not np.isfinite(rate).all():
            raise self._lost(t, s)
        return rate

    def _lost(self, t: float, s: Array) -> SimulationError:
        """Why there are no rates."""
        why = wanting(self._model.program, t, self._model.at(t, s, self._pieces, self._mode))
        return SimulationError(f"at t = {t:.9g} {why}; state {s.tolist()}")


def leg_of(
    model: ClosedModel, pieces: Sequence[Piece], mode: Mode, settings: Settings, origin: float,
    peaks: Peaks | None = None,
) -> Leg | CorneredLeg:  # fmt: skip
    """A stretch of a model, cut at corners where it has some."""

    def made(laws: ClosedModel, corners: CornerWatch | None, first: float | None) -> Leg:
        return Leg(laws, pieces, mode, settings, origin, peaks, corners, first)

    if not model.program.sides:
        return made(model, None, None)
    return CorneredLeg(model, pieces, mode, settings, origin, made)


class Trials:
    """Rates as an integrator tries them: a point without any gives no numbers, and the step is shortened."""

    def __init__(self, rates: Rates, lost: Callable[[float, Array], SimulationError]) -> None:
        self._rates, self._lost = rates, lost
        self._at: tuple[float, Array] | None = None
        self._refused: SimulationError | None = None

    def __call__(self, t: float, s: Array) -> Array:
        """The rates at t and s; no numbers where there are none."""
        if not _is_finite(s):
            # A stage after one without rates has no state: the first tells why.
            return np.full(len(s), np.nan)
        try:
            rate = self._rates(t, s)
        except SimulationError as error:
            self._refused, self._at = error, None
            return np.full(len(s), np.nan)
        if _is_finite(rate):
            self._refused, self._at = None, None
            return rate
        self._refused, self._at = None, (t, s.copy())
        return np.full(len(s), np.nan)

    @property
    def refused(self) -> SimulationError | None:
        """Why the latest point that was tried has no rates; None where it has some."""
        return self._refused if self._at is None else self._lost(*self._at)


def _failed(solver: Any, message: str | None) -> SimulationError:
    """Why an integrator gives up: scipy's do where a step no longer changes the time."""
    if isinstance(solver, scipy.integrate.DOP853 | scipy.integrate.Radau):
        return no_progress(solver.t, "jump there, or grow without bound")
    return SimulationError(f"at t = {solver.t:.9g} the integrator failed: {message}")


def _is_finite(values: Array) -> bool:
    """Whether all are numbers; of a few their sum tells that sooner, unless it is beyond all numbers."""
    return math.isfinite(sum(values.tolist())) or bool(np.isfinite(values).all())


def _stepped(solver: Any) -> Any:
    """One step; what an integrator says that fails. Implicit ones refuse numbers that are not finite."""
    try:
        return solver.step()
    except ValueError as error:
        raise SimulationError(f"at t = {solver.t:.9g} the integrator failed: {error}") from None
