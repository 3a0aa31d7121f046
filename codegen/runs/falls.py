"""Where what is watched in an exact stretch first falls to zero, by power series over its steps."""

from collections.abc import Callable, Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from codegen.inputs.polynomials import first_fall, to_bernstein, value
from codegen.model.snapshot import Mode
from codegen.modes.pace import moment
from codegen.modes.rounding import Peaks
from codegen.modes.trials import Sight
from codegen.modes.verdicts import limits_of, look_at
from codegen.numbers.arrays import Array, all_of
from codegen.runs.watched import Watched
from codegen.tuning import TUNING


def falls(here: Sight, mode: Mode, peaks: Peaks, system: Watched, z: Array | None) -> "Falls":
    """The triggers of a stretch that begins ``here``.

    ``z``: the system's components where it begins; None where all triggers are well above zero.
    """

    def limits() -> Array:
        look = look_at(here, mode, peaks)
        limits = np.where(look.ruling.any(axis=0), look.size.slip, limits_of(look))
        return np.asarray(limits[list(system.ports)], dtype=float)

    values = None if z is None else system.triggers @ z
    return Falls(system.ports, limits, here.t, peaks.time, values)


class Falls:
    """Triggers of ports from t [s] on; one that begins at zero must rise before it falls.

    ``limits``: below these they count as zero at t. ``time`` [s]: the shortest time constant. ``values``:
    theirs at t; None where all are well above zero.
    """

    def __init__(
        self, ports: Sequence[int], limits: Callable[[], Array], t: float, time: float,
        values: Array | None,
    ) -> None:  # fmt: skip
        self._ports, self._told, self._t, self._time = ports, limits, t, time
        self._armed = np.ones(len(ports), dtype=np.bool_)
        if values is not None:
            self._armed = np.asarray(values >= self._limits, dtype=np.bool_)
        self._ready = values is None or all_of(self._armed)

    @cached_property
    def _limits(self) -> Array:
        return self._told()

    @property
    def ready(self) -> bool:
        """Whether every trigger has been well above zero."""
        return self._ready

    def first(
        self, powers: Array, t: float, step: float
    ) -> tuple[int, float, frozenset[int]] | None:
        """Step, place in it and ports of the first event among steps, by their triggers' series."""
        if not len(self._armed):
            return None
        shapes = powers @ to_bernstein(TUNING.degree).T
        if self._ready and all_of(shapes > 0):
            return None
        least, most = shapes.min(axis=2), shapes.max(axis=2)
        suspects = self._suspects(least, most)
        at = 0
        while at < len(powers):
            ahead = np.flatnonzero(suspects[at:].any(axis=1))
            if not len(ahead):
                return None
            at += int(ahead[0])
            roots: dict[int, float] = {}
            for row in np.flatnonzero(suspects[at]).tolist():
                root = self._root(row, powers[at, row], (t - self._t) + at * step, step)
                if root is not None:
                    port = self._ports[row]
                    roots[port] = min(root, roots.get(port, 2.0))
            if roots:
                tau = min(roots.values())
                near = tau + TUNING.together * max(1.0, (t + at * step) / step)
                return at, tau, frozenset(p for p, root in roots.items() if root <= near)
            at += 1
            suspects[at:] = self._suspects(least[at:], most[at:])
        return None

    def _suspects(self, least: Array, most: Array) -> NDArray[np.bool_]:
        """Triggers that may fall in a step, or rise from zero, by their bounds in it."""
        if self._ready:
            return np.asarray(least <= 0)
        rests = (most < self._limits) & (least > -2 * self._limits)
        return np.asarray(np.where(self._armed, least <= 0, ~rests), dtype=np.bool_)

    def _root(self, row: int, powers: Array, elapsed: float, step: float) -> float | None:
        """Where one trigger falls in a step; one that began at zero is armed when it has risen."""
        begin = 0.0
        if not self._armed[row]:
            limit = self._limits[row]
            rise, fall = -powers, powers.copy()
            rise[0] += limit
            fall[0] += 2 * limit
            armed = 0.0 if rise[0] <= 0 else first_fall(rise)
            blind = min(max((moment(self._time) - elapsed) / step, 0.0), 1.0)
            lost = blind if value(fall, blind) <= 0 else first_fall(fall, blind)
            if armed is None or (lost is not None and lost < armed):
                return lost if lost is not None and lost < 1.0 else None
            self._armed[row], begin = True, armed
            self._ready = all_of(self._armed)
        root = first_fall(powers, begin)
        if root is not None and powers.sum() > 0:
            # It comes back: a touch, unless it fell below zero by more than rounding.
            below = powers.copy()
            below[0] += self._limits[row]
            return root if first_fall(below, root) is not None else None
        return root
