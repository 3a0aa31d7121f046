"""Integration of ``A v' = J v + g(t)`` with sparse A and J that are never inverted or filled in."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import scipy

from bondgraph.errors import SimulationError
from codegen.numbers.arrays import Array

STIFF = 2e3
"""Length of a stretch over the shortest time constant from which the implicit method is chosen."""


LEAST_STEPS = 100
"""Steps are never longer than a stretch divided by this."""

FOLLOWED = 0.05
"""A step's length in shortest time constants of the inputs."""


def mass_radau(
    rate: Callable[[float, Array], Array], t: float, v: Array, stop: float, rtol: float, atol: float,
    longest: float, mass: scipy.sparse.csc_array, jac: scipy.sparse.csc_array,
) -> scipy.integrate.OdeSolver:  # fmt: skip
    """scipy's Radau for ``A v' = J v + g``, of which ``rate`` is v'.

    Its systems ``(mu/h - A^-1 J) d = r`` are solved as ``(mu/h A - J) d = A r``, so that only A and J
    have to be sparse. ``longest``: its error estimate is blind to what follows an input at once, so a step
    must not be long beside the inputs' own changes.
    """
    solver: Any = scipy.integrate.Radau(
        rate, t, v, stop, rtol=rtol, atol=atol, jac=jac, max_step=longest
    )
    solver.I = mass
    solver.solve_lu = lambda factors, right: factors.solve(mass @ right)
    made: scipy.integrate.OdeSolver = solver
    return made


class SparseSystem:
    """``A v' = J v + g(t)``, A factored once."""

    def __init__(self, A: scipy.sparse.csr_array, J: scipy.sparse.csr_array) -> None:
        from scipy.sparse.linalg import splu

        self.A, self.J = scipy.sparse.csc_array(A), scipy.sparse.csc_array(J)
        self._factors = splu(self.A) if A.shape[0] else None

    def solve(self, right: Array) -> Array:
        """``A^-1 right``, one column or several."""
        return right if self._factors is None else np.asarray(self._factors.solve(right))

    @property
    def fastest(self) -> float:
        """A bound on the largest rate [1/s], exact to a small factor where A is nearly diagonal."""
        from scipy.sparse.linalg import norm

        scale = scipy.sparse.diags_array(1 / np.sqrt(self.A.diagonal()))
        return float(norm(scale @ self.J @ scale, np.inf)) if self.J.nnz else 0.0

    def stepper(
        self, forced: Callable[[float], Array], t: float, v: Array, stop: float, method: str,
        rtol: float, atol: float, driven: float,
    ) -> scipy.integrate.OdeSolver:  # fmt: skip
        """An integrator from t to ``stop``; ``forced``: g over time, ``driven`` [1/s]: its largest rate."""

        def rate(time: float, values: Array) -> Array:
            return self.solve(self.J @ values + forced(time))

        implicit = method == "Radau"
        if method == "auto":
            implicit = self.fastest * (stop - t) > STIFF
        longest = min((stop - t) / LEAST_STEPS, FOLLOWED / driven if driven else np.inf)
        if not implicit:
            return scipy.integrate.DOP853(rate, t, v, stop, rtol=rtol, atol=atol, max_step=longest)
        return mass_radau(rate, t, v, stop, rtol, atol, longest, self.A, self.J)


def integrate(
    solver: scipy.integrate.OdeSolver, times: Array, until: float, record: Callable[[Array], None]
) -> Array:
    """Step to the end, recording at those of ``times`` that lie before ``until``; the last vector."""
    done = 0
    while solver.status == "running":
        message = solver.step()
        if message is not None:
            raise SimulationError(f"at t = {solver.t:.9g} the integrator failed: {message}")
        dense = solver.dense_output()
        while done < len(times) and times[done] < until and times[done] <= solver.t:
            record(np.asarray(dense(float(times[done]))))
            done += 1
    return np.asarray(solver.y)
