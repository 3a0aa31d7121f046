"""What known sources of a model do, as far as a stepper has come, and a while beyond."""

from collections.abc import Callable, Sequence

from codegen.inputs.signal import Signal

AHEAD = 64.0
"""So many steps ahead sources are told, at the least."""


class Sources:
    """The signals of known sources, told anew, over twice the time, where a step comes beyond."""

    def __init__(self, told: Callable[[float, float], Sequence[Signal]], begin: float) -> None:
        self._told, self._begin = told, begin
        #: Between which times [s] they are known.
        self.since, self.end = begin, begin
        self.signals = tuple(told(begin, begin))

    def reach(self, t: float, stop: float) -> bool:
        """Know what they do from t up to ``stop`` [s] and a little after; whether they are told anew."""
        if not self.signals or (self.since <= t and stop < self.end):
            return False
        end = stop + max(AHEAD * (stop - t), stop - self._begin)
        self.signals, self.since, self.end = tuple(self._told(t, end)), t, end
        return True
