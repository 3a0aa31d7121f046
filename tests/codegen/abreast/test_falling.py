"""Which runs come to an event, beside what looks at one run after the other, and beside scipy's roots."""

import numpy as np
import pytest
from scipy.optimize import brentq

from codegen.abreast.falling import roots, together, told
from codegen.inputs.polynomials import first_fall, to_bernstein

DEGREE = 6


def _shapes(powers: np.ndarray) -> np.ndarray:
    return powers @ to_bernstein(DEGREE).T


def test_random_triggers_are_told_as_one_by_one() -> None:
    """Where it is told at all: the first step in which one falls, and none before."""
    rng = np.random.default_rng(5)
    powers = rng.normal(size=(300, 4, 2, DEGREE + 1)) * 0.4 ** np.arange(DEGREE + 1)
    powers[..., 0] = rng.uniform(0.2, 2.5, powers.shape[:3])
    valid = rng.integers(1, 5, 300)
    armed, limits = np.ones((300, 2), dtype=bool), np.full((300, 2), 1e-9)
    found = told(_shapes(powers), valid, armed, limits, limits)
    sure = falls = 0
    assert not found.near.any()
    for run in np.flatnonzero(~found.doubtful).tolist():
        first = [
            (step, {j for j in range(2) if first_fall(powers[run, step, j]) is not None})
            for step in range(valid[run])
        ]
        step, whose = next(((k, own) for k, own in first if own), (-1, set()))
        assert found.step[run] == step
        assert {*np.flatnonzero(found.due[run]).tolist()} >= whose
        sure, falls = sure + 1, falls + (step >= 0)
    assert sure > 100
    assert falls > 30


def test_what_begins_at_zero_has_to_rise_first() -> None:
    """Or is looked at by itself: closer where it gets away from zero, as a whole run where it does not."""
    limits, one = np.full((1, 1), 1e-6), np.ones(1, dtype=int)
    for powers, near, doubtful in (
        ([0.0, 0.0, 1.0], False, False), ([-1e-7, 0.0, 1.0], False, False),
        ([-3e-6, 0.0, 1.0], False, True), ([0.0, -1.0, 2.0], False, True),
        ([0.0, 2.0, -1.5], False, True), ([0.0, 1.0, -1.0], True, False),
        ([0.0, 1e-8, 0.0], True, False), ([0.0, -1.0, 0.0], False, True),
    ):  # fmt: skip
        row = np.zeros(DEGREE + 1)
        row[: len(powers)] = powers
        found = told(
            _shapes(row[None, None, None]), one, np.zeros((1, 1), dtype=bool), limits, limits
        )
        assert (bool(found.near[0]), bool(found.doubtful[0])) == (near, doubtful), powers
        assert found.step[0] == -1


def test_roots_are_those_of_scipy() -> None:
    rng = np.random.default_rng(8)
    slopes = -rng.uniform(0.1, 2.0, (50, DEGREE))
    powers = np.hstack(
        [-rng.uniform(0.0, 1.0, (50, 1)) * slopes.sum(axis=1, keepdims=True), slopes]
    )
    found = roots(powers)
    for row, tau in zip(powers, found, strict=True):
        assert tau == pytest.approx(
            brentq(np.polynomial.Polynomial(row), 0.0, 1.0, xtol=1e-15), abs=1e-14
        )
    alone = [float(roots(row[None])[0]) for row in powers]
    assert found.tolist() == alone, "a root rests on its own polynomial alone"


def test_roots_of_one_instant_are_one_event() -> None:
    places, due = np.array([[0.5, 0.5 + 1e-13, 0.2]]), np.array([[True, True, False]])
    tau, whose = together(places, due, np.array([1.0]), np.array([1.0]))
    assert tau.tolist() == [0.5]
    assert whose.tolist() == [[True, True, False]]
