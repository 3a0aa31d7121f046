"""Laws at an operating point: how much a port gives per unit of every signal that its law reads."""

from collections.abc import Hashable, Mapping

import sympy as sp

from bondgraph.errors import SignalError
from bondgraph.expressions import TIME, expression, normal
from bondgraph.laws import SLIP, DryFriction, Law


def operating_point(at: Mapping[object, object] | None) -> dict[sp.Symbol, sp.Expr]:
    """Signals and their values there: numbers, or expressions in parameters."""
    if at is None:
        return {}
    if not isinstance(at, Mapping):
        raise SignalError(f"at must map signals to values, not be {at!r}")
    return {
        sp.Symbol(str(normal(str(name)))): expression(value, f"operating point of {name}")
        for name, value in at.items()
    }


def slopes(
    law: Law, port: Hashable, received: sp.Symbol, signals: set[sp.Symbol],
    point: Mapping[sp.Symbol, sp.Expr],
) -> dict[sp.Symbol, sp.Expr]:  # fmt: skip
    """The derivative of what a law gives by each of the signals it reads, at the operating point.

    Raises `SignalError` where a derivative needs a value that the point lacks, or where the law has a
    corner there.
    """
    given = _as_expression(law, port, received, signals, point)
    result: dict[sp.Symbol, sp.Expr] = {}
    # The derivative of a modulus is a sign for real names only.
    real = {name: sp.Dummy(name.name, real=True) for name in given.free_symbols}
    plain = {dummy: name for name, dummy in real.items()}
    for name in sorted(given.free_symbols & signals - {TIME}, key=str):
        derivative = sp.diff(given.xreplace(real), real[name]).xreplace(plain)
        slope = _at(derivative, port, signals, point)
        if slope != 0:
            result[name] = slope
    return result


def _as_expression(
    law: Law, port: Hashable, received: sp.Symbol, signals: set[sp.Symbol],
    point: Mapping[sp.Symbol, sp.Expr],
) -> sp.Expr:  # fmt: skip
    """A law as an expression; slipping friction on the side on which the operating point lies."""
    if not isinstance(law, DryFriction):
        return law.expression
    if SLIP not in law.curve.free_symbols and not law.level.free_symbols & signals:
        return law.level
    side = sp.sign(point.get(received, sp.Integer(0)))
    if side not in (1, -1):
        raise SignalError(
            f"dry friction at {port!r} slips one way or the other, or sticks: give the sign of "
            f"{received} in at, or name {port!r} in stuck"
        )
    return side * law.level * law.curve.subs(SLIP, side * received)


def _at(
    slope: sp.Expr, port: Hashable, signals: set[sp.Symbol], point: Mapping[sp.Symbol, sp.Expr]
) -> sp.Expr:
    missing = sorted((slope.free_symbols & (signals | {TIME})) - point.keys(), key=str)
    if missing:
        raise SignalError(
            f"the slope of the law at {port!r} depends on {', '.join(map(str, missing))}; "
            "give it a value in at"
        )
    for jump in slope.atoms(sp.Heaviside, sp.DiracDelta, sp.sign):
        if jump.args[0].subs(point).is_zero:
            raise SignalError(
                f"the law at {port!r} has a corner at the operating point, where {jump.args[0]} = 0; "
                "linearise on one side of it"
            )
    value = slope.subs(point).doit()
    if value.has(sp.nan, sp.zoo, sp.oo):
        raise SignalError(f"the law at {port!r} has no finite slope at the operating point")
    return value
