"""What is said of other tools' answers."""

import numpy as np
import pytest

from benchmarks.tools import verdicts

PAIR = np.array([-1 + 2j, -1 - 2j])


def pairs(values):
    return [[value.real, value.imag] for value in values]


def test_eigenvalues_in_any_order_are_right():
    assert verdicts.spectrum(pairs(PAIR[::-1]), PAIR) == "right"


@pytest.mark.parametrize(
    ("found", "said"),
    [
        (PAIR * (1 + 1e-5), "other eigenvalues"),
        (PAIR * (1 + 1e-7), "right"),
        ([*PAIR, 0], "right, and 1 at zero"),
        ([*PAIR, -3], "1 eigenvalues too many"),
        (PAIR[:1], "1 state, not 2"),
        ([PAIR[0], PAIR[0]], "other eigenvalues"),
    ],
)
def test_eigenvalues_are_compared_one_by_one(found, said):
    assert verdicts.spectrum(pairs(np.array(found, dtype=complex)), PAIR) == said


def test_what_is_no_number_or_of_another_shape_is_infinitely_far():
    exact = np.array([[0.0, 1.0], [1.0, 3.0]])
    assert verdicts.apart(exact + 0.5, exact) == pytest.approx(0.25)
    assert verdicts.apart([[0.0, 1.0]], exact) == np.inf
    assert verdicts.apart([[0.0, 1.0], [np.nan, 3.0]], exact) == np.inf


EXACT = [(0.5, "stick"), (0.6, "slip")]


@pytest.mark.parametrize(
    ("found", "said"),
    [
        ([[0.5 + 2e-7, "stick"], [0.6, "slip"]], "right: +2.0e-07, +0.0e+00 s"),
        ([[0.5 + 2e-6, "stick"], [0.6, "slip"]], "late: +2.0e-06, +0.0e+00 s"),
        ([[0.5, "stick"]], "wrong: stick, not stick, slip"),
        ([[0.5, "cross"], [0.6, "slip"]], "wrong: cross, slip, not stick, slip"),
        ([], "wrong: no event, not stick, slip"),
        # A crossing at the same instant belongs to the slip; a later one does not.
        ([[0.5, "stick"], [0.6, "slip"], [0.6 + 1e-12, "cross"]], "right: +0.0e+00, +0.0e+00 s"),
        (
            [[0.5, "stick"], [0.6, "slip"], [0.61, "cross"]],
            "wrong: stick, slip, cross, not stick, slip",
        ),
    ],
)
def test_lock_and_unlock_are_right_to_a_microsecond(found, said):
    assert verdicts.locked(found, EXACT) == said
