"""SUNDIALS' CVODE, by way of the package scikit-sundae, where a stretch takes one of scipy's integrators."""

from collections.abc import Callable
from typing import Any

import numpy as np

from bondgraph.errors import MissingExtraError
from codegen.numbers.arrays import Array
from codegen.tuning import TUNING


class Cvode:
    """CVODE, one of its own steps at a time, with what a stretch uses of scipy's `OdeSolver`.

    ``formulas``: "Adams" (orders 1 to 12), or "BDF" (backward differences, orders 1 to 5) for stiff rates.
    ``status``: "running", "finished" at ``t_bound``, or "failed". Steps are never longer than
    ``max_step`` and never end beyond ``t_bound``; ``first_step``: 0 where CVODE is to find it.

    Raises `MissingExtraError` without scikit-sundae.
    """

    def __init__(
        self, formulas: str, rates: Callable[[float, Array], Array], t0: float, y0: Array,
        t_bound: float, *, rtol: float, atol: float, max_step: float, first_step: float = 0.0,
    ) -> None:  # fmt: skip
        def fill(t: float, y: Array, out: Array) -> None:
            out[:] = rates(t, y)

        def begun(t: float, y: Array, longest: float, first: float = 0.0) -> Any:
            solver = _solver_class()(
                fill,
                method=formulas,
                rtol=TUNING.tighter * rtol,
                atol=TUNING.tighter * atol,
                max_step=longest,
                first_step=first,
            )
            solver.init_step(t, y)
            return solver

        self._begun, self._solver = begun, begun(t0, y0, max_step, min(first_step, max_step))
        self._longest = max_step
        self.status, self._bound, self.max_step = "running", t_bound, max_step
        self.t_old, self.t, self.y = t0, t0, y0

    def step(self) -> str | None:
        """Take one step; what went wrong, if anything did. A longest step that has doubled begins anew."""
        if self.max_step >= 2 * self._longest:
            self._longest = self.max_step
            self._solver = self._begun(self.t, self.y, self._longest)
        found = self._solver.step(self._bound, "onestep", self._bound)
        if found.status >= 0 and found.t == self.t:
            # Once asked for an instant inside a step, CVODE first returns to the step's end.
            found = self._solver.step(self._bound, "onestep", self._bound)
        if found.status < 0:
            self.status = "failed"
            return str(found.message)
        self.t_old, self.t, self.y = self.t, float(found.t), found.y
        if self.t >= self._bound:
            self.status = "finished"
        return None

    def dense_output(self) -> Callable[[float | Array], Array]:
        """The last step's own polynomial, until the next is taken; for several times its columns."""

        def dense(t: float | Array) -> Array:
            if isinstance(t, np.ndarray):
                return np.column_stack([self._inside(one) for one in t.tolist()])
            return self._inside(t)

        return dense

    def _inside(self, t: float) -> Array:
        """Asked for an instant that it has passed, CVODE takes no step but interpolates to its order."""
        return np.asarray(self._solver.step(t, "normal", None).y)


def _solver_class() -> Any:
    try:
        from sksundae.cvode import CVODE
    except ImportError:
        raise MissingExtraError(
            "method 'CVODE' needs scikit-sundae; install the optional extra: "
            "pip install bondgraph-toolkit[sundae]"
        ) from None
    return CVODE
