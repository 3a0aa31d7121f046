"""One smooth stretch of a run in one friction mode, up to a breakpoint or the first event."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import DOP853, Radau

from bondgraph import SimulationError
from codegen.arrays import Array
from codegen.closed import ClosedModel, Mode
from codegen.events import Dense, Event, Watch
from codegen.pieces import Piece

METHODS = {"DOP853": DOP853, "Radau": Radau}

STIFF = 2e5
"""Time span over shortest time constant from which the implicit method is chosen."""

STEP_BOUND = 1.0
"""An explicit step's length in shortest time constants: beyond, its interpolant is unreliable."""

SMALLEST_SPAN = 200
"""Steps are never longer than the span of the run divided by this."""


REFRESH = 50
"""Steps after which a nonlinear model's time constants are looked at again."""


@dataclass
class Track:
    """What a run has recorded: the integrated vector and the mode at each sample, and the events."""

    vectors: Array
    modes: list[Mode]
    events: list[Event] = field(default_factory=list)
    recorded: int = 0

    def record(self, vector: Array, mode: Mode) -> None:
        """The next sample."""
        self.vectors[self.recorded] = vector
        self.modes.append(mode)
        self.recorded += 1


@dataclass(frozen=True)
class Settings:
    """How to integrate: method, relative and absolute tolerance."""

    method: str
    rtol: float
    atol: float


class Leg:
    """A smooth stretch in one mode; ``span`` [s] is the length of the whole run."""

    def __init__(
        self,
        model: ClosedModel,
        pieces: Sequence[Piece],
        mode: Mode,
        settings: Settings,
        span: float,
    ) -> None:
        self._model, self._pieces, self._mode = model, pieces, mode
        self._settings, self._span = settings, span

    def fastest(self, t: float, s: Array) -> float:
        """The largest rate [1/s] of the mode's linearisation and of the inputs."""
        base = self._rate(t, s)
        jacobian = np.empty((len(s), len(s)))
        for j in range(len(s)):
            step = 1e-6 * max(1.0, abs(s[j]))
            moved = s.copy()
            moved[j] += step
            jacobian[:, j] = (self._rate(t, moved) - base) / step
        inner = float(np.abs(np.linalg.eigvals(jacobian)).max(initial=0.0))
        return max(inner, *(piece.fastest for piece in self._pieces), 0.0)

    def run(
        self, t: float, s: Array, stop: float, times: Array, track: Track
    ) -> tuple[float, Array, frozenset[int]]:
        """Integrate to ``stop`` or the first event; the ports whose event it was come third.

        Samples strictly before the end are recorded: at the end the next leg shows the instant after.
        """
        if stop - t <= 8 * np.spacing(max(abs(t), abs(stop))):
            return stop, s, frozenset()
        fastest = self.fastest(t, s)
        name = self._settings.method
        if name == "auto":
            name = "Radau" if fastest * self._span > STIFF else "DOP853"
        solver = METHODS[name](
            self._rate, t, s, stop, rtol=self._settings.rtol, atol=self._settings.atol,
            max_step=self._bound(name, fastest),
        )  # fmt: skip
        watch, steps = Watch(self._model, self._pieces, self._mode, t, s), 0
        while solver.status == "running":
            message = solver.step()
            if solver.status == "failed":
                raise SimulationError(f"at t = {solver.t:.9g} the integrator failed: {message}")
            dense = solver.dense_output()
            found = watch.first_event(solver.t_old, solver.t, dense)
            until = solver.t if found is None else found[0]
            self._sample(times, track, until, dense)
            if found is not None:
                return until, dense(until), found[1]
            steps += 1
            if steps % REFRESH == 0 and not self._model.program.affine:
                solver.max_step = self._bound(name, self.fastest(solver.t, solver.y))
        return stop, solver.y, frozenset()

    def _bound(self, name: str, fastest: float) -> float:
        """The longest step: events and inputs must not fall between, nor the interpolant be strained."""
        bound = self._span / SMALLEST_SPAN
        return min(bound, STEP_BOUND / fastest) if name == "DOP853" and fastest > 0 else bound

    def _sample(self, times: Array, track: Track, until: float, dense: Dense) -> None:
        while track.recorded < len(times) and times[track.recorded] < until:
            track.record(dense(float(times[track.recorded])), self._mode)

    def _rate(self, t: float, s: Array) -> Array:
        rate = self._model.at(t, s, self._pieces, self._mode).rate
        if not np.isfinite(rate).all():
            raise SimulationError(f"at t = {t:.9g} the rates are not finite; state {s.tolist()}")
        return rate
