"""A run by the exact C engine that pauses, and goes on from there."""

import math
from collections.abc import Sequence

import numpy as np

from codegen.engine.inputs import Segments, inputs_over
from codegen.engine.packed import Packed
from codegen.engine.runs import CRuns
from codegen.model.kept import Paused
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.program.layout import EXTERNAL, RECORDED
from codegen.runs.track import Event
from codegen.stepping.exact_room import ExactRoom
from codegen.stepping.going import Given, as_signals, only_numbers
from codegen.stepping.plan import Plan, Row


class ExactGoing:
    """The exact engine; `GaveUpError` where it cannot go on."""

    backend = "c"

    def __init__(self, plan: Plan, runs: CRuns, patient: bool) -> None:
        self._plan, self._runs, self._patient = plan, runs, patient
        self._maps, self._given = Maps(runs.model), tuple[Given, ...]()
        self._room: ExactRoom | None = None
        self._inputs: Packed | None = None
        self._row: Row | None = None
        self._fixed, self._renewed = frozenset[int](), False

    def under(self, given: Sequence[Given], t: float) -> None:
        """See `Going`."""
        numbers = only_numbers(self._given, given)
        self._given, self._renewed = tuple(given), True
        if self._inputs is None or numbers is None or not self._fixed.issuperset(numbers):
            self._pack(t)
            return
        for at, value in numbers.items():
            self._inputs.constant[:, at] = value

    def begin(self, t: float, s: Array, mode: Mode) -> Sequence[Event]:
        """See `Going`."""
        room, inputs = self._at
        room.begin(inputs, t, s, mode)
        self._commit(t)
        return room.told()

    def advance(self, stop: float, anew: bool) -> Sequence[Event]:
        """See `Going`."""
        room, inputs = self._at
        events = room.go(inputs, stop, anew, self._renewed)
        self._commit(stop)
        self._renewed = False
        return events

    def row(self) -> Row:
        """See `Going`."""
        assert self._row is not None
        return self._row

    def paused(self) -> Paused:
        """See `Going`."""
        return self._at[0].paused()

    def take_up(self, paused: Paused) -> None:
        """See `Going`."""
        room, inputs = self._at
        room.take_up(inputs, paused)
        self._commit(paused.present.t)

    def _commit(self, t: float) -> None:
        """The run is where it has come to, unless a signal is refused there."""
        room, _ = self._at
        mode, vector = room.come()
        row = ExactRow(t, mode, vector, self._maps)
        if self._plan.turned or not math.isfinite(float(vector.dot(vector))):
            self._plan.check(row)
        self._row = row
        room.commit()

    def _pack(self, t: float) -> None:
        """All inputs anew, from t [s] on."""
        made = inputs_over(as_signals(self._given), t, math.inf)
        engine = self._runs.built(made.slots)
        if self._room is None or self._room.engine is not engine:
            room = ExactRoom(engine, self._runs.model, self._patient)
            inputs = Packed(engine, made, t)
            if self._row is not None:
                room.take_up(inputs, self.paused())
                room.commit()
            self._room, self._inputs = room, inputs
        else:
            self._inputs = Packed(engine, made, t)
        # Constants that no chain adds to, in segments that are not written as a run goes on.
        chained = {chain[0] for chains in made.structures for chain in chains}
        every = set(range(len(self._given))) if isinstance(made, Segments) else set[int]()
        self._fixed = frozenset(every - chained)

    @property
    def _at(self) -> tuple[ExactRoom, Packed]:
        assert self._room is not None
        assert self._inputs is not None
        return self._room, self._inputs


class ExactRow:
    """Everything at an instant of an affine mode, worked out when it is first asked for: see `Row`."""

    __slots__ = ("_maps", "_values", "_vector", "mode", "time")

    def __init__(self, time: float, mode: Mode, vector: Array, maps: "Maps") -> None:
        self.time, self.mode = time, mode
        self._vector, self._maps = vector, maps
        self._values: Sequence[float] | None = None

    @property
    def values(self) -> Sequence[float]:
        """The recorded parts, one after the other."""
        if self._values is None:
            self._values = self._maps.of(self.mode).dot(self._vector).tolist()
        return self._values


class Maps:
    """Of modes the recorded parts of an instant, as rows over what C's maps act on."""

    def __init__(self, model: ClosedModel) -> None:
        self._model, self._kept = model, dict[Mode, Array]()

    def of(self, mode: Mode) -> Array:
        """Those of a mode."""
        if mode not in self._kept:
            self._kept[mode] = self._made(mode)
        return self._kept[mode]

    def _made(self, mode: Mode) -> Array:
        size, count = self._model.size, len(self._model.program.external)
        affine = self._model.affine_map(mode, count)
        assert affine is not None
        outside = np.eye(count, size + 2 * count + 1, size)
        parts = [outside if part == EXTERNAL else affine.rows(part) for part in RECORDED]
        # C has an input where there is none.
        room = max(count, 1)
        places = [*range(size + count), *(size + room + j for j in range(count)), size + 2 * room]
        found = np.zeros((sum(map(len, parts)), size + 2 * room + 1))
        found[:, places] = np.vstack(parts)
        return found
