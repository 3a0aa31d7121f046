"""Runs of a family side by side: the same model with other numbers, as long as nothing is doubtful."""

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from bondgraph.errors import BondGraphError
from codegen.abreast.asked import Asked, Sized
from codegen.abreast.course import Course
from codegen.abreast.fit import Sound, even, fits, suits
from codegen.abreast.fleet import Fleet
from codegen.abreast.leading import Leader, Precedents
from codegen.abreast.modes import ModesAbreast
from codegen.abreast.results import Shared, result_of
from codegen.inputs.present import Inputs
from codegen.numbers.arrays import Array, Flags
from codegen.program.layout import STATES
from codegen.program.units import told_units
from codegen.record.columns import column_places
from codegen.record.result import Result
from codegen.runs.impulses import refuse_impulses
from codegen.runs.methods import EXACT
from codegen.simulator import Simulator
from codegen.tuning import TUNING

BLOCK = 512
"""Fewer samples than these count as so many: a run has its steps between."""

Alone = Callable[[Sequence[float]], Result]
"""A run by itself, of a row of numbers."""


def abreast(asked: Asked) -> "Abreast | None":
    """What does these runs side by side; None where they have to be done one by one."""
    family = asked.family
    ready = family.backend == "numpy" and asked.method in ("auto", EXACT) and even(asked.times)
    if not ready or not fits(family.program, family.equations, asked.swept):
        return None
    try:
        made = Abreast(asked, family.simulator())
    except BondGraphError:
        # Of the family's own numbers; each run is told of its own.
        return None
    return made if suits(made.model) else None


class Abreast:
    """Does runs side by side; made once for a sweep. ``ready``: the family with its own numbers.

    Exact decisions are taken from that: what is swept must not change them, or a run is done by itself.
    """

    def __init__(self, asked: Asked, ready: Simulator) -> None:
        self._asked, self._ready, self.model = asked, ready, ready.closed
        self._inputs, self._precedents = Sized(asked), Precedents()
        self._sound = Sound(asked.family.equations, asked.swept)
        self._names, self._units = (
            column_places(self.model.program),
            told_units(self.model.equations),
        )
        refuse_impulses(self.model, self._inputs.units, asked.times)

    def results(self, rows: Array, alone: Alone) -> list[Result | None]:
        """The record of each run, None of those that have to be done by themselves.

        ``alone``: a run by itself, for what its record does not hold.
        """
        found: list[Result | None] = []
        each = max(len(self._asked.times), BLOCK) * self.model.size
        many = max(1, TUNING.beside_at_once // each)
        with np.errstate(all="ignore"):
            for begin in range(0, len(rows), many):
                part = rows[begin : begin + many]
                try:
                    found += self._part(part, alone)
                except (BondGraphError, np.linalg.LinAlgError):
                    found += [None] * len(part)
        return found

    def _part(self, rows: Array, alone: Alone) -> list[Result | None]:
        parameters, sizes = self._asked.parameters(rows), self._inputs.sizes(rows)
        modes = ModesAbreast(self.model, parameters, sizes)
        fleet = self._fleet(rows, modes)
        fleet.alone |= ~(self._sound.of(parameters, len(rows)) & self._same(modes))
        fleet.alone |= ~np.isfinite(rows).all(axis=1)

        def lead(run: int) -> Leader:
            model = self._asked.family.simulator(**self._asked.changes(rows[run])).closed
            present = Inputs(self._inputs.of(rows[run])).at(float(fleet.t[run]))
            return Leader(model, fleet.s[run].copy(), present)

        times, units = self._asked.times, self._inputs.units
        Course(modes, fleet, units, times, self._precedents, lead).run()
        fleet.alone |= ~(np.abs(fleet.vectors).max(axis=(1, 2)) < TUNING.ordinary)
        shared = Shared(fleet, modes, *self._sampled(), sizes, self._names)
        return [
            None if gone else self._record(shared, run, partial(alone, rows[run].tolist()))
            for run, gone in enumerate(fleet.alone.tolist())
        ]

    def _same(self, modes: ModesAbreast) -> Flags:
        """Which runs have finite numbers, and slips and outputs that surely depend on no more than here."""
        model, own = self.model, modes.numbers
        direct = own.D[:, model.friction_readings][:, :, model.friction_inputs]
        shown = (own.G != 0) == (model.constant.G != 0)
        same: Flags = modes.finite & ~direct.any(axis=(1, 2)) & shown.all(axis=(1, 2))
        return same

    def _fleet(self, rows: Array, modes: ModesAbreast) -> Fleet:
        """The runs at their starts."""
        asked, runs, size = self._asked, len(rows), self.model.size
        program, begin = self.model.program, float(asked.times[0])
        states, s = asked.states(rows), np.zeros((runs, size))
        s[:, : states.shape[1]] = states
        given = np.array([unit(begin) for unit in self._inputs.units])
        forwards = modes.of(tuple(1 for _ in program.friction))
        assert forwards is not None
        x, n = forwards.maps.rows(STATES), len(program.states)
        # What inputs that drive dependent storages add to states; their rates do not.
        s[:, :n] -= x[:, :, size : size + len(given)] @ given + x[:, :, -1]
        both = np.zeros((runs, n + len(program.inputs)))
        vectors = np.zeros((runs, len(asked.times), size))
        return Fleet(np.full(runs, begin), s, both, np.zeros(runs), vectors)

    def _sampled(self) -> tuple[Array, Array]:
        """The inputs that all runs share and their rates, by samples."""
        times, units = self._asked.times, self._inputs.units
        inputs = np.array([unit.sampled(times) for unit in units]).reshape(-1, len(times)).T
        rates = np.zeros_like(inputs)
        if self.model.program.rated and len(units):
            rates = np.array([unit.sampled(times, rates=True) for unit in units]).T
        return inputs, rates

    def _record(self, shared: Shared, run: int, alone: Callable[[], Result]) -> Result:
        ready, asked = self._ready, self._asked
        names = ready.states, ready.inputs, ready.outputs
        return result_of(shared, run, asked.times, names, self._units, asked.events, alone)
