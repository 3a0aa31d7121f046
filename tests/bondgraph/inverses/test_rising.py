"""Signs show whether laws go one way; what numbers contradict is never shown."""

import numpy as np
import pytest
import sympy as sp

from bondgraph.algebra.expressions import expression
from bondgraph.inverses.inverse import inverse_of
from bondgraph.inverses.rising import rising

Q = sp.Symbol("q")

ONE_WAY = [
    ("k*q + c*q**3", (-3, 3)),
    ("-k*q - c*q**5", (-3, 3)),
    ("k*q + c*q*abs(q)", (-3, 3)),
    ("k*q + c*tanh(q/w)", (-3, 3)),
    ("sinh(q) + q", (-3, 3)),
    ("k*q - exp(-c*q)", (-3, 3)),
    ("k*q + c*log(1 + q/w)", (-0.7, 5)),
    ("k*q + c/(w - q)", (-3, 0.7)),
    ("k*q + c*((w/(w - q))**1.4 - 1)", (-3, 0.7)),
    ("k*q + sqrt(w + q)", (-0.7, 5)),
    ("k*q + c*(w + q)**n", (-0.7, 5)),
    ("atan(q) + sinh(q)**3", (-3, 3)),
    ("k*q + c*tan(q/w)", (-1.2, 1.2)),
]

NOT_SHOWN = [
    "q**3", "k*q - c*q**3", "sin(q) + 2*q", "k*q + abs(q)", "q + max(q, 0)", "k*q + c/q",
    "k*q + log(q**2 + 1)", "q**2", "k", "exp(q) + exp(-q)", "k*q + c*log(1 - q**2)", "k*q + sign(q)",
    "k*q + tan(2 + q)", "atan2(q, -c) - q",
]  # fmt: skip


@pytest.mark.parametrize(("text", "ends"), ONE_WAY)
def test_a_law_that_goes_one_way_has_a_slope_of_one_sign(text: str, ends: tuple) -> None:
    """At numbers, as differences have it."""
    law = expression(text, "law")
    shown = rising(law, Q)
    assert shown is not None
    numbers = {"k": 0.3, "c": 2.0, "w": 0.8, "n": 2.5}
    assert {str(one) for one in shown.positive} <= set(numbers)
    value = sp.lambdify(Q, law.subs(numbers), "numpy")
    slope = sp.lambdify(Q, shown.slope.subs(numbers), "numpy")
    q, h = np.linspace(*ends, 41), 1e-6
    found = slope(q)
    assert found == pytest.approx((value(q + h) - value(q - h)) / (2 * h), rel=2e-5)
    assert (found > 0).all() or (found < 0).all()
    for one in shown.domain:
        assert (sp.lambdify(Q, one.subs(numbers), "numpy")(q) > 0).all()


@pytest.mark.parametrize("text", NOT_SHOWN)
def test_what_does_not_go_one_way_or_has_corners_is_not_shown(text: str) -> None:
    assert rising(expression(text, "law"), Q) is None


def test_a_square_is_no_less_than_zero_whatever_sign_its_name_has() -> None:
    """A signal that is read may have either sign; only where its square has to be more is it positive."""
    free = rising(expression("(atan(q) + q/5)/(1 + f**2)", "law"), Q)
    bound = rising(expression("f**2*q", "law"), Q)
    assert free is not None
    assert bound is not None
    assert (free.positive, bound.positive) == ((), (sp.Symbol("f"),))


def test_inverses_of_one_law_made_twice_are_put_in_order() -> None:
    """Sympy compares parts of sums, those too that are equal and not the same."""
    value = sp.Symbol("e")
    one, other = (inverse_of(expression("q + q**3", "law"), Q, value) for _ in range(2))
    assert one is not None
    assert other is not None
    assert one + 2 * other.subs(value, 3 * value) - other == 2 * other.subs(value, 3 * value)
    assert one.compare(other) == 0
