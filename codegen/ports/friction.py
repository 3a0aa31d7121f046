"""What holds ports that stick: linear equations for their efforts, their structure decided exactly.

For the sticking ports s, ``y_s = F_s x + D_s u = 0``. Rows of D_ss that are independent determine
efforts at once (a resistance lies beside the port). Along the left null space N of D_ss the
constraint rules the states instead: ``N^T y_s' = 0``, that is ``N^T F_s A^-1 (J x + B u) + ... = 0``.
What neither determines is how redundant ports share a load; and where other inputs rule such a
combination of slips, a source or a law, the ports stick only while it is zero and stays so.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import sympy as sp

from bondgraph.errors import SimulationError
from codegen.model.numbers import Numbers, scaled_solve
from codegen.numbers.arrays import Array
from codegen.ports.sharing import fair_share
from codegen.ports.slips import SlipRows, independence
from codegen.program.records import Program


class SlopeNeededError(SimulationError):
    """Ports could hold, but what holds them needs the slope in time of what a law gives."""


@dataclass(frozen=True)
class Hold:
    """The holding equations ``X x + U u + V u' = 0`` of one set of sticking ports.

    ``share``: directions in which the holding efforts may change without moving anything. ``ruled``: the
    same as combinations of slips, where other inputs rule them: the ports hold only while these are zero.
    ``slip_x``, ``slip_u``: the slips that constrain the states, independent, as ``slip_x x + slip_u u``.
    ``take_away``: what to add to x per unit of those slips to remove them, along ``A^-1 F^T``.
    """

    ports: tuple[int, ...]
    X: Array
    U: Array
    V: Array
    #: Inverse of the square system for the efforts, the rows of ``share`` appended.
    inverse: Array
    share: Array
    ruled: Array
    slip_x: Array
    slip_u: Array
    take_away: Array

    @property
    def shares(self) -> bool:
        """Whether redundant ports share a load; one that nothing can load gives nothing."""
        return bool(np.count_nonzero(self.share.any(axis=0)) > len(self.share))

    def efforts(self, x: Array, u: Array, du: Array, inputs: Sequence[int], caps: Array) -> Array:
        """The holding efforts; u must hold zero at the sticking ports. Redundant ports share fairly."""
        known = self.X @ x + self.U @ u + self.V @ du
        right = np.concatenate([-known, np.zeros(len(self.share))])
        efforts: Array = self.inverse @ right
        return fair_share(efforts, self.share, caps) if len(self.share) else efforts


def hold(program: Program, model: Numbers, slips: SlipRows, ports: tuple[int, ...]) -> Hold:
    """The holding equations of the friction ports with these numbers, ranks taken from exact rows."""
    found, chosen = independence(slips, ports), list(ports)
    N_kept = _array(found.null.extract(list(found.kept), list(range(found.null.cols))))
    rows = [program.friction[i].reading for i in chosen]
    inputs, direct = [program.friction[i].input for i in chosen], list(found.direct)
    F_s, D_s, G_s = model.F[rows], model.D[rows], model.G[rows]
    slip_x, slip_u = N_kept @ F_s, N_kept @ D_s
    X = np.vstack([F_s[direct], slip_x @ model.P])
    U = np.vstack([D_s[direct], slip_x @ model.Q])
    V = np.vstack([G_s[direct], slip_x @ model.R + slip_u])
    share = _array(found.share)
    alone = len(slips.answering(chosen)) == len(chosen)
    return Hold(
        ports,
        X,
        U,
        V,
        # Where laws answer as well, all are searched for together.
        inverse=_inverse(np.vstack([U[:, inputs], share])) if alone else np.zeros((0, 0)),
        share=share,
        ruled=share if found.ruled else share[:0],
        slip_x=slip_x,
        slip_u=slip_u,
        take_away=_take_away(model, slip_x),
    )


def _take_away(model: Numbers, slip_x: Array) -> Array:
    """``-A^-1 S^T (S A^-1 S^T)^-1``: the impulse that stops the slips S x, and moves nothing else."""
    if not len(slip_x):
        return np.zeros((slip_x.shape[1], 0))
    moved = scaled_solve(model.A, slip_x.T)
    return np.asarray(-moved @ _inverse(slip_x @ moved), dtype=float)


def _inverse(matrix: Array) -> Array:
    try:
        return np.asarray(np.linalg.inv(matrix), dtype=float)
    except np.linalg.LinAlgError:
        raise SimulationError(
            "sticking ports have no unique holding efforts: the storages behind them cancel; "
            "check the signs of their values"
        ) from None


def _array(matrix: sp.Matrix) -> Array:
    return np.array(matrix.evalf(30).tolist(), dtype=float).reshape(matrix.shape)
