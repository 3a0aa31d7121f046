"""Where many runs are, and what they have recorded."""

from dataclasses import dataclass, field

import numpy as np

from codegen.model.snapshot import Mode
from codegen.numbers.arrays import Array, Flags
from codegen.runs.track import Event


@dataclass
class Fleet:
    """So many runs, by rows: times [s], integrated vectors, and these at the samples.

    ``both``: the largest magnitudes of states and inputs. ``time`` [s]: shortest time constants. ``latest``
    [s]: when the last event was. ``alone``: which have to be done by themselves.
    """

    t: Array
    s: Array
    both: Array
    time: Array
    vectors: Array
    latest: Array = field(init=False)
    alone: Flags = field(init=False)
    #: Of each run from which sample on it is in which mode, later ones over earlier ones.
    modes: list[dict[int, Mode]] = field(init=False)
    events: list[list[Event]] = field(init=False)

    def __post_init__(self) -> None:
        runs = len(self.t)
        self.latest, self.alone = np.full(runs, -np.inf), np.zeros(runs, dtype=bool)
        self.modes, self.events = [{} for _ in range(runs)], [[] for _ in range(runs)]

    def note(self, run: int, sample: int, mode: Mode) -> None:
        """From a sample on a run is in another mode."""
        own = self.modes[run]
        for later in [at for at in own if at >= sample]:
            del own[later]
        own[sample] = mode

    def stretches(self, run: int) -> list[tuple[int, int, Mode]]:
        """The samples of a run by modes: from the first to before the last."""
        own = self.modes[run]
        begins = sorted(own)
        ends = [*begins[1:], self.vectors.shape[1]]
        return [(a, b, own[a]) for a, b in zip(begins, ends, strict=True) if a < b]
