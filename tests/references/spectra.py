"""Frequencies and dampings in sampled signals: the matrix pencil method of Hua and Sarkar (1990)."""

from __future__ import annotations

import numpy as np


def oscillations(
    values: np.ndarray, interval: float, order: int = 8
) -> list[tuple[float, float, float]]:
    """Frequency [Hz], amplitude at the first sample and decay [1/s] of each, largest first.

    The signal is a sum of ``order`` damped exponentials: the poles are the generalised eigenvalues of
    two Hankel matrices one sample apart.
    """
    half = len(values) // 2
    hankel = np.lib.stride_tricks.sliding_window_view(values, half)
    _, _, right = np.linalg.svd(hankel, full_matrices=False)
    space = right[:order].T
    poles = np.linalg.eigvals(np.linalg.pinv(space[:-1]) @ space[1:])
    powers = poles[None, :] ** np.arange(len(values))[:, None]
    amplitudes = np.linalg.lstsq(powers, values.astype(complex), rcond=None)[0]
    rates = np.log(poles.astype(complex)) / interval
    found = [
        (rate.imag / (2 * np.pi), 2 * abs(amplitude), -rate.real)
        for rate, amplitude in zip(rates, amplitudes, strict=True)
        if rate.imag > 1.0
    ]
    return sorted(found, key=lambda item: -item[1])
