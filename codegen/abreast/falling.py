"""Which runs come to an event, told at once of all whose triggers surely fall, or do not."""

from typing import NamedTuple

import numpy as np

from codegen.numbers.arrays import Array, Flags
from codegen.standalone.arrays import Places
from codegen.tuning import TUNING

MOST = 100
"""Halvings and steps of Newton's method at the most; some six do."""


class Told(NamedTuple):
    """Of runs: which rest so near an event that rounding decides, and which take a closer look.

    Of the others the step of the event, -1 where there is none, and whose it may be.
    """

    near: Flags
    doubtful: Flags
    step: Places
    due: Flags


def told(shapes: Array, valid: Places, armed: Flags, limits: Array, noise: Array) -> Told:
    """What Bernstein coefficients of triggers tell: runs x steps x triggers x coefficients.

    ``valid``: so many steps of each run count. ``armed``, ``limits``: runs x triggers; those that are not
    armed must rise through the first step, beyond their limits, and are armed then: they fall by less in it.
    ``noise``: by as much as rounding may make of triggers at the end of that step, and far more.
    """
    first, every = shapes[:, 0], np.arange(len(shapes))
    # The slope is the degree times a mean of the differences.
    rises = (shapes.shape[3] - 1) * np.diff(first, axis=2).min(axis=2) > -limits
    rises &= (first[:, :, -1] > limits) & (first.min(axis=2) > -2 * limits)
    far = np.abs(first[:, :, -1]) > TUNING.surely * np.maximum(limits, noise)
    near: Flags = np.asarray(~(armed | far).all(axis=1))
    suspects = shapes.min(axis=3) <= 0
    suspects[:, 0] &= armed
    suspects &= (np.arange(shapes.shape[1]) < valid[:, None])[:, :, None]
    some = suspects.any(axis=2)
    step = np.where(some.any(axis=1), some.argmax(axis=1), -1)
    due = suspects[every, step] & (step >= 0)[:, None]
    own = shapes[every, step]
    falls = (np.diff(own, axis=2) < 0).all(axis=2) & (own[:, :, 0] > 0) & (own[:, :, -1] <= 0)
    doubtful = (~armed & ~rises).any(axis=1) | (due & ~falls).any(axis=1)
    return Told(near, ~near & doubtful, step, due)


def roots(powers: Array) -> Array:
    """Where polynomials that fall all the way from above zero to zero or below, by rows, are zero on [0, 1].

    By Newton's method, halving where that leaves the interval, until only rounding is left.

    >>> roots(np.array([[1.0, -4.0, 0.0], [2.0, -1.0, -1.0]])).tolist()
    [0.25, 1.0]
    """
    low, high = np.zeros(len(powers)), np.ones(len(powers))
    tau, before = np.full(len(powers), 0.5), np.ones(len(powers))
    done = np.zeros(len(powers), dtype=bool)
    for _ in range(MOST):
        value, slope = np.zeros_like(tau), np.zeros_like(tau)
        for coefficient in powers.T[::-1]:
            slope = slope * tau + value
            value = value * tau + coefficient
        low, high = np.where(value > 0, tau, low), np.where(value > 0, high, tau)
        with np.errstate(all="ignore"):
            new = tau - value / slope
        # Where it would not come nearer, the interval is halved.
        inside = (new >= low) & (new <= high)
        new = np.where(value == 0, tau, np.where(inside, new, 0.5 * (low + high)))
        change = np.abs(new - tau)
        # Each stays where it came to, whatever the others do.
        tau = np.where(done, tau, new)
        done |= (change <= np.spacing(tau)) | ((change >= before) & (before <= TUNING.rounding))
        if done.all():
            break
        before = change
    return tau


def together(found: Array, due: Flags, t: Array, step: Array) -> tuple[Array, Flags]:
    """The first of each run's roots, and the triggers whose roots are one with it; ``t`` [s]: of steps."""
    places = np.where(due, found, np.inf)
    tau = places.min(axis=1)
    near = tau + TUNING.together * np.maximum(1.0, t / step)
    return tau, places <= near[:, None]
