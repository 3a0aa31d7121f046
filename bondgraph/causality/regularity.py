"""Which causality of the ports makes the bond equations solvable: decided by exact rank.

A choice of what each port gives is regular when the columns of what the ports receive, in the
equations of junctions, transformers and gyrators, are independent. Because the structure conserves
power, any independent set of columns, one per port, extends to all ports; so ports can be decided
one after the other, in order of preference, and nothing has to be taken back.
"""

import heapq
from collections.abc import Iterator, Sequence

from bondgraph.algebra.elimination import ResidueRows, Row
from bondgraph.algebra.residues import PRIME, residues
from bondgraph.causality.record import Strokes
from bondgraph.errors import AlgebraicLoopError, CausalityError


def regular_ports(
    strokes: Strokes, order: Sequence[int], preferred: dict[int, str]
) -> dict[int, str]:
    """What each port gives ("effort" or "flow") so that the bond equations have one solution.

    Ports bonded directly to a port are left out: their stroke alone decides.

    ``order``: the one-ports' node numbers, most important first. ``preferred``: what each should
    give; a port whose element fixes it must.

    Raises `CausalityError` if fixed ports exclude each other, `AlgebraicLoopError` if the structure
    is singular whatever the ports give.
    """
    rows = ResidueRows(_equations(strokes))
    inner = [
        2 * bond + part
        for bond, ends in enumerate(strokes.bonds)
        if not any(strokes.elements[node].one_port for node in ends)
        for part in (0, 1)
    ]
    _eliminate_inner(strokes, rows, inner)
    result: dict[int, str] = {}
    owner: dict[int, int] = {}
    for node in order:
        bond = strokes.at[node][0]
        if strokes.elements[strokes.other(bond, node)].one_port:
            continue
        first = preferred[node]
        second = "flow" if first == "effort" else "effort"
        choices = [first] if strokes.elements[node].gives is not None else [first, second]
        for gives in choices:
            column = 2 * bond + (gives == "effort")
            if rows.pivot(column):
                result[node], owner[column] = gives, node
                break
        else:
            others = {owner[c] for c in rows.pivots_meeting(2 * bond + (first == "effort"))}
            raise _refusal(strokes, node, sorted(others - {node}))
    return result


def _refusal(strokes: Strokes, node: int, others: list[int]) -> CausalityError:
    if not others:
        return CausalityError(
            f"{strokes.names[node]!r} imposes its {strokes.elements[node].gives} where the "
            "structure alone determines it already; remove it or add an element between"
        )
    names = ", ".join(repr(strokes.names[other]) for other in [*others, node])
    return CausalityError(
        f"{names} exclude each other: what each imposes follows from what the others impose; "
        "remove one, or put a storage or a resistance between"
    )


def _eliminate_inner(strokes: Strokes, rows: ResidueRows, inner: list[int]) -> None:
    heap = [(len(rows.columns.get(column, ())), column) for column in inner]
    heapq.heapify(heap)
    while heap:
        count, column = heapq.heappop(heap)
        now = len(rows.columns.get(column, ()))
        if now != count and now > 0:
            heapq.heappush(heap, (now, column))
        elif not rows.pivot(column, jordan=False):
            bond = column // 2
            tail, head = strokes.declared[bond]
            kind = "flow" if column % 2 else "effort"
            raise AlgebraicLoopError(
                f"the {kind} of bond {tail!r} -> {head!r} stays undetermined whatever the elements "
                "are: the determinant of the loop it lies on vanishes; open the loop (two paths "
                "that impose the same relation) or put an element on it"
            )


def _equations(strokes: Strokes) -> Iterator[Row]:
    """The equations of all junctions, transformers and gyrators, coefficients as residues."""
    value = residues()
    for node, element in enumerate(strokes.elements):
        bonds = strokes.at[node]
        if element.kind.joins:
            common = 0 if element.kind.common == "effort" else 1
            for bond in bonds[1:]:
                yield {2 * bonds[0] + common: 1, 2 * bond + common: PRIME - 1}
            yield {
                2 * b + 1 - common: 1 if strokes.bonds[b][1] == node else PRIME - 1 for b in bonds
            }
        elif element.kind.two_port:
            inward = next(b for b in bonds if strokes.bonds[b][1] == node)
            outward = next(b for b in bonds if strokes.bonds[b][0] == node)
            modulus, gyrator = PRIME - value(element.value), element.kind.gyrates
            yield {2 * inward: 1, 2 * outward + gyrator: modulus}
            yield {2 * outward + (not gyrator): 1, 2 * inward + 1: modulus}
