"""What holds ports that stick: linear equations for their efforts, their structure decided exactly.

For the sticking ports s, ``y_s = F_s x + D_s u = 0``. Rows of D_ss that are independent determine
efforts at once (a resistance lies beside the port). Along the left null space N of D_ss the
constraint rules the states instead: ``N^T y_s' = 0``, that is ``N^T F_s A^-1 (J x + B u) + ... = 0``.
What neither determines is how redundant ports share a load.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import sympy as sp

from bondgraph import SimulationError, StateEquations
from codegen.arrays import Array
from codegen.model.numbers import Numbers, at_parameters, scaled_solve
from codegen.model.sharing import fair_share
from codegen.program import Program


@dataclass(frozen=True)
class Hold:
    """The holding equations ``X x + U u + V u' = 0`` of one set of sticking ports.

    ``share``: directions in which the holding efforts may change without moving anything.
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
    slip_x: Array
    slip_u: Array
    take_away: Array

    def efforts(self, x: Array, u: Array, du: Array, inputs: Sequence[int], caps: Array) -> Array:
        """The holding efforts; u must hold zero at the sticking ports. Redundant ports share fairly."""
        known = self.X @ x + self.U @ u + self.V @ du
        right = np.concatenate([-known, np.zeros(len(self.share))])
        efforts: Array = self.inverse @ right
        return fair_share(efforts, self.share, caps) if len(self.share) else efforts


def exact_rows(
    program: Program, equations: StateEquations, parameters: Mapping[str, sp.Rational]
) -> tuple[sp.Matrix, sp.Matrix]:
    """F (friction ports x states) and D (friction ports x friction ports), exact."""
    readings = list(equations.readings.values())
    rows = [readings[port.reading] for port in program.friction]
    F = sp.zeros(len(rows), len(program.states))
    D = sp.zeros(len(rows), len(rows))
    column = {port.input: at for at, port in enumerate(program.friction)}
    for i, row in enumerate(rows):
        for j, entry in row.F.items():
            F[i, j] = at_parameters(entry, parameters)
        for j, entry in row.D.items():
            if j in column:
                D[i, column[j]] = at_parameters(entry, parameters)
    return F, D


def hold(
    program: Program, model: Numbers, F: sp.Matrix, D: sp.Matrix, ports: tuple[int, ...]
) -> Hold:
    """The holding equations of the friction ports with these numbers, ranks taken from exact F and D."""
    chosen = list(ports)
    D_ss = D.extract(chosen, chosen)
    direct = list(D_ss.T.rref()[1])
    null = [vector.T for vector in D_ss.T.nullspace()]
    N = sp.Matrix.vstack(*null) if null else sp.zeros(0, len(chosen))
    constrained = N * F.extract(chosen, list(range(F.cols)))
    kept = list(constrained.T.rref()[1]) if constrained.rows and constrained.cols else []
    free = constrained.T.nullspace() if constrained.rows else []
    share = sp.Matrix.vstack(*[(N.T * v).T for v in free]) if free else sp.zeros(0, len(chosen))
    N_kept = _array(N.extract(kept, list(range(N.cols))))
    rows = [program.friction[i].reading for i in chosen]
    inputs = [program.friction[i].input for i in chosen]
    F_s, D_s, G_s = model.F[rows], model.D[rows], model.G[rows]
    slip_x, slip_u = N_kept @ F_s, N_kept @ D_s
    X = np.vstack([F_s[direct], slip_x @ model.P])
    U = np.vstack([D_s[direct], slip_x @ model.Q])
    V = np.vstack([G_s[direct], slip_x @ model.R + slip_u])
    system = np.vstack([U[:, inputs], _array(share)])
    return Hold(
        ports,
        X,
        U,
        V,
        inverse=_inverse(system),
        share=_array(share),
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
