"""Expressions as residues modulo a large prime: exact structure decisions at the price of integers.

Every symbol stands for a random residue, the same in all places. A residue that is not zero proves
that the expression is not zero; a zero is wrong with a probability of about degree/2**61.

The prime is 1 modulo 8 and modulo every odd prime below 32. So the residues hold i = sqrt(-1) and the
roots of small integers, and functions keep their identities: with ``u = exp(i x)`` a random residue,
``cos x = (u + 1/u)/2`` and ``sin x = (u - 1/u)/(2 i)``, whatever multiples of x and sums of angles occur.
"""

import random
from collections.abc import Callable, Iterator, Sequence
from functools import cached_property, lru_cache
from typing import Any

import sympy as sp
from sympy.ntheory import factorint, sqrt_mod

from bondgraph.algebra.called import unguarded

PRIME = 2874246 * 802241960520 + 1
"""The largest prime below 2**61 of the form ``8 * 3 * 5 * ... * 29 * 31 * k + 1``."""

PARTS = 2**4 * 3**2 * 5 * 7
"""Angles and exponents are counted in this fraction of a symbol, so that x/2 and x/3 agree with x."""

DIGITS = 30
"""In so many digits an expression is looked at whose zero residues do not decide."""

KNOWN_FUNCTIONS = (sp.sin, sp.cos, sp.tan, sp.sinh, sp.cosh, sp.tanh, sp.exp)


def residues(seed: int = 0) -> Callable[[sp.Expr], int]:
    """A function from expressions to residues; equal seeds give equal functions.

    Sums, products, powers with integer or half exponents and the functions in `KNOWN_FUNCTIONS` keep
    their identities, roots as far as the prime has them: of integers whose prime factors are below 32,
    and of products of symbols. Any other root or function counts as a symbol of its own. Raises
    `ZeroDivisionError` where a denominator vanishes.

    >>> value = residues()
    >>> h = sp.Symbol("h")
    >>> value(h/(h - 1) - 1/(h - 1)), value(h - 2) == 0, value(sp.sin(h)**2 + sp.cos(h)**2)
    (1, False, 1)
    """
    return _Residues(seed)


class _Residues:
    def __init__(self, seed: int) -> None:
        self._seed = seed
        self._known: dict[sp.Expr, int] = {}

    @cached_property
    def _imaginary(self) -> int:
        """A root of -1."""
        return int(sqrt_mod(PRIME - 1, PRIME))

    def __call__(self, expr: sp.Expr) -> int:
        if expr.is_Rational:
            return int(expr.p) * _inverse(int(expr.q)) % PRIME
        if expr.is_Add:
            return sum(map(self, expr.args)) % PRIME
        if expr.is_Mul:
            return prod_mod(map(self, expr.args))
        if expr.is_Pow and expr.exp.is_Integer:
            return _power(self(expr.base), int(expr.exp))
        if expr not in self._known:
            self._known[expr] = self._new(expr)
        return self._known[expr]

    def _new(self, expr: sp.Expr) -> int:
        """The residue of a symbol, a root or a function."""
        if expr.is_Symbol:
            # A square, so that the symbol has a root.
            return pow(self._random(expr), 2, PRIME)
        if expr.is_Pow and expr.exp.is_Rational and expr.exp.q == 2:
            return _power(self._root(expr.base), int(expr.exp.p))
        if isinstance(expr, KNOWN_FUNCTIONS):
            return self._function(expr)
        return self._random(expr)

    def _random(self, expr: sp.Expr, kind: str = "") -> int:
        return random.Random(f"{self._seed} {kind} {sp.srepr(expr)}").randrange(1, PRIME)

    def _root(self, base: sp.Expr) -> int:
        """A square root, the root of a product being the product of roots."""
        if base.is_Symbol:
            return self._random(base)
        if base.is_Mul:
            return prod_mod(map(self._root, base.args))
        if base.is_Pow and base.exp.is_Integer:
            return _power(self._root(base.base), int(base.exp))
        if base.is_Rational and not base.is_Integer:
            return self._root(sp.Integer(base.p)) * _inverse(self._root(sp.Integer(base.q))) % PRIME
        if base.is_Integer and base.p > 0:
            powers = factorint(base.p).items()
            return prod_mod(_power(_smaller_root(q) or self._random(base), n) for q, n in powers)
        return _smaller_root(self(base)) or self._random(base, "root")

    def _function(self, expr: sp.Expr) -> int:
        (argument,) = expr.args
        hyperbolic = isinstance(expr, sp.exp | sp.sinh | sp.cosh | sp.tanh)
        u = self._exponential(argument, "" if hyperbolic else "i")
        if isinstance(expr, sp.exp):
            return u
        v, half = _inverse(u), _inverse(2)
        even, odd = (u + v) * half % PRIME, (u - v) * half % PRIME
        if not hyperbolic:
            odd = odd * _inverse(self._imaginary) % PRIME
        if isinstance(expr, sp.sin | sp.sinh):
            return odd
        if isinstance(expr, sp.cos | sp.cosh):
            return even
        return odd * _inverse(even) % PRIME

    def _exponential(self, argument: sp.Expr, kind: str) -> int:
        """``exp(argument)``, or ``exp(i argument)``: the product over the terms of the argument."""
        result = 1
        for term, factor in sp.expand(argument).as_coefficients_dict().items():
            parts = factor * PARTS
            base = self._random(term if parts.is_Integer else term * factor, f"exp{kind}")
            result = result * _power(base, int(parts) if parts.is_Integer else 1) % PRIME
        return result


def prod_mod(values: Iterator[int]) -> int:
    """The product of residues."""
    result = 1
    for value in values:
        result = result * value % PRIME
    return result


def _power(base: int, exponent: int) -> int:
    return pow(_inverse(base) if exponent < 0 else base, abs(exponent), PRIME)


def _inverse(residue: int) -> int:
    if residue % PRIME == 0:
        raise ZeroDivisionError("a denominator vanishes")
    return pow(residue, -1, PRIME)


def _smaller_root(residue: int) -> int | None:
    """The smaller of the two square roots, if there are any."""
    root = sqrt_mod(residue % PRIME, PRIME)
    return None if root is None else int(root)


def is_zero(expr: sp.Expr) -> bool:
    """Whether an expression vanishes identically, without expanding it unless it seems to.

    >>> a, b = sp.symbols("a b")
    >>> is_zero((a + b)**2 - a**2 - 2*a*b - b**2), is_zero(sp.sin(a)**2 + sp.cos(a)**2 - 1)
    (True, True)
    """
    if expr.is_Rational:
        return bool(expr.p == 0)
    if expr.is_Symbol:
        return False
    if not decided_by_residues(expr):
        return _vanishes(expr)
    try:
        return residues()(expr) == 0 and residues(1)(expr) == 0
    except ZeroDivisionError:
        return False


@lru_cache(maxsize=1_024)
def _vanishes(expr: sp.Expr) -> bool:
    """What sympy says, which takes long; graphs that are derived again ask for the same.

    Where a guard has no value, what it stands in has none, zero or not.
    """
    expr = unguarded(expr)
    try:
        return not _differs(expr) and bool(expr.equals(0))
    except TypeError:
        # Sympy puts numbers in, and compares what a table refuses.
        return False


def _differs(expr: sp.Expr) -> bool:
    """Whether an expression has a value that is plainly not zero at some numbers: then it is not zero."""
    found = at_some_numbers([expr])
    return found is not None and is_plainly_some(found[0])


def at_some_numbers(exprs: Sequence[sp.Expr]) -> list[sp.Float] | None:
    """Values of expressions at the same numbers, all digits right; None where one has no real value there.

    >>> a = sp.Symbol("a")
    >>> one, other = at_some_numbers([sp.sqrt(a), sp.sqrt(a) - 1])
    >>> is_plainly_some(one - other - 1)
    False
    """
    names = sorted({name for expr in exprs for name in expr.free_symbols}, key=str)
    rng = random.Random(len(names))
    point = {name: sp.Rational(rng.randrange(1, 1_000), 1_009) for name in names}
    try:
        # As many digits as told are right; what cancels comes out far smaller.
        values = [sp.Float(expr.xreplace(point).evalf(DIGITS), DIGITS) for expr in exprs]
    except (ArithmeticError, TypeError, ValueError):
        return None
    return values if all(value.is_finite for value in values) else None


def is_plainly_some(value: Any) -> bool:
    """Whether a number in so many digits is more than what is left where all cancels."""
    return bool(abs(value) > sp.Rational(1, 10 ** (DIGITS // 2)))


def is_rational_function(expr: sp.Expr) -> bool:
    """Whether only numbers, symbols, sums, products and integer powers occur."""
    if expr.is_Rational or expr.is_Symbol:
        return True
    if expr.is_Pow:
        return bool(expr.exp.is_Integer) and is_rational_function(expr.base)
    return bool(expr.is_Add or expr.is_Mul) and all(map(is_rational_function, expr.args))


def decided_by_residues(expr: sp.Expr) -> bool:
    """Whether residues know every identity that could hold: no roots, no functions but the known ones."""
    if expr.is_Rational or expr.is_Symbol:
        return True
    if expr.is_Pow:
        return bool(expr.exp.is_Integer) and decided_by_residues(expr.base)
    if isinstance(expr, KNOWN_FUNCTIONS):
        return decided_by_residues(expr.args[0])
    return bool(expr.is_Add or expr.is_Mul) and all(map(decided_by_residues, expr.args))
