"""How large the terms are that make up friction levels: where they cancel, rounding remains."""

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from codegen.standalone.arrays import Array
from codegen.standalone.evaluation import Laws
from codegen.standalone.instant import Formula, Instant
from codegen.tuning import TUNING


def without_rounding(values: Array, terms: Array) -> Array:
    """Values, those zero that are below it by no more than the rounding of their terms."""
    return np.where((values < 0) & (values >= -TUNING.rounding * terms), 0.0, values)


def level_terms(now: Instant, laws: Sequence[Laws], values: Formula) -> Array:
    """For each friction value the sum of the magnitudes of its terms, all but friction known.

    What a law gives, or a reading shows, is as large as its own terms: ``mu (F_0 - F_0 n)`` is zero
    at n = 1, but only to the rounding of ``mu F_0``. ``laws``: all others, in their order.
    """
    pool, numbers = values.pool(now), now.numbers
    sizes, ends = np.abs(pool), np.cumsum([1, len(now.x), len(now.z), len(now.y), len(now.u)])
    if now.seen is not None:
        sizes[1 : ends[2]] = np.maximum(sizes[1 : ends[2]], now.seen[: ends[2] - 1])
    x, y, u = slice(1, ends[1]), slice(ends[2], ends[3]), slice(ends[3], ends[4])

    def show() -> None:
        sizes[y] = np.abs(numbers.F) @ sizes[x] + np.abs(numbers.D) @ sizes[u]
        sizes[y] += np.abs(numbers.G) @ np.abs(now.du)

    def found(formula: Formula) -> Array:
        return terms_of(lambda at: formula.of_pool(at, now), pool, sizes, formula.read(pool))

    for some in laws:
        show()
        sizes[ends[3] + some.inputs] = found(some.formula)
    show()
    return found(values)


def terms_of(
    function: Callable[[Array], Array], at: Array, sizes: Array, places: Iterable[int]
) -> Array:
    """The sums of the magnitudes of a function's terms in these components; ``sizes``: of all.

    A term is the effect of a small relative change, divided by it; none where there is no value.
    """
    values = function(at)
    terms: Array = np.abs(values)
    for j in places:
        if sizes[j] == 0:
            continue
        moved = at.copy()
        moved[j] += np.copysign(TUNING.term * sizes[j], at[j])
        try:
            change = np.abs(function(moved) - values) / TUNING.term
        except (ArithmeticError, ValueError):
            continue
        terms += np.where(np.isfinite(change), change, 0.0)
    return terms
