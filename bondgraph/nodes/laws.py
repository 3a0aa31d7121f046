"""What closes an open port: an expression, or dry friction that sticks and slips."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeGuard

import sympy as sp

from bondgraph.algebra.expressions import expression
from bondgraph.errors import ExpressionError, StructureError
from bondgraph.tables.record import Sampled

SLIP = sp.Symbol("slip")
"""The argument of a friction curve: the magnitude of the slip."""


@dataclass(frozen=True)
class ExpressionLaw:
    """The port gives the value of an expression.

    The expression may use the port's received variable, states, other signals, parameters and the
    time ``t``. A law with a ``state`` owns it: the state's rate is what the port receives (the twist
    of a nonlinear spring, the momentum of a nonlinear inertia).
    """

    expression: sp.Expr
    state: sp.Symbol | None = None

    @property
    def free_symbols(self) -> frozenset[sp.Symbol]:
        """Every name the law uses, its own state included."""
        own = {self.state} if self.state is not None else set()
        return frozenset(self.expression.free_symbols | own)


@dataclass(frozen=True, init=False)
class DryFriction:
    """Friction that holds a port at zero slip until a breakaway effort, and opposes the slip beyond.

    Slipping, the port gives ``level * curve(|y|) * sign(y)``, with ``y`` what it receives; sticking,
    ``y = 0`` and it gives whatever holds it, as long as that stays within ``breakaway * level``
    (Deur, Hancock, Assadian 2008, eq. (17) and Fig. 8; Karnopp 1985). A port that gives its flow, as on a
    spring, sticks while ``|y| <= level`` and slips at that level; it has no curve and no breakaway.

    ``level``: N m (or N, V, Pa), text, number or expression, not negative. ``curve``: an expression
    in ``slip``, normalised to 1 for plain Coulomb friction. ``breakaway``: the ratio at standstill, by
    default the curve's value at ``slip = 0``; it must not be less than that value. ``tables``: what these
    texts may call.

    Raises `ExpressionError` for a negative level, and for a curve that is not finite or drives at standstill.

    >>> DryFriction("tau_h", "1 + 0.2*exp(-slip/0.1)").breakaway
    6/5
    """

    level: sp.Expr
    curve: sp.Expr
    breakaway: sp.Expr

    def __init__(
        self,
        level: object,
        curve: object = 1,
        breakaway: object = None,
        tables: Iterable[Sampled] = (),
    ) -> None:
        tables = tuple(tables)
        object.__setattr__(self, "level", expression(level, "level of dry friction", tables))
        object.__setattr__(self, "curve", expression(curve, "curve of dry friction", tables))
        at_rest = self.curve.subs(SLIP, 0)
        if at_rest.has(sp.nan, sp.zoo, sp.oo):
            raise ExpressionError(f"curve of dry friction: {self.curve} is not finite at slip = 0")
        what = "breakaway of dry friction"
        ratio = at_rest if breakaway is None else expression(breakaway, what, tables)
        if (ratio - at_rest).is_negative:
            raise ExpressionError(
                f"dry friction: breakaway {ratio} is below the curve at standstill, {at_rest}; "
                "a port held there could neither stick nor slip"
            )
        if at_rest.is_negative:
            raise ExpressionError(
                f"curve of dry friction: {at_rest} at slip = 0 would drive the slip"
            )
        if self.level.is_negative:
            raise ExpressionError(
                f"level of dry friction: {self.level} is negative; it is a magnitude"
            )
        for part, what in ((self.level, "level"), (ratio, "breakaway")):
            if SLIP in part.free_symbols:
                raise ExpressionError(f"{what} of dry friction: only the curve may use slip")
        object.__setattr__(self, "breakaway", ratio)

    @property
    def free_symbols(self) -> frozenset[sp.Symbol]:
        """Every name the law uses, without the slip."""
        used = self.level.free_symbols | self.curve.free_symbols | self.breakaway.free_symbols
        return frozenset(used - {SLIP})


Law = ExpressionLaw | DryFriction


def slides(law: Law | None, gives: str) -> TypeGuard[DryFriction]:
    """Whether a law is dry friction, and its port gives its flow."""
    return isinstance(law, DryFriction) and gives == "flow"


def check_slider(friction: DryFriction, where: str) -> None:
    """Refuse a curve that changes, and a breakaway above it, where friction gives its flow.

    What it is directly on rules its effort, and slips at once by whatever that lets go: only an inertia
    between makes a fall of the level, or a rise with the slip, a matter of time.
    """
    if SLIP in friction.curve.free_symbols or not (friction.breakaway - friction.curve).is_zero:
        raise StructureError(
            f"{where}: dry friction that gives a flow (directly on a spring, or two in series) has one "
            "level: a curve in slip or a breakaway above it needs an inertia between; of a rising curve put "
            "the rise into a resistance beside it"
        )


def law(
    value: object, where: str, state: sp.Symbol | None = None, tables: Iterable[Sampled] = ()
) -> Law:
    """The law that a text, number, expression or ready law stands for."""
    if isinstance(value, ExpressionLaw | DryFriction):
        if state is not None and not (isinstance(value, ExpressionLaw) and value.state == state):
            raise ExpressionError(f"{where}: a storage takes an expression in {state} as its law")
        return value
    return ExpressionLaw(expression(value, where, tables), state)
