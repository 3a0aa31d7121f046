"""Expressions as functions over numpy; what looks into tables is called by its name."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

import numpy as np
import sympy as sp

from bondgraph.algebra.called import Called
from codegen.numbers.arrays import Array


def lambdified(
    names: Sequence[Any], expr: Any, cse: Any = False, beside: Iterable[sp.Expr] = ()
) -> Callable[..., Any]:
    """A function of these names, numbers or arrays, as sympy makes it.

    ``expr``: an expression, or lists and tuples of such; ``beside``: those that ``cse`` puts in.
    """
    found = {part.code: elementwise(part.numeric) for part in _tabled([expr, *beside])}
    return sp.lambdify(names, expr, modules=[found, "numpy"] if found else "numpy", cse=cse)  # type: ignore[no-any-return]


def elementwise(function: Callable[..., float]) -> Callable[..., float | Array]:
    """A function of numbers for arrays, too, one number after the other."""

    def at(*places: float | Array) -> float | Array:
        if not any(isinstance(place, np.ndarray) for place in places):
            return function(*map(float, places))
        rows = np.broadcast_arrays(*places)
        values = map(function, *(row.ravel().tolist() for row in rows))
        return np.fromiter(values, float, rows[0].size).reshape(rows[0].shape)

    return at


def _tabled(expr: Any) -> Iterator[Called]:
    if isinstance(expr, sp.Basic):
        yield from expr.atoms(Called)
    elif isinstance(expr, Iterable):
        for part in expr:
            yield from _tabled(part)
