"""Laws at an operating point: how much a port gives per unit of every signal that its law reads."""

from collections.abc import Hashable, Iterable, Mapping
from itertools import product

import sympy as sp

from bondgraph.algebra.atoms import normal
from bondgraph.algebra.called import unguarded
from bondgraph.algebra.expressions import TIME, expression
from bondgraph.algebra.residues import is_zero
from bondgraph.algebra.table_corners import check_tables
from bondgraph.algebra.whole import Below, Floor
from bondgraph.analyse.unknowns import still
from bondgraph.errors import SignalError
from bondgraph.nodes.laws import SLIP, DryFriction, ExpressionLaw, Law

Point = Mapping[sp.Symbol, sp.Expr]
"""Values of signals, and of parameters where they decide on which side of a corner it lies."""


def operating_point(
    at: Mapping[object, object] | None, known: Iterable[sp.Symbol], what: str = "at"
) -> Point:
    """Names and their values there: numbers, or expressions in parameters. ``what``: the argument's name.

    Raises `SignalError` for a name that neither the equations nor a law has.
    """
    if not isinstance(at, Mapping | None):
        raise SignalError(f"{what} must map signals to values, not be {at!r}")
    point = {
        sp.Symbol(str(normal(str(name)))): expression(value, f"operating point of {name}")
        for name, value in (at or {}).items()
    }
    unknown = sorted(point.keys() - set(known), key=str)
    if unknown:
        kinds = "signal, state or parameter" if what == "at" else "open input"
        raise SignalError(f"{what}: no {kinds} is called {unknown[0]}")
    return point


def with_given(point: Point, closed: Mapping[sp.Symbol, Law], moving: set[sp.Symbol]) -> Point:
    """The point with what laws give there, as far as it has what they read.

    ``closed``: input to the law that gives it. ``moving``: the names that have a value at a point.

    Raises `SignalError` where the point contradicts a law that reads nothing.
    """
    found = dict(point)
    left = {name: law for name, law in closed.items() if isinstance(law, ExpressionLaw)}
    while ready := [
        name for name, law in left.items() if law.free_symbols & moving <= found.keys()
    ]:
        for name in ready:
            law = left.pop(name)
            value = law.expression.subs({s: found[s] for s in law.free_symbols & moving})
            off = (found.setdefault(name, value) - value).subs(point)
            if not law.free_symbols & moving and not is_zero(off):
                raise SignalError(
                    f"at: {name} is {found[name]}, but its law gives {value}; leave it out"
                )
            found.setdefault(name, value)
    return found


def slopes(
    law: Law, port: Hashable, received: sp.Symbol, signals: set[sp.Symbol], point: Point
) -> dict[sp.Symbol, sp.Expr]:
    """The derivative of what a law gives by each of the signals it reads, at the operating point.

    Raises `SignalError` where a derivative needs a value that the point lacks, or where the law has a
    corner or a jump there.
    """
    given = as_expression(law, port, received, signals, point)
    read = sorted(given.free_symbols & signals, key=str)
    # The derivative of a modulus is a sign for real names only.
    real = {name: sp.Dummy(name.name, real=True) for name in given.free_symbols}
    plain = {dummy: name for name, dummy in real.items()}
    derivatives = [sp.diff(given.xreplace(real), real[name]).xreplace(plain) for name in read]
    if _switches([given]):
        _at(given, port, signals, point, "value")
    for turn in sorted(given.atoms(sp.atan2), key=str):
        _check_turn(turn, port, signals, point)
    if read:
        check_tables(
            given, f"the law at {port!r}", lambda place: _there(place, port, signals, point)
        )
    found = {
        name: _at(unguarded(slope), port, signals, point, "slope")
        for name, slope in zip(read, derivatives, strict=True)
    }
    return {name: slope for name, slope in found.items() if slope != 0}


def _there(expr: sp.Expr, port: Hashable, signals: set[sp.Symbol], point: Point) -> sp.Expr:
    """A smooth part of a law at the point."""
    _check_given(expr, port, signals, point, "slope")
    return still(expr.subs(point))


def turns_with_slip(law: Law, signals: set[sp.Symbol]) -> bool:
    """Whether the slope of dry friction depends on the side to which it slips."""
    if not isinstance(law, DryFriction):
        return False
    return SLIP in law.curve.free_symbols or bool(law.level.free_symbols & signals)


def as_expression(
    law: Law, port: Hashable, received: sp.Symbol, signals: set[sp.Symbol], point: Point
) -> sp.Expr:
    """A law as an expression; slipping friction on the side on which the operating point lies."""
    if not isinstance(law, DryFriction):
        return law.expression
    if not turns_with_slip(law, signals) and received not in point:
        return law.level
    side = sp.sign(still(point.get(received, sp.Integer(0))))
    if side not in (1, -1):
        raise SignalError(
            f"dry friction at {port!r} slips one way or the other, or sticks: give {received} a number "
            f"that is not 0 in at, or name {port!r} in stuck"
        )
    return side * law.level * law.curve.subs(SLIP, side * received)


def _switches(expressions: Iterable[sp.Expr]) -> list[sp.Expr]:
    """What decides between the branches of laws, by its sign."""
    found: set[sp.Expr] = set()
    for expr in expressions:
        found |= {part.args[0] for part in expr.atoms(sp.Heaviside, sp.DiracDelta, sp.sign, sp.Abs)}
        found |= {part.lhs - part.rhs for part in expr.atoms(sp.core.relational.Relational)}
        found |= {part.crossing for part in expr.atoms(Floor) if part.moves}
        for part in expr.atoms(sp.Max, sp.Min):
            found |= {a - b for a in part.args for b in part.args if str(a) < str(b)}
    return sorted(found, key=str)


def _at(expr: sp.Expr, port: Hashable, signals: set[sp.Symbol], point: Point, what: str) -> sp.Expr:
    """An expression at the point; where a branch changes there, the same on either side of it."""
    _check_given(expr, port, signals, point, what)
    sides = {switch: _sides(switch, port, point) for switch in _switches([expr])}
    away = [part for part in expr.atoms(sp.DiracDelta) if len(sides[part.args[0]]) == 1]
    # Away from its jumps a floor is what it is, and jumps with what it holds.
    plain = {part: Below(part.args[0]) for part in expr.atoms(Floor)
             if len(sides.get(part.crossing, (0,))) == 1}  # fmt: skip
    expr = expr.xreplace({**plain, **dict.fromkeys(away, sp.Integer(0))})
    there = {name: value for name, value in point.items() if name in signals | {TIME}}
    values = [
        _on_sides(expr, dict(zip(sides, chosen, strict=True))).subs(there).doit()
        for chosen in product(*sides.values())
    ]
    if any(v.has(sp.nan, sp.zoo, sp.oo, sp.I) or v.is_real is False for v in values):
        raise SignalError(f"the law at {port!r} has no finite real {what} at the operating point")
    if any(value.has(sp.DiracDelta) or not is_zero(value - values[0]) for value in values):
        corner = next(switch for switch, both in sides.items() if len(both) == 2)
        raise SignalError(
            f"the law at {port!r} has a corner at the operating point, where {corner} = 0; "
            "linearise on one side of it"
        )
    return values[0]


def _check_given(
    expr: sp.Expr, port: Hashable, signals: set[sp.Symbol], point: Point, what: str
) -> None:
    """Refuse a point that lacks what an expression depends on."""
    missing = sorted((expr.free_symbols & (signals | {TIME})) - point.keys(), key=str)
    if missing:
        raise SignalError(
            f"the {what} of the law at {port!r} depends on {', '.join(map(str, missing))}; "
            "give it a value in at"
        )


def _check_turn(turn: sp.Expr, port: Hashable, signals: set[sp.Symbol], point: Point) -> None:
    """Refuse a point at which ``atan2(y, x)`` jumps by a turn, which no slope shows."""
    _check_given(turn, port, signals, point, "value")
    y, x = (still(part.subs(point)) for part in turn.args)
    if is_zero(y) and x.is_number and x <= 0:
        raise SignalError(
            f"the law at {port!r} jumps at the operating point, where {turn.args[0]} = 0; "
            "linearise on one side of it"
        )


def _sides(switch: sp.Expr, port: Hashable, point: Point) -> tuple[int, ...]:
    """The sign of a switch at the point; both where it is zero."""
    value = still(switch.subs(point))
    if value.free_symbols:
        names = ", ".join(sorted(map(str, value.free_symbols)))
        raise SignalError(
            f"the law at {port!r} has a corner where {switch} = 0; on which side the operating point "
            f"lies depends on {names}: give numbers for them in at, too"
        )
    if is_zero(value):
        return (1, -1)
    return (1,) if value > 0 else (-1,)


def _on_sides(expr: sp.Expr, sides: Mapping[sp.Expr, int]) -> sp.Expr:
    """An expression with its branches chosen as if each switch had that sign."""
    chosen: dict[sp.Basic, sp.Basic] = {}
    for switch, side in sides.items():
        for part in expr.atoms(sp.sign, sp.Heaviside, sp.Abs, sp.DiracDelta):
            if part.args[0] == switch:
                chosen[part] = {
                    sp.sign: sp.Integer(side), sp.Heaviside: sp.Rational(side + 1, 2),
                    sp.Abs: side * switch,
                }.get(part.func, part)  # fmt: skip
        for part in expr.atoms(Floor):
            if part.crossing == switch:
                chosen[part] = part.on_side(part.args[0], side)
        for part in expr.atoms(sp.core.relational.Relational):
            if part.lhs - part.rhs == switch:
                chosen[part] = sp.true if part.func(sp.Integer(side), 0) else sp.false
    while (inside := expr.xreplace(chosen)) != expr:
        # What was chosen may hold others.
        expr = inside
    return expr
