"""Which holding equations are independent, for every set of sticking ports: decided exactly."""

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp

from bondgraph import StateEquations, StructureError
from codegen.model.friction import exact_rows
from codegen.program import Program

MOST_PORTS = 6
"""A table has an entry for every set of sticking ports: two to the power of this at most."""


@dataclass(frozen=True)
class Structure:
    """Ranks of one set of sticking ports; all numbers are positions within the set or states.

    ``direct``: rows of D_ss that are independent, in ``direct_columns``. ``null``: the other ports,
    each of which leads a combination of slips that efforts do not change at once. ``kept``: those
    combinations, by position in ``null``, that are independent in the states ``kept_columns``.
    """

    direct: tuple[int, ...]
    direct_columns: tuple[int, ...]
    null: tuple[int, ...]
    kept: tuple[int, ...]
    kept_columns: tuple[int, ...]


def structures(
    program: Program, equations: StateEquations, parameters: Mapping[str, sp.Rational]
) -> tuple[Structure, ...]:
    """For every set of sticking friction ports, numbered by its bits, its structure.

    Raises `StructureError` for more friction ports than a table can have.
    """
    count = len(program.friction)
    if count > MOST_PORTS:
        names = ", ".join(repr(port.name) for port in program.friction)
        raise StructureError(
            f"{names} are {count} friction ports; generated C decides for every set of them what "
            f"holds it, and takes at most {MOST_PORTS}"
        )
    F, D = exact_rows(program, equations, parameters)
    chosen = [[i for i in range(count) if stuck >> i & 1] for stuck in range(2**count)]
    return tuple(_structure(F.extract(p, range(F.cols)), D.extract(p, p)) for p in chosen)


def _structure(F: sp.Matrix, D: sp.Matrix) -> Structure:
    if not D.rows:
        return Structure((), (), (), (), ())
    direct = list(D.T.rref()[1])
    null = [vector.T for vector in D.T.nullspace()]
    rest = tuple(i for i in range(D.rows) if i not in direct)
    used = [j for j in range(F.cols) if any(F[i, j] != 0 for i in range(F.rows))]
    seen = sp.zeros(len(null), len(used))
    if null and used:
        seen = sp.Matrix.vstack(*null) * F.extract(list(range(F.rows)), used)
    kept = list(seen.T.rref()[1]) if null and used else []
    columns = seen.extract(kept, list(range(seen.cols))).rref()[1] if kept else ()
    direct_columns = D.extract(direct, list(range(D.cols))).rref()[1] if direct else ()
    return Structure(
        tuple(direct),
        tuple(direct_columns),
        rest,
        tuple(kept),
        tuple(used[j] for j in columns),
    )
