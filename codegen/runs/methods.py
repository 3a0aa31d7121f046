"""The methods that a run may be integrated by; another one is another line."""

from dataclasses import dataclass
from functools import partial
from typing import Any

import scipy

from codegen.runs.explicit import explicit
from codegen.runs.sundials import Cvode
from codegen.tuning import TUNING

METHODS: dict[str, tuple[str, str]] = {
    "auto": ("DOP853", "Radau"),
    "DOP853": ("DOP853", "DOP853"),
    "Radau": ("Radau", "Radau"),
    "CVODE": ("Adams", "BDF"),
}
"""The integrator of each method by name: where the model is not stiff, and where it is."""

EXACT = "exact"
"""The method of models that are affine in each friction mode: no integrator, matrix exponentials."""

CHOICES = (EXACT, *METHODS)
"""What a run's method may be."""


def integrator(name: str) -> Any:
    """What makes the solver of a stretch: CVODE's, or scipy's class, which is loaded when first asked for."""
    if name in METHODS["CVODE"]:
        return partial(Cvode, name)
    return explicit() if name == "DOP853" else getattr(scipy.integrate, name)


@dataclass
class Turns:
    """Which of the two integrators of "auto" a stretch of ``size`` states goes by, told by its steps.

    Explicit steps that stability alone holds back, many in a row, give way to implicit ones; these give way
    again where they stand for few stable ones, and are then tried later. ``located_turns.c`` does the same.
    """

    size: int
    explicit: bool
    count: int = 0
    begin: float = 0.0
    patience: int = TUNING.patience

    def over(self, t: float, step: float, fastest: float, error: float, stop: float) -> bool:
        """Whether the other integrator goes on from t, where a step of that length and error ended.

        ``fastest`` [1/s]: the largest rate; ``stop`` [s]: where the stretch ends at the latest.
        """
        found = (
            self._tired(t, step * fastest, error, (stop - t) * fastest)
            if self.explicit
            else self._short(t, fastest)
        )
        if found:
            self.patience *= 1 if self.explicit else TUNING.later
            self.explicit, self.count = not self.explicit, 0
        return found

    def _tired(self, t: float, length: float, error: float, left: float) -> bool:
        held = length >= TUNING.held and error <= TUNING.eased
        self.count = self.count + 1 if held else 0
        return self.count >= self.patience and left > TUNING.worth

    def _short(self, t: float, fastest: float) -> bool:
        lot = TUNING.lot_implicit
        self.count += 1
        if self.count == lot:
            # They grow at first.
            self.begin = t
        if self.count < 2 * lot:
            return False
        mean, self.begin, self.count = (t - self.begin) / lot, t, lot
        return mean * fastest < TUNING.gain + TUNING.gain_size * self.size
