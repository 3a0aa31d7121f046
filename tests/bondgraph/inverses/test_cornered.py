"""Laws with corners turned round: the places that brentq finds, or the reason why there is none."""

import re

import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph
from scipy.optimize import brentq

import bondgraph as bg
import codegen
from bondgraph.inverses.cornered import cornered_inverse
from bondgraph.inverses.reasons import why_not

Q, E = sp.symbols("q e")
NUMBERS = {"k": 1.3, "c": 0.7, "g": 0.4}

LAWS = [
    "k*q + c*Max(q - g, 0)",
    "k*q + c*Max(q - g, 0) + c*Min(q + g, 0)",
    "q*abs(q) + k*q",
    "sign(q)*q**2 + k*q",
    "-q - abs(q)/2",
    "Max(q, 2*q - 1, 3*q - 3)",
    "Piecewise((k*q, q < g), (k*g + c*(q - g) + (q - g)**2, True))",
    "Piecewise((exp(q) - 1, q > 0), (q, True))",
    "Piecewise((k*q, And(q > -1, q < 1)), (c*(q - 1) + k, q >= 1), (c*(q + 1) - k, True))",
    "k*(g + abs(q))**2*sign(q) - k*g**2*sign(q)",
]


@pytest.mark.parametrize("text", LAWS)
def test_the_inverse_is_brentqs(text: str) -> None:
    law = sp.sympify(text, {"q": Q, "abs": sp.Abs}) if "And" in text else bg.expression(text, "law")
    found = cornered_inverse(law, Q, E)
    assert found is not None
    there = sp.lambdify(Q, law.subs(NUMBERS), "math")
    back = found[0].subs(NUMBERS)
    for place in np.linspace(-3, 3, 25):
        value = there(place)
        right = brentq(lambda q, v=value: there(q) - v, -9, 9, xtol=1e-14)
        assert float(back.subs(E, value)) == pytest.approx(right, abs=1e-12)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("q**3", r"level where 3\*q\*\*2 is zero, where its inverse would be infinitely steep"),
        ("q*abs(q)", "level where"),
        ("Max(q - 1, 0) + Min(q + 1, 0)", "level from q = -1 up to q = 1"),
        ("k*q + sign(q)", "jumps at q = 0"),
        ("abs(q)", "turns back"),
        ("q - q**3", "signs do not show"),
        ("k*q + Max(q**3 - q, 0)", "not told where its corners lie"),
    ],
)
def test_others_are_refused_with_the_reason(text: str, reason: str) -> None:
    law = bg.expression(text, "law")
    assert cornered_inverse(law, Q, E) is None
    assert re.search(reason, why_not(law, Q))
    nodes = [bg.Sf("s", "i"), bg.Zero("n"), bg.C("a", "c_a"),
             bg.C("b", law=text.replace("q", "q_b"))]  # fmt: skip
    with pytest.raises(bg.BondGraphError, match=reason.replace("q", "q_b")):
        bg.derive(bond_graph(nodes, "s>n>a n>b"))


def test_parameters_for_which_it_would_turn_back_are_refused_by_name() -> None:
    law = "k*q_b + c*Max(q_b - g, 0)"
    nodes = [bg.Sf("s", "i"), bg.Zero("n"), bg.C("a", "c_a"), bg.C("b", law=law)]
    equations = bg.derive(bond_graph(nodes, "s>n>a n>b"))
    with pytest.raises(bg.ParameterError, match="C 'b': its law is turned round here, for which c"):
        codegen.simulator(equations, {"k": 1.0, "c": -2.0, "g": 0.1, "c_a": 1.0})
