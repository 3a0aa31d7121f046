"""Which law has no value at an instant, and where it was asked for one."""

from collections.abc import Iterator

import numpy as np
import sympy as sp

from bondgraph.algebra.expressions import TIME
from codegen.model.snapshot import Snapshot
from codegen.program.gains import written_out
from codegen.program.records import Program

MOST = 6
"""So many of the names that a law reads are told with their values."""


def wanting(program: Program, t: float, shot: Snapshot) -> str:
    """The law without a finite value, and what it reads; else that the rates have none.

    A law that gives no number goes before one that is infinite, which may be what it reads.
    """
    listed = list(_laws(program))
    for lost in (np.isnan, np.isinf):
        for port, column, law in listed:
            if lost(shot.u[column]):
                read = _read(program, t, shot, law)
                return f"the law at {port!r} has no finite value{f' at {read}' if read else ''}"
    return "the rates are not finite"


def _laws(program: Program) -> Iterator[tuple[object, int, sp.Expr]]:
    for group in (program.known, *program.groups, program.coupled):
        yield from zip(group.ports, group.inputs, written_out(group.values), strict=True)


def _read(program: Program, t: float, shot: Snapshot, law: sp.Expr) -> str:
    values: dict[sp.Symbol, float] = {TIME: t}
    for names, array in (
        (program.external, shot.external), (program.inputs, shot.u), (program.readings, shot.y),
        (program.law_states, shot.z), (program.states, shot.x),
    ):  # fmt: skip
        values |= dict(zip(names, array.tolist(), strict=False))
    told = [name for name in sorted(law.free_symbols, key=str) if name in values][:MOST]
    return ", ".join(f"{name} = {values[name]:.6g}" for name in told)
