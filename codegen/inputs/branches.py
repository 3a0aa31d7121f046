"""Expressions of time with corners and jumps, cut where they are into parts that are smooth."""

from collections.abc import Mapping
from itertools import combinations, pairwise

import numpy as np
import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.algebra.lookups import Look
from codegen.inputs.discs import disc_of
from codegen.inputs.discs import known as analytic
from codegen.inputs.polynomials import first_fall, to_bernstein, value
from codegen.inputs.segments import DEGREE, polynomial_segments
from codegen.numbers.arrays import Array
from codegen.numbers.cells import breaks_along, polynomials_between
from codegen.tuning import TUNING

CORNERED = (
    sp.Abs, sp.sign, sp.Heaviside, sp.Max, sp.Min, sp.floor, sp.ceiling, sp.frac, sp.Mod,
    sp.core.relational.Relational, Look,
)  # fmt: skip
"""What has corners or jumps, and tables; a Piecewise has them where its conditions change."""

Part = tuple[float, sp.Expr]
"""Where a part begins [s], and what the expression is from there on."""


def smooth_parts(expr: sp.Expr, begin: float, end: float) -> list[Part]:
    """The expression from ``begin`` to ``end`` [s] as smooth ones, one after the other.

    >>> t = sp.Symbol("t")
    >>> smooth_parts(sp.Abs(t - 2) + t, 0.0, 5.0)
    [(0.0, 2), (2.0, 2*t - 2)]
    """
    atoms = _innermost(expr)
    if not atoms:
        return [(begin, expr)]
    cuts = sorted({cut for atom in atoms for cut in _cuts(atom, begin, end)})
    points = [begin, *cuts, end]
    middles = np.array([0.5 * (a + b) for a, b in pairwise(points)])
    choices = [_choices(atom, middles, points) for atom in atoms]
    known: dict[tuple[sp.Expr, ...], sp.Expr] = {}
    parts: list[Part] = []
    for k, (a, b) in enumerate(pairwise(points)):
        chosen = tuple(choice[k] for choice in choices)
        if chosen not in known:
            known[chosen] = expr.xreplace(dict(zip(atoms, chosen, strict=True)))
        for part in smooth_parts(known[chosen], a, b):
            if not parts or parts[-1][1] != part[1]:
                parts.append(part)
    return parts


def known(expr: sp.Expr) -> bool:
    """Whether an expression of time can be cut into parts that are analytic."""
    atoms = _innermost(expr)
    if not atoms:
        return analytic(_without_choices(expr))
    inner = all(known(argument) for atom in atoms for argument in atom.args)
    return inner and known(expr.xreplace({atom: _stand_in(atom) for atom in atoms}))


def _stand_in(atom: sp.Basic) -> sp.Basic:
    return sp.Dummy("held") > 0 if isinstance(atom, sp.core.relational.Relational) else sp.Dummy()


def _without_choices(expr: sp.Expr) -> sp.Expr:
    """The sum of all values that a Piecewise may have, in its place."""
    choices = {
        part: sp.Add(*(value for value, _ in part.args)) for part in expr.atoms(sp.Piecewise)
    }
    return expr.xreplace(choices) if choices else expr


def _innermost(expr: sp.Expr) -> list[sp.Basic]:
    """What has corners, none inside its own arguments, in a fixed order."""
    found = [atom for atom in expr.atoms(*CORNERED) if TIME in atom.free_symbols]
    inner = [atom for atom in found if not any(part.has(*CORNERED) for part in atom.args)]
    return sorted(inner, key=sp.default_sort_key)


def _cuts(atom: sp.Basic, begin: float, end: float) -> list[float]:
    """Where one of them has its corners, inside the interval."""
    if isinstance(atom, Look):
        sides = [
            place - at for axis, place in enumerate(atom.places) for at in breaks_along(atom, axis)
        ]
    elif isinstance(atom, sp.Max | sp.Min):
        sides = [one - other for one, other in combinations(atom.args, 2)]
    elif isinstance(atom, sp.core.relational.Relational):
        sides = [atom.lhs - atom.rhs]
    elif isinstance(atom, sp.floor | sp.ceiling | sp.frac | sp.Mod):
        sides = [sp.sin(sp.pi * _whole(atom))]
    else:
        sides = [atom.args[0]]
    return [cut for side in sides for cut in crossings(side, begin, end)]


def _whole(atom: sp.Basic) -> sp.Expr:
    """What jumps where it passes a whole number."""
    return atom.args[0] / atom.args[1] if isinstance(atom, sp.Mod) else atom.args[0]


def crossings(expr: sp.Expr, begin: float, end: float) -> list[float]:
    """Where a smooth expression of time changes its sign, between ``begin`` and ``end`` [s].

    >>> [round(t, 9) for t in crossings(sp.sin(sp.Symbol("t")), 1.0, 7.0)]
    [3.141592654, 6.283185307]
    """
    if TIME not in expr.free_symbols:
        return []
    slope = sp.diff(expr, TIME)
    if TIME not in slope.free_symbols:
        root = float(-expr.subs(TIME, 0) / slope)
        return [root] if begin < root < end else []
    found = polynomial_segments(expr, begin, end)
    powers = found.powers @ _unit_interval()
    shapes = powers @ to_bernstein(DEGREE).T
    suspects = (shapes.min(axis=1) <= 0) & (shapes.max(axis=1) >= 0)
    leaves = np.sign(shapes[:, 0])
    enters, lefts, roots = leaves.copy(), found.centres - found.halves, []
    for k in np.flatnonzero(suspects).tolist():
        leaves[k], changes = _changes(powers[k])
        enters[k] = leaves[k] * (-1) ** len(changes)
        roots += [float(lefts[k] + 2 * found.halves[k] * tau) for tau in changes]
    # A root at a seam may be in neither of the two, by rounding.
    roots += lefts[1:][enters[:-1] * leaves[1:] < 0].tolist()
    return [root for root in sorted(roots) if begin < root < end]


def _changes(powers: Array) -> tuple[float, list[float]]:
    """The sign just inside the unit interval, and where a polynomial changes it further on."""
    tau, roots = TUNING.hardly, list[float]()
    begins = sign = 1.0 if value(powers, tau) > 0 else -1.0
    while tau < 1 - TUNING.hardly:
        root = first_fall(sign * powers, tau)
        if root is None:
            break
        tau = max(root, tau) + TUNING.hardly
        if tau < 1 and sign * value(powers, tau) < 0:
            roots.append(root)
            sign = -sign
    return begins, roots


def _unit_interval() -> Array:
    """From coefficients on [-1, 1], by rows, to those on [0, 1]."""
    rows = []
    for k in range(DEGREE + 1):
        row = np.polynomial.polynomial.polypow([-1.0, 2.0], k)
        rows.append(np.pad(row, (0, DEGREE - k)))
    return np.array(rows)


def _choices(atom: sp.Basic, times: Array, points: list[float]) -> list[sp.Basic]:
    """What stands in an atom's place at each of some times, between two of these points."""
    if isinstance(atom, Look):
        return polynomials_between(atom, points, _values)
    if isinstance(atom, sp.Max | sp.Min):
        table = np.array([_values(argument, times) for argument in atom.args])
        which = (table.argmax if isinstance(atom, sp.Max) else table.argmin)(axis=0)
        return [atom.args[at] for at in which.tolist()]
    if isinstance(atom, sp.core.relational.Relational):
        compare = _COMPARED[type(atom)]
        held = compare(_values(atom.lhs - atom.rhs, times), 0.0)
        return [sp.true if one else sp.false for one in np.broadcast_to(held, times.shape).tolist()]
    if isinstance(atom, sp.floor | sp.ceiling | sp.frac | sp.Mod):
        whole = np.floor(_values(_whole(atom), times)).astype(int).tolist()
        return [_jumped(atom, below) for below in whole]
    signs = np.sign(_values(atom.args[0], times)).astype(int).tolist()
    return [_signed(atom, sign) for sign in signs]


def _jumped(atom: sp.Basic, below: int) -> sp.Expr:
    if isinstance(atom, sp.floor):
        return sp.Integer(below)
    if isinstance(atom, sp.ceiling):
        return sp.Integer(below + 1)
    rest = (
        atom.args[0] - below if isinstance(atom, sp.frac) else atom.args[0] - below * atom.args[1]
    )
    return sp.expand(rest)


def _signed(atom: sp.Basic, sign: int) -> sp.Expr:
    if isinstance(atom, sp.Abs):
        return sign * atom.args[0]
    if isinstance(atom, sp.sign):
        return sp.Integer(sign)
    return sp.Rational(1 + sign, 2)


def _values(expr: sp.Expr, times: Array) -> Array:
    return disc_of(expr, times, np.zeros_like(times))[0]


_COMPARED: Mapping[type, np.ufunc] = {
    sp.StrictLessThan: np.less, sp.LessThan: np.less_equal, sp.StrictGreaterThan: np.greater,
    sp.GreaterThan: np.greater_equal, sp.Equality: np.equal, sp.Unequality: np.not_equal,
}  # fmt: skip
