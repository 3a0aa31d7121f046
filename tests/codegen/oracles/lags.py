"""First-order lags by adaptive integration, piece by piece between given breakpoints."""

from collections.abc import Callable, Sequence

import numpy as np
from scipy.integrate import solve_ivp


def lagged(
    driven: Callable[[float], float],
    breaks: Sequence[float],
    time_constants: Sequence[float],
    start: Sequence[float],
    times: Sequence[float],
) -> np.ndarray:
    """The last of a chain of lags ``T_i y_i' + y_i = y_(i-1)`` that follows ``driven``, at ``times``.

    Integrated from ``times[0]``, where the chain is at ``start``. ``driven`` must be smooth between
    breaks and continuous from the right: just before a break it is read one spacing earlier.
    """
    gains = 1 / np.array(time_constants)
    y, t, result = np.array(start, dtype=float), float(times[0]), []
    edges = [b for b in breaks if times[0] < b < times[-1]] + [float(times[-1])]
    for edge in edges:
        last = np.nextafter(edge, -np.inf)

        def rate(at: float, y: np.ndarray, last: float = last) -> np.ndarray:
            return gains * (np.array([driven(min(at, last)), *y[:-1]]) - y)

        found = solve_ivp(
            rate, (t, edge), y, method="DOP853", rtol=1e-13, atol=1e-14, dense_output=True
        )
        result += [float(found.sol(at)[-1]) for at in times if t <= at < edge]
        t, y = edge, found.y[:, -1]
    return np.array([*result, y[-1]])
