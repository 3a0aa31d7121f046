"""Whether a law rises, or falls, all the way: told by signs, parameters taken as positive."""

from dataclasses import dataclass

import sympy as sp

from bondgraph.algebra.whole import Floor

NEVER_NEGATIVE = (sp.exp, sp.cosh)
ODD = (sp.sinh, sp.tanh, sp.atan, sp.asinh)
"""Functions that have the sign of their argument."""

CORNERED = (sp.sign, sp.Heaviside, sp.Max, sp.Min, sp.Piecewise, sp.Derivative)


@dataclass(frozen=True)
class Rising:
    """A law of one name that goes one way all over its domain: its slope, and what that holds for.

    ``positive``: parameters that have to be positive; ``domain``: expressions of the name that are positive
    over the domain.
    """

    slope: sp.Expr
    positive: tuple[sp.Symbol, ...]
    domain: tuple[sp.Expr, ...]


def rising(law: sp.Expr, name: sp.Symbol, onward: bool = False) -> Rising | None:
    """What shows that a law rises or falls all the way; None where signs do not show it, or it has corners.

    The domain lies about zero: a logarithm's argument, the base of a broken power and a denominator keep
    the sign they have there, and what stands in a tangent is less than a right angle. Each has to rise or
    fall itself, so that the domain is in one piece. ``onward``: only from zero on, where the name is no
    less than that.

    >>> q, k, c = sp.symbols("q k c")
    >>> rising(k*q + c*q**3, q)
    Rising(slope=3*c*q**2 + k, positive=(c, k), domain=())
    >>> rising(k*q - c*q**3, q), rising(q**3, q)
    (None, None)
    >>> f = sp.Symbol("f")
    >>> rising(q/(1 + f**2), q).positive, rising(f**2*q, q).positive
    ((), (f,))
    >>> rising(k*q + c/(2 - q), q)
    Rising(slope=c/(2 - q)**2 + k, positive=(c, k), domain=(2 - q,))
    """
    found = sloped(law, name, onward)
    return found[0] if found is not None and abs(found[1]) == 2 else None


def sloped(law: sp.Expr, name: sp.Symbol, onward: bool = False) -> tuple[Rising, int] | None:
    """The same with the sign of the slope, 1 or -1 where it may be zero, 0 where it is; None if not told.

    Squares are taken as no less than zero, whatever sign their names have; where that does not tell it, as
    those of positive names.
    """
    found = _sloped(law, name, onward, squared=False)
    if found is not None and abs(found[1]) == 2:
        return found
    return _sloped(law, name, onward, squared=True) or found


def _sloped(
    law: sp.Expr, name: sp.Symbol, onward: bool, squared: bool
) -> tuple[Rising, int] | None:
    real = {one: sp.Dummy(one.name, real=True) for one in law.free_symbols}
    plain = {dummy: one for one, dummy in real.items()}
    x = real.get(name, sp.Dummy(real=True))
    shown = law.xreplace(real)
    slope = _of_abs(sp.diff(shown, x))
    signs = _Signs(x, _domain(shown, x), onward, squared)
    cornered = slope.has(*CORNERED) or law.has(Floor, sp.atan2)
    if cornered or signs.facts is None or not {*_before_poles(shown)} <= {*signs.facts}:
        return None
    sign = signs.of(_of_tanh(slope))
    if sign is None:
        return None
    needed = sorted((plain[one] for one in signs.needed), key=str)
    domain = tuple(one.xreplace(plain) for one in signs.facts)
    return Rising(slope.xreplace(plain), tuple(needed), domain), sign


def sign_of(
    expr: sp.Expr, name: sp.Symbol | None = None
) -> tuple[int | None, frozenset[sp.Symbol]]:
    """The sign of an expression, as `_Signs` has it, and which names have to be positive for that.

    Of ``name`` nothing is known; names that are known not to be negative may be zero.
    """
    signs = _Signs(name or sp.Dummy(), [])
    found = signs.of(expr)
    return found, frozenset(signs.needed)


def _of_abs(slope: sp.Expr) -> sp.Expr:
    """With ``|u|`` for ``u sign(u)``."""

    def turned(product: sp.Expr) -> sp.Expr:
        for part in product.args:
            if isinstance(part, sp.sign) and part.args[0] in product.args:
                (u,) = part.args
                rest = [one for one in product.args if one not in (part, u)]
                return sp.Mul(sp.Abs(u), *rest)
        return product

    return slope.replace(lambda part: part.is_Mul and part.has(sp.sign), turned)


def _of_tanh(slope: sp.Expr) -> sp.Expr:
    """With ``1/cosh(u)**2`` for ``1 - tanh(u)**2``."""
    squares = [part for part in slope.atoms(sp.Pow) if isinstance(part.base, sp.tanh)]
    put = {part: 1 - sp.cosh(part.base.args[0]) ** -2 for part in squares if part.exp == 2}
    return sp.expand_mul(slope.xreplace(put)) if put else slope


def _domain(law: sp.Expr, x: sp.Symbol) -> list[sp.Expr]:
    """What stands in logarithms, broken powers and denominators, and before the poles of tangents."""
    inside = [part.args[0] for part in law.atoms(sp.log)]
    inside += [part.base for part in law.atoms(sp.Pow) if not part.exp.is_nonnegative
               or not part.exp.is_Integer]  # fmt: skip
    inside += _before_poles(law)
    return sorted({one for one in inside if one.has(x)}, key=sp.default_sort_key)


def _before_poles(law: sp.Expr) -> list[sp.Expr]:
    """How far what stands in tangents is from a right angle, of either sign."""
    return [sp.pi / 2 + way * part.args[0] for part in law.atoms(sp.tan) for way in (1, -1)]


class _Signs:
    """Signs of expressions: 2 and -2 never zero, 1 and -1 perhaps, 0 always; None not told.

    ``squared``: whether names under even powers, too, are taken as positive, so that these are never zero.
    """

    def __init__(
        self, x: sp.Symbol, inside: list[sp.Expr], onward: bool = False, squared: bool = True
    ) -> None:
        self._x, self._onward, self._squared, self.needed = x, onward, squared, set[sp.Symbol]()
        self.facts: tuple[sp.Expr, ...] | None = ()
        found = []
        for one in inside:
            sign = self.of(one) or self.of(one.xreplace({x: sp.Integer(0)})) or 0
            if abs(sign) < 2 or self.of(sp.diff(one, x)) is None:
                self.facts = None
                return
            found.append(one if sign > 0 else -one)
            self.facts = tuple(found)

    def of(self, expr: sp.Expr) -> int | None:
        for fact in self.facts or ():
            if expr in (fact, -fact):
                return 2 if expr == fact else -2
        if expr.is_number:
            return None if expr.is_zero is None else 0 if expr.is_zero else 2 * _sign(expr)
        if expr.is_Symbol:
            if expr == self._x:
                return 1 if self._onward else None
            if expr.is_nonnegative:
                return 1
            self.needed.add(expr)
            return 2
        if expr.is_Add:
            return _sum([self.of(part) for part in expr.args])
        if expr.is_Mul:
            return _product([self.of(part) for part in expr.args])
        if expr.is_Pow:
            return self._power(expr.base, expr.exp)
        return self._function(expr)

    def _power(self, base: sp.Expr, exponent: sp.Expr) -> int | None:
        if exponent.is_even and not self._squared and not base.is_number:
            return 2 if exponent.is_negative else 1
        below = self.of(base)
        if exponent.is_even:
            return 2 if exponent.is_negative or abs(below or 0) == 2 else 1
        if exponent.is_odd:
            return below
        if below is None or below < 0:
            return None
        return below if below == 2 or (self.of(exponent) or 0) > 0 else None

    def _function(self, expr: sp.Expr) -> int | None:
        if isinstance(expr, NEVER_NEGATIVE):
            return 2
        inside = self.of(expr.args[0]) if len(expr.args) == 1 else None
        if isinstance(expr, sp.Abs):
            return abs(inside) if inside is not None else 1
        return inside if isinstance(expr, ODD) else None


def _sign(number: sp.Expr) -> int:
    return 1 if number.is_positive else -1


def _sum(signs: list[int | None]) -> int | None:
    """Of terms none of which is against the others."""
    known = [one for one in signs if one is not None]
    if len(known) < len(signs) or (min(known) < 0 < max(known)):
        return None
    return max(known, key=abs)


def _product(signs: list[int | None]) -> int | None:
    if 0 in signs:
        return 0
    if None in signs:
        return None
    way = -1 if sum((one or 0) < 0 for one in signs) % 2 else 1
    return way * min(abs(one or 0) for one in signs)
