"""Which holding equations are independent, for every set of sticking ports: decided exactly."""

from dataclasses import dataclass

import sympy as sp

from bondgraph.errors import StructureError
from codegen.ports.slips import SlipRows, independence
from codegen.program.records import Program

MOST_PORTS = 6
"""A table has an entry for every set of sticking ports: two to the power of this at most."""


@dataclass(frozen=True)
class Structure:
    """Ranks of one set of sticking ports; numbers are positions within the set or states.

    ``moved``: the coupled laws, by position, that the ports' efforts move. ``direct``: rows of D over the
    set and these that are independent, in ``direct_columns``. ``null``: the other ports,
    each of which leads a combination of slips that efforts do not change at once. ``kept``: those
    combinations, by position in ``null``, that are independent in the states ``kept_columns``.
    ``ruled``: whether other inputs rule a combination that is none of these.
    """

    moved: tuple[int, ...]
    direct: tuple[int, ...]
    direct_columns: tuple[int, ...]
    null: tuple[int, ...]
    kept: tuple[int, ...]
    kept_columns: tuple[int, ...]
    ruled: bool


def structures(program: Program, slips: SlipRows) -> tuple[Structure, ...]:
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
    chosen = [[i for i in range(count) if stuck >> i & 1] for stuck in range(2**count)]
    return tuple(_structure(program, slips, ports) for ports in chosen)


def _structure(program: Program, slips: SlipRows, ports: list[int]) -> Structure:
    found, answering = independence(slips, ports), slips.answering(ports)
    moved = tuple(program.coupled.inputs.index(j) for j in answering[len(ports) :])
    rest = tuple(i for i in range(len(ports)) if i not in found.direct)
    D = slips.D.extract([ports[i] for i in found.direct], answering)
    seen = found.null * slips.F.extract(ports, list(range(slips.F.cols)))
    kept = seen.extract(list(found.kept), list(range(seen.cols)))
    return Structure(moved, found.direct, _pivots(D), rest, found.kept, _pivots(kept), found.ruled)


def _pivots(matrix: sp.Matrix) -> tuple[int, ...]:
    """Columns in which independent rows are."""
    return tuple(matrix.rref()[1]) if matrix.rows and matrix.cols else ()
