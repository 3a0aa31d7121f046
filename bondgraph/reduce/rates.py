"""Rates of states replaced by what rules them: ``H x'`` with ``A x' = J x + B u + E u'`` put in."""

from collections.abc import Iterable, Sequence
from dataclasses import replace

import sympy as sp

from bondgraph.algebra.exact import FixedRow, Row, add_scaled, solve
from bondgraph.reduce.record import Reading, ReadingSum


def reached(A: Sequence[FixedRow], start: Iterable[int]) -> list[int]:
    """The states that A, whose entries stand in symmetric places, couples to some of them."""
    found = set(start)
    pending = list(found)
    while pending:
        new = A[pending.pop()].keys() - found
        found |= new
        pending += new
    return sorted(found)


def resolved(A: Sequence[FixedRow], balances: Sequence[Reading], reading: Reading) -> Reading:
    """A reading with x' substituted: one solve with A^T, on the block of A that it touches.

    ``balances``: the right sides of ``A x' = ...``, row by row; what they hold of x' is not looked at.
    """
    if not reading.H:
        return reading
    block = reached(A, reading.H)
    place = {state: at for at, state in enumerate(block)}
    transposed: list[Row] = [{} for _ in block]
    for i in block:
        for j, entry in A[i].items():
            transposed[place[j]][place[i]] = entry
    right = [{0: reading.H[i]} if i in reading.H else {} for i in block]
    result = ReadingSum(replace(reading, H={}))
    for i, solved in zip(block, solve(transposed, right), strict=True):
        factor = solved.get(0, sp.Integer(0))
        if factor != 0:
            add_scaled(result.F, balances[i].F, factor)
            add_scaled(result.D, balances[i].D, factor)
            add_scaled(result.K, balances[i].K, factor)
    return result.whole()
