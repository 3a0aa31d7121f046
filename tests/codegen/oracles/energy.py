"""Energy balance of a run by Gauss quadrature between its events."""

from collections.abc import Callable, Iterable
from itertools import pairwise

import numpy as np

from codegen import Result

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(12)


def gauss_times(edges: Iterable[float], panels: int = 8) -> np.ndarray:
    """The edges of every panel and the Gauss points inside, increasing: 13 for each panel, and the end."""
    stretches = np.unique(np.asarray(list(edges)))
    ends = [np.linspace(a, b, panels + 1)[:-1] for a, b in pairwise(stretches)]
    starts = np.concatenate(ends)
    widths = np.diff([*starts, stretches[-1]])
    inner = starts[:, None] + widths[:, None] * (POINTS + 1) / 2
    return np.array([*np.column_stack([starts, inner]).ravel(), stretches[-1]])


def misfit(
    run: Callable[[np.ndarray], Result],
    breaks: Iterable[float],
    energy: Callable[[Result], np.ndarray],
    power: Callable[[Result], np.ndarray],
) -> float:
    """How far the stored energy departs from the integral of the power supplied less dissipated.

    ``run`` samples at given times; its first call, on the breaks alone, tells where events are. The
    largest departure at any panel's end, over the largest power times the time passed.
    """
    breaks = sorted(breaks)
    events = {event.time for event in run(np.array(breaks)).events}
    edges = np.array(sorted({*breaks, *events}))
    far = edges[np.diff(edges, prepend=-np.inf) > 1e-9]
    times = gauss_times(far)
    result = run(times)
    stored, flow = energy(result), power(result)
    widths = np.diff(times[::13])
    work = flow[:-1].reshape(-1, 13)[:, 1:] @ WEIGHTS * widths / 2
    departure = stored[::13] - stored[0] - np.concatenate([[0.0], np.cumsum(work)])
    return float(np.abs(departure).max() / (np.abs(flow).max() * (times[-1] - times[0])))
