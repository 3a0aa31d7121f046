"""Models whose laws are affine: in each friction mode everything is one matrix times one vector."""

from collections.abc import Callable, Iterable, Sequence
from functools import cached_property

import numpy as np
import scipy
import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.errors import SimulationError
from codegen.numbers.arrays import Array, read_only
from codegen.program.layout import CAPS
from codegen.tuning import TUNING

LARGE = 64
"""Larger systems are not asked for all of their rates."""

ONE = read_only(np.ones(1))


def is_affine(expressions: Iterable[sp.Expr], parameters: set[str]) -> bool:
    """Whether every expression is a constant plus constants times signals, and free of time.

    Told by what it is made of, once it is multiplied out: a slope without signals is no proof, since that
    of a step is zero and that of ``log(exp(x))`` is one.

    >>> k, x, y = sp.symbols("k x y")
    >>> is_affine([k*x + y - 1], {"k"}), is_affine([x*y], set()), is_affine([abs(x)], set())
    (True, False, False)
    """
    for expr in expressions:
        signals = {name for name in expr.free_symbols if name.name not in parameters}
        degree = _degree(expr, signals)
        if degree is not None and degree > 1:
            plain = sp.expand(expr, power_base=False, power_exp=False, log=False)
            degree = _degree(plain, signals)
        if TIME in signals or degree is None or degree > 1:
            return False
    return True


def _degree(expr: sp.Expr, signals: set[sp.Symbol]) -> int | None:
    """The degree in the signals as the expression stands; None where it is no polynomial in them."""
    if expr in signals:
        return 1
    if not expr.free_symbols & signals:
        return 0
    degrees = [_degree(part, signals) for part in expr.args]
    if expr.is_Pow and expr.exp.is_Integer and expr.exp.is_positive and degrees[0] is not None:
        return degrees[0] * int(expr.exp)
    if not (expr.is_Add or expr.is_Mul) or None in degrees:
        return None
    known = [degree for degree in degrees if degree is not None]
    return max(known) if expr.is_Add else sum(known)


class AffineMap:
    """``v = T [s, w, dw, 1]``, cut into the parts of ``v``, of which ``rate`` is the rate of s.

    The matrix may be a stack of those of many runs.
    """

    def __init__(self, sizes: Sequence[int], matrix: Array, rate: int) -> None:
        self.sizes, self.matrix, self._rate = tuple(sizes), matrix, rate
        ends = np.cumsum(sizes).tolist()
        self.parts = [slice(end - size, end) for end, size in zip(ends, sizes, strict=True)]
        self._magnitudes: dict[int, Array] = {}

    def __call__(self, *vectors: Array) -> list[Array]:
        """The parts at one point."""
        values = self.matrix @ np.concatenate((*vectors, ONE))
        return [values[part] for part in self.parts]

    @cached_property
    def limited(self) -> bool:
        """Whether a port has a friction level, which may fall below zero."""
        return bool(self.rows(CAPS).any())

    @cached_property
    def spectrum(self) -> tuple[complex, ...]:
        """The rates [1/s] of s by itself."""
        rate = self.rows(self._rate)
        found: tuple[complex, ...] = tuple(np.linalg.eigvals(rate[:, : len(rate)]).tolist())
        return found

    @cached_property
    def fastest(self) -> float:
        """The largest rate [1/s] of s by itself; of a large system a bound on it."""
        rate = self.rows(self._rate)
        if len(rate) > LARGE:
            return balanced_norm(rate[:, : len(rate)])
        return max((abs(rate) for rate in self.spectrum), default=0.0)

    def terms(self, part: int, *vectors: Array) -> Array:
        """The sums of the magnitudes of the terms that make a part up."""
        found: Array = self.magnitudes(part) @ np.abs(np.concatenate((*vectors, ONE)))
        return found

    def magnitudes(self, part: int) -> Array:
        """The magnitudes of the rows of one part."""
        if part not in self._magnitudes:
            self._magnitudes[part] = np.abs(self.rows(part))
        return self._magnitudes[part]

    def rows(self, part: int) -> Array:
        """The rows of one part."""
        return self.matrix[..., self.parts[part], :]


def balanced_norm(M: Array) -> float:
    """A bound on |M|, and so on its rates, in a norm in which M is balanced."""
    balanced = scipy.linalg.matrix_balance(M, permute=False)[0]
    return float(min(np.linalg.norm(balanced, 1), np.linalg.norm(balanced, np.inf)))


def probed(point: Callable[[Array], list[Array]], length: int, rate: int) -> AffineMap:
    """The map of a function of so many numbers that is known to be affine."""
    parts = point(np.zeros(length))
    origin = np.concatenate(parts)
    # Far out the constant part of a law no longer swallows digits of its slope.
    columns = [
        (np.concatenate(point(TUNING.far * e)) - origin) / TUNING.far for e in np.eye(length)
    ]
    return AffineMap([len(part) for part in parts], np.column_stack([*columns, origin]), rate)


def check_finite(given: Array, matrix: Array, inputs: Sequence[sp.Symbol]) -> None:
    """Refuse a map that is not finite, naming the inputs of whose rows, ``given``, that is so."""
    if np.isfinite(matrix).all():
        return
    wrong = np.flatnonzero(~np.isfinite(given).all(axis=1)).tolist()
    names = ", ".join(str(inputs[at]) for at in wrong)
    raise SimulationError(
        f"what gives {names or 'the rates'} has no finite factors at these parameters"
    )
