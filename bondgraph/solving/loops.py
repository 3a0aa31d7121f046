"""Loops of laws: linear ones are solved exactly, of others the nonlinear equations are left, by name."""

from collections.abc import Collection, Hashable, Mapping
from dataclasses import dataclass

import networkx as nx
import sympy as sp

from bondgraph.algebra.exact import Row, SingularError, add_scaled
from bondgraph.errors import AlgebraicLoopError
from bondgraph.solving.affine import Affine, affine
from bondgraph.solving.blocks import parts_in_order, solved
from bondgraph.solving.steps import Steps, told

Told = Mapping[sp.Symbol, sp.Expr]
"""Names to expressions over each other."""


@dataclass(frozen=True)
class Closed:
    """Names to expressions of which none is over itself, and equations that are left to be solved."""

    told: Told
    implicit: Told


def closed(names: Told, owners: Mapping[sp.Symbol, Hashable]) -> Closed:
    """What determines itself solved, as far as it is linear.

    ``owners``: the names that laws give, to their nodes; every circle has one. Raises
    `AlgebraicLoopError` where a linear loop has no solution, or many.

    >>> u, v, w, x = sp.symbols("u v w x")
    >>> closed({u: v - x, v: -2*u}, {u: "a", v: "b"}).told
    {u: -x/3, v: 2*x/3}
    >>> closed({u: v - x, v: w**3, w: -u}, {u: "a", v: "b"})
    Closed(told={u: v - x, w: -u}, implicit={v: -(v - x)**3})
    """
    found, implicit = dict(names), dict[sp.Symbol, sp.Expr]()
    for part in parts_in_order(_reads(names)):
        if len(part) > 1 or part[0] in names[part[0]].free_symbols:
            loop = _Loop({name: names[name] for name in part}, owners)
            found |= loop.told
            implicit |= loop.implicit
    return Closed({name: expr for name, expr in found.items() if name not in implicit}, implicit)


def _reads(told: Told) -> "nx.DiGraph[sp.Symbol]":
    reads: nx.DiGraph[sp.Symbol] = nx.DiGraph()
    place = {name: at for at, name in enumerate(told)}
    reads.add_nodes_from(told)
    for name, expr in told.items():
        used = sorted(expr.free_symbols & place.keys(), key=place.__getitem__)
        reads.add_edges_from((name, other) for other in used)
    return reads


class _Loop:
    """Names that determine one another: what laws give are the unknowns."""

    def __init__(self, members: Told, owners: Mapping[sp.Symbol, Hashable]) -> None:
        self._members, self._nodes = members, [owners[name] for name in members if name in owners]
        self._unknowns = [name for name in members if name in owners]
        over = _put_in(members, self._unknowns)
        laws = {name: members[name].xreplace(over) for name in self._unknowns}
        parts = {name: affine(law, self._unknowns) for name, law in laws.items()}
        linear = self._solved({name: part for name, part in parts.items() if part is not None})
        others = {
            name: laws[name].xreplace(linear) for name in self._unknowns if name not in linear
        }
        self.told = linear
        self.implicit: dict[sp.Symbol, sp.Expr] = {}
        for part in parts_in_order(_reads(others)):
            circle = len(part) > 1 or part[0] in others[part[0]].free_symbols
            (self.implicit if circle else self.told).update({name: others[name] for name in part})

    def _solved(self, parts: Mapping[sp.Symbol, Affine]) -> dict[sp.Symbol, sp.Expr]:
        """The linear ones, over the unknowns that are not."""
        place = {name: at for at, name in enumerate(parts)}
        matrix: list[Row] = []
        right: list[sp.Expr] = []
        for at, part in enumerate(parts.values()):
            row: Row = {at: sp.Integer(1)}
            add_scaled(
                row, {place[n]: e for n, e in part.factors.items() if n in place}, -sp.Integer(1)
            )
            matrix.append(row)
            others = [e * name for name, e in part.factors.items() if name not in place]
            right.append(sp.Add(part.rest, *others))
        steps = Steps()
        try:
            found = solved(matrix, right, steps)
        except SingularError:
            raise AlgebraicLoopError(
                f"the laws at {', '.join(map(repr, self._nodes))} determine one another at once and leave no "
                "solution or many whatever the parameters are; put a storage between"
            ) from None
        whole = told(found, steps.parts)
        return dict(zip(parts, whole.results, strict=True)) | dict(whole.parts)


def _put_in(members: Told, unknowns: Collection[sp.Symbol]) -> dict[sp.Symbol, sp.Expr]:
    """The members that are no unknowns, over those that are."""
    found: dict[sp.Symbol, sp.Expr] = {}
    for part in parts_in_order(_reads({n: e for n, e in members.items() if n not in unknowns})):
        for name in part:
            found[name] = members[name].xreplace(found)
    return found
