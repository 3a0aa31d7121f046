"""Laws of resistances are turned round where they contradict others, or impose what a storage keeps."""

import numpy as np
import pytest
from references.build import bond_graph
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import bondgraph as bg
from codegen import simulator

PUMP = [bg.Sf("pump", "Q"), bg.Zero("n"), bg.R("r", law="b*f_r + d*f_r**3")]
NUMBERS = {"b": 1.0, "d": 2.0}


def _leak(p: float) -> float:
    return brentq(lambda f: f + 2 * f**3 - p, -50, 50, xtol=1e-14)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_a_resistance_beside_a_capacitor_gives_its_flow(backend: str) -> None:
    """By the law of its flow, which is turned round."""
    equations = bg.derive(bond_graph([*PUMP, bg.C("c", "C", effort="p")], "pump>n>c n>r"))
    assert [str(one) for one in equations.states] == ["p"]
    run = simulator(equations, {**NUMBERS, "C": 0.5}, backend=backend).run(
        np.linspace(0, 2, 9), inputs={"Q": 1.5}
    )
    right = solve_ivp(lambda t, p: [(1.5 - _leak(p[0])) / 0.5], (0, 2), [0.0], "DOP853", run.time,
                      rtol=1e-11, atol=1e-12).y[0]  # fmt: skip
    assert run["p"] == pytest.approx(right, abs=1e-8)
    assert run["f_r"] == pytest.approx([_leak(p) for p in right], abs=1e-8)


def test_storages_and_resistances_are_turned_at_once() -> None:
    nodes = [
        *PUMP,
        bg.C("c", law="sinh(q_c)", effort="p"),
        bg.C("a", law="q_a + q_a**3", effort="p_a"),
    ]
    equations = bg.derive(bond_graph(nodes, "pump>n>c n>a n>r"))
    assert [str(one) for one in equations.states] == ["p"]
    run = simulator(equations, NUMBERS).run(np.linspace(0, 2, 9), inputs={"Q": 1.5})

    def held(p: float) -> float:
        return np.arcsinh(p) + brentq(lambda q: q + q**3 - p, -50, 50, xtol=1e-14)

    def rate(t: float, q: np.ndarray) -> list[float]:
        return [1.5 - _leak(brentq(lambda p: held(p) - q[0], -50, 50, xtol=1e-14))]

    q = solve_ivp(rate, (0, 2), [0.0], "DOP853", run.time, rtol=1e-11, atol=1e-12).y[0]
    assert [held(p) for p in run["p"]] == pytest.approx(q, abs=1e-8)


def test_of_several_as_few_as_will_do_are_turned() -> None:
    """Of two in series one gives the flow, the first stays as it is written."""
    nodes = [bg.Se("u", "u"), bg.One("j"), bg.R("a", law="e_a + e_a**3", gives="flow"),
             bg.R("b", law="e_b + 2*e_b**3", gives="flow")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "u>j>a j>b"))
    gives = {port.element.name: port.gives for port in equations.ports}
    assert sorted(gives[name] for name in "ab") == ["effort", "flow"]
    run = simulator(equations, {}).run([0, 1], inputs={"u": 3.0})
    e = brentq(lambda e: e + e**3 - (3 - e) - 2 * (3 - e) ** 3, 0, 3, xtol=1e-14)
    assert run["e_a"] == pytest.approx([e, e], abs=1e-9)


def test_a_law_that_turns_back_is_refused_as_before() -> None:
    nodes = [
        bg.Sf("pump", "Q"),
        bg.Zero("n"),
        bg.R("r", law="f_r**3 - f_r"),
        bg.C("c", "C", effort="p"),
    ]
    with pytest.raises(bg.DependentSourceError, match="the law at 'r' drives a dependent storage"):
        bg.derive(bond_graph(nodes, "pump>n>c n>r"))


LATER = [bg.Sf("pump", "Q"), bg.Zero("n"), bg.C("c", "C", effort="p")]


@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize(
    ("declared", "later"),
    [
        (None, "b*f_r + d*f_r**3"),
        ("5*f_r", "b*f_r + d*f_r**3"),
        ("b*f_r + d*f_r**3", None),
        ("b*f_r + d*f_r**3", "b*f_r + d*f_r**3"),
    ],
)
def test_laws_put_later_are_written_either_way(backend: str, declared: str, later: str) -> None:
    """Over an open port, or in place of a law that was turned round."""
    graph = bond_graph([*LATER, bg.R("r", law=declared) if declared else bg.R("r")], "pump>n>c n>r")
    laws = {"r": later} if later else {}
    run = simulator(bg.derive(graph), {**NUMBERS, "C": 0.5}, laws, backend=backend).run(
        np.linspace(0, 2, 9), inputs={"Q": 1.5}
    )
    right = solve_ivp(lambda t, p: [(1.5 - _leak(p[0])) / 0.5], (0, 2), [0.0], "DOP853", run.time,
                      rtol=1e-11, atol=1e-12).y[0]  # fmt: skip
    assert run["p"] == pytest.approx(right, abs=1e-8)


def test_a_law_of_what_the_port_receives_now_is_taken_as_it_is() -> None:
    graph = bond_graph([*LATER, bg.R("r", law="5*f_r")], "pump>n>c n>r")
    run = simulator(bg.derive(graph), {"C": 1.0}, {"r": "e_r/2"}).run(
        [0, 1], {"p": 1.0}, {"Q": 0.0}
    )
    assert run["p"][1] == pytest.approx(np.exp(-0.5), abs=1e-9)


def test_a_law_that_is_not_turned_round_is_refused_where_the_port_was() -> None:
    equations = bg.derive(bond_graph([*LATER, bg.R("r", law="5*f_r")], "pump>n>c n>r"))
    with pytest.raises(bg.DependentSourceError, match="is not turned round; give a law of e_r"):
        simulator(equations, {"C": 1.0}, {"r": "f_r**3 - f_r"})
