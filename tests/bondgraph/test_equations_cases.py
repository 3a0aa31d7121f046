"""Models with equations printed elsewhere."""

import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph
from references.cases import CASES, Case
from references.matrices import differences, numbers
from rig.walked import WALKED
from scipy.linalg import expm

import bondgraph as bg

pytestmark = WALKED


def _values(case: Case) -> dict[str, sp.Expr]:
    return {
        str(name): sp.nsimplify(sp.sympify(attributes["value"], _names(case)), rational=True)
        for name, attributes in case.nodes
        if attributes["kind"] in ("I", "C")
    }


def _names(case: Case) -> dict[str, sp.Symbol]:
    """Every name that occurs as a plain symbol, for sympy's own parser."""
    texts = [*case.rates.values(), *case.outputs.values()]
    texts += [str(attributes.get("value", "")) for _, attributes in case.nodes]
    words = {word for text in texts for word in _words(text)}
    return {word: sp.Symbol(word) for word in words}


def _words(text: str) -> list[str]:
    cleaned = "".join(c if c.isalnum() or c == "_" else " " for c in text)
    return [word for word in cleaned.split() if word.isidentifier()]


def _in_co_energy(case: Case, stored: str) -> tuple[sp.Symbol, sp.Expr]:
    """The engine's state of a momentum or displacement, and the state in terms of it: f = p/I, e = q/C."""
    letter, node = stored[0], stored[2:]
    state = sp.Symbol(("f_" if letter == "p" else "e_") + node)
    return state, sp.Symbol(stored) / _values(case)[node]


@pytest.mark.parametrize("case", CASES.values(), ids=CASES.keys())
def test_rates_are_the_printed_ones(case: Case) -> None:
    equations = bg.derive(bond_graph(case.nodes, case.bonds), outputs=case.outputs)
    names = _names(case)
    co_energy = dict(_in_co_energy(case, stored) for stored in case.rates)
    assert set(equations.states) == set(co_energy)
    x = sp.Matrix([co_energy[state] for state in equations.states])
    rates = {sp.Symbol(key): sp.sympify(text, names) for key, text in case.rates.items()}
    x_dot = x.xreplace(rates)
    u = sp.Matrix(len(equations.inputs), 1, equations.inputs)
    assert equations.E.todok() == {}
    assert differences(equations.A * x_dot, equations.J * x + equations.B * u) == {}
    assert equations.G.todok() == {}
    expected = [sp.sympify(text, names) for text in case.outputs.values()]
    shown = equations.F * x + equations.D * u
    assert differences(shown, sp.Matrix(len(expected), 1, expected)) == {}


def test_two_halves_of_an_oscillator_swing_as_one() -> None:
    """BondGraphs.jl module_tests.jl: R = L = C = 1 from q = p = 1; closed form at t = 1."""
    nodes = [bg.Zero("one"), bg.Zero("other"), bg.R("R", 1), bg.I("L", 1), bg.C("C", 1)]
    equations = bg.derive(bond_graph(nodes, "one>R one>other>L one>C"))
    assert equations.states == sp.symbols("f_L e_C")
    A, J = numbers(equations.A, {}), numbers(equations.J, {})
    p, q = expm(np.linalg.solve(A, J)) @ [1, 1]
    w, scale = np.sqrt(3) / 2, np.exp(-0.5)
    assert q == pytest.approx(scale * (np.cos(w) - np.sqrt(3) * np.sin(w)), abs=1e-12)
    assert p == pytest.approx(scale * (np.cos(w) + np.sqrt(3) * np.sin(w)), abs=1e-12)
    assert [q.real, p.real] == pytest.approx([-0.40731424, 1.1932073], abs=1e-7)


@pytest.mark.parametrize(
    ("two_port", "first", "second", "expected"),
    [
        (bg.TF, bg.Sf, bg.Se, [[0, "n"], ["n", 0]]),
        (bg.TF, bg.Se, bg.Sf, [[0, "1/n"], ["1/n", 0]]),
        (bg.GY, bg.Se, bg.Se, [[0, "1/n"], ["1/n", 0]]),
        (bg.GY, bg.Sf, bg.Sf, [[0, "n"], ["n", 0]]),
    ],
)
def test_two_ports_in_both_causalities(two_port, first, second, expected) -> None:
    """MTT Components_rep.pdf, TwoPorts: TF ``e1 = n e2, f2 = n f1``; GY ``e1 = n f2, e2 = n f1``."""
    nodes = [first("in", "u1"), two_port("t", "n"), second("out", "u2")]
    equations = bg.derive(bond_graph(nodes, "in>t>out"), outputs=["in", "out"])
    assert equations.states == ()
    assert differences(equations.D, sp.Matrix(expected)) == {}
    assert equations.G.todok() == {}


def test_capacitor_at_a_voltage_source_follows_it() -> None:
    """BondGraphTools test_algebra.py: x = u, one dependent storage; the current is C u' + u/R."""
    nodes = [bg.Zero("z"), bg.C("C", 1), bg.Se("s", "u"), bg.R("R", "R_0")]
    equations = bg.derive(bond_graph(nodes, "z>C s>z z>R"), outputs=["C", "s"])
    assert equations.states == ()
    assert differences(equations.D, [[1], [1 / sp.Symbol("R_0")]]) == {}
    assert differences(equations.G, [[0], [1]]) == {}


def test_capacitor_at_a_constant_source_is_constant() -> None:
    """BondGraphTools test_RLC.py, test_se: x' = 0, x = 1."""
    graph = bond_graph([bg.Se("s", 1), bg.C("C", 1)], "s>C")
    equations = bg.derive(graph, outputs=["C"])
    assert (equations.states, equations.inputs) == ((), sp.symbols("e_s,"))
    assert equations.laws["s"] == bg.ExpressionLaw(sp.Integer(1))
    assert differences(equations.D, [[1]]) == {}
