"""The maps of friction modes of many runs at once."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from codegen.abreast.matrices import (
    RunsBinding,
    forwards_map,
    matrices_of,
    solved,
    stacked,
)
from codegen.model.affine_modes import in_mode, let_go
from codegen.model.moves import Moves, moves
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array, Flags
from codegen.program.affine import AffineMap
from codegen.program.layout import RATE
from codegen.standalone.holding import HeldSet, Hold
from codegen.standalone.matrices import Numbers
from codegen.tuning import TUNING

NONE: Array = np.zeros((0, 0))


SWEEPS = 4
"""So often each row and column are balanced."""


@dataclass(frozen=True)
class ModeMap:
    """A mode of all runs: its maps, what holds its sticking ports, and the largest rate [1/s] of each run.

    ``norms``: bounds on the matrices of rates in norms in which these are about balanced. ``sound``: the runs
    whose numbers leave no doubt that these ports have unique holding efforts.
    """

    maps: AffineMap
    hold: Hold | None
    fastest: Array
    norms: Array
    sound: Flags


class ModesAbreast:
    """All that modes are in so many runs, made as they are asked for.

    ``model``: that of any of the runs, which tells what is exact. ``sizes``: by columns how large each run's
    external inputs are beside those that all share.
    """

    def __init__(
        self, model: ClosedModel, parameters: Mapping[str, float | Array], sizes: Array
    ) -> None:
        program, runs = model.program, len(sizes)
        self.model, self._modes = model, dict[Mode, ModeMap | None]()
        objects = matrices_of(program, parameters, runs)
        binding = RunsBinding(program, parameters)
        inputs = len(program.external)
        forwards = forwards_map(program, binding, objects, model.slips, inputs, runs)
        ones = np.ones((runs, program.size))
        columns = np.hstack([ones, sizes, sizes, ones[:, :1]])
        forwards.matrix[...] *= columns[:, None, :]
        self.numbers = Numbers(*(stacked(matrix, runs) for matrix in vars(objects).values()))
        #: Which runs have finite numbers throughout.
        self.finite: Flags = np.asarray(np.isfinite(forwards.matrix).all(axis=(1, 2)))
        self._base = let_go(forwards, self.numbers, model.friction_inputs)

    @cached_property
    def moves(self) -> Moves:
        """How slips change in each run."""
        model = self.model
        return moves(self.numbers, model.friction_readings, model.friction_inputs)

    @cached_property
    def touching(self) -> Array:
        """Which ports' efforts move which ports' slips in each run."""
        model, m = self.model, self.numbers
        rows, columns = model.friction_readings, model.friction_inputs
        moved = m.F[:, rows] @ m.Q[:, :, columns]
        return np.asarray((moved != 0) | (m.D[:, rows][:, :, columns] != 0))

    def of(self, mode: Mode) -> ModeMap | None:
        """A mode; None of one in which not every port that sticks binds states by itself.

        Raises `SimulationError` where the ports of the one model cannot hold.
        """
        if mode not in self._modes:
            self._modes[mode] = self._made(mode)
        return self._modes[mode]

    def _made(self, mode: Mode) -> ModeMap | None:
        stuck = [i for i, sign in enumerate(mode) if sign == 0]
        hold, sound = None, self.finite
        if stuck:
            if not _binds(self.model.slips.held(tuple(stuck)), len(stuck)):
                return None
            hold = self._hold(stuck)
            sound = self.finite & self._holds(mode, hold)
        maps = in_mode(self._base, mode, hold, self.model.program.law_rates)
        rates = maps.rows(RATE)[:, :, : self.model.size]
        sound = sound & np.isfinite(maps.matrix).all(axis=(1, 2))
        rates = np.where(sound[:, None, None], rates, 0.0)
        fastest = np.abs(np.linalg.eigvals(rates)).max(axis=1)
        return ModeMap(maps, hold, fastest, _norms(rates), sound)

    def _holds(self, mode: Mode, hold: Hold) -> Flags:
        """Which runs have unique holding efforts, by nothing that those of the one model do not need.

        Ports that act with other factors than they are acted on with are stopped in another way.
        """
        exact = self.model.hold(mode, self.model.constant)
        pushed = self.numbers.Q[:, :, hold.inputs]
        by = hold.slip_x @ pushed
        aside = np.abs(pushed + hold.take_away @ by)
        sizes = np.abs(pushed) + np.abs(hold.take_away) @ np.abs(by)
        wanted = np.abs(hold.V).max(axis=1) > TUNING.nothing_held
        found = np.isfinite(hold.inverse).all(axis=(1, 2))
        largest = sizes.max(axis=(1, 2), keepdims=True)
        found &= (aside <= TUNING.consistent * largest).all(axis=(1, 2))
        found &= ~(wanted & (np.abs(exact.V).max(axis=0) <= TUNING.nothing_held)).any(axis=1)
        return np.asarray(found)

    def _hold(self, stuck: Sequence[int]) -> Hold:
        """The holding equations of ports each of which binds the states by itself; see `holding.hold`."""
        model, numbers, runs = self.model, self.numbers, len(self.numbers.A)
        rows = np.array(model.friction_readings)[list(stuck)]
        chosen = np.array(model.friction_inputs)[list(stuck)]
        slip_x, slip_u = numbers.F[:, rows], numbers.D[:, rows]
        U = slip_x @ numbers.Q
        moved = solved(numbers.A, slip_x.transpose(0, 2, 1))
        none = np.zeros((runs, 0, len(stuck)))
        return Hold(
            np.array(stuck), chosen, X=slip_x @ numbers.P, U=U,
            V=slip_x @ numbers.R + slip_u, inverse=_inverse(U[:, :, chosen]),
            share=none, ways=none, ruled=none, slip_x=slip_x, slip_u=slip_u,
            fixed=slip_u + slip_x @ numbers.R, take_away=-moved @ _inverse(slip_x @ moved),
            mix=np.broadcast_to(np.eye(len(stuck)), (runs, len(stuck), len(stuck))), free=none,
        )  # fmt: skip


def _norms(matrices: Array) -> Array:
    """Bounds on the norms of matrices that are balanced first: E. E. Osborne, J. ACM 7 (1960) 338-345.

    >>> _norms(np.array([[[0.0, 1e6], [1.0, -2.0]]])).tolist()
    [1002.0]
    """
    sizes, own = np.abs(matrices), np.abs(np.diagonal(matrices, axis1=1, axis2=2))
    count = range(sizes.shape[1])
    sizes[:, count, count] = 0.0
    for i in SWEEPS * [*count]:
        row, column = sizes[:, i].sum(axis=1), sizes[:, :, i].sum(axis=1)
        both = (row > 0) & (column > 0)
        factor = np.sqrt(np.divide(row, column, out=np.ones_like(row), where=both))[:, None]
        sizes[:, :, i] *= factor
        sizes[:, i] /= factor
    sizes[:, count, count] = own
    return np.asarray(np.minimum(sizes.sum(axis=1).max(axis=1), sizes.sum(axis=2).max(axis=1)))


def _inverse(matrices: Array) -> Array:
    """The inverses of a stack; not finite where one is none, or nearly so."""
    eye = np.broadcast_to(np.eye(matrices.shape[1]), matrices.shape)
    return solved(matrices, eye)


def _binds(found: HeldSet, count: int) -> bool:
    """Whether each of so many ports that stick binds the states by itself, and no law answers."""
    every = tuple(range(count))
    alone = not (found.moved or found.direct or found.ruled)
    return alone and found.null == every and found.kept == every
