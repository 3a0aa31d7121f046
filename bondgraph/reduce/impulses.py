"""Whether what switches do to states is told by the slopes that A has."""

from collections.abc import Iterable, Mapping, Sequence

import sympy as sp

from bondgraph.algebra.elimination import ResidueRows
from bondgraph.algebra.exact import FixedRow
from bondgraph.algebra.residues import residues
from bondgraph.errors import StructureError
from bondgraph.reduce.record import Reading
from bondgraph.reduce.sorting import Reduction
from bondgraph.reduce.switch_port import SwitchPort


def check_impulses(
    switches: Sequence[SwitchPort], reduction: Reduction, A: Sequence[FixedRow],
    readings: Mapping[sp.Symbol, Reading],
) -> None:  # fmt: skip
    """Refuse a switch whose impulse would move storages whose slopes move with it.

    What is exchanged are momenta, and of a law that is turned round A has the slope alone: an impulse found
    by it, as it is before, would not keep their sum. A switch behind a resistance gives no impulse.
    """
    inputs = [reduction.inputs.index(one.port.given) for one in switches]
    rows = [readings[one.port.received] for one in switches]
    value = residues()
    at = {column: place for place, column in enumerate(inputs)}
    direct = ResidueRows(
        {at[j]: found for j, entry in row.D.items() if j in at and (found := value(entry))}
        for row in rows
    )
    if all(direct.pivot(i, jordan=False) for i in range(len(rows))):
        return
    for one, row in zip(switches, rows, strict=True):
        together = _together(A, row.F)
        names = {reduction.names[i] for i in together}
        if any(entry.free_symbols & names for i in together for entry in A[i].values()):
            listed = ", ".join(sorted(map(str, names)))
            raise StructureError(
                f"the switch {one.name!r} would give an impulse to {listed}, whose "
                "storages have laws that are turned round: what it leaves is not told by their slopes. Put a "
                "resistance beside the switch, or linear storages where it acts"
            )


def _together(A: Sequence[FixedRow], first: Iterable[int]) -> set[int]:
    """The states that move at once with these."""
    found, waiting = set[int](), list(first)
    columns: dict[int, set[int]] = {}
    for i, row in enumerate(A):
        for j in row:
            columns.setdefault(j, set()).add(i)
    while waiting:
        at = waiting.pop()
        if at not in found:
            found.add(at)
            waiting += [*A[at], *columns.get(at, ())]
    return found
