"""Laws turned round where nobody declared an inverse, and what that makes of graphs."""

import numpy as np
import pytest
from references.build import bond_graph
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import bondgraph as bg
from bondgraph.declare.declared import elements_of
from bondgraph.nodes.inverting import with_inverse
from codegen import Step, simulator

TURNED = [
    ("E*log(1 + q_x/Q)", {"E": 2.0, "Q": 0.5}, (0.01, 3.0)),
    ("sinh(q_x)/J", {"J": 2.0}, (-2.0, 2.0)),
    ("tanh(a*q_x)", {"a": 0.7}, (-2.0, 2.0)),
    ("T*exp(q_x/c)", {"T": 300.0, "c": 2.0}, (-1.0, 3.0)),
    ("p*(V/(V - q_x))**1.4", {"p": 2.0, "V": 3.0}, (0.0, 2.5)),
    ("P*(q_x/V)**n", {"P": 2.0, "V": 3.0, "n": 1.5}, (0.1, 2.5)),
    ("a*2**q_x - b", {"a": 2.0, "b": 3.0}, (-2.0, 2.0)),
]


@pytest.mark.parametrize(("law", "numbers", "ends"), TURNED)
def test_a_law_of_one_place_is_turned_round(law: str, numbers: dict, ends: tuple) -> None:
    """Put into each other, law and inverse are nothing."""
    (element,) = elements_of(*bg.C("x", law=law)).values()
    turned = with_inverse(element)
    assert turned is not None
    assert turned.gives is None
    for q in np.linspace(*ends, 7):
        e = element.law.expression.subs({**numbers, "q_x": q}).evalf()
        assert float(turned.inverse.subs({**numbers, "e_x": e}).evalf()) == pytest.approx(
            q, abs=1e-9
        )


@pytest.mark.parametrize(
    "law",
    [
        "q_x - q_x**3",
        "a*q_x**2",
        "q_x**3",
        "sqrt(q_x)",
        "sin(q_x)",
        "abs(q_x)*q_x",
        "q_x/(1 + q_x)",
        "a",
    ],
)
def test_what_is_not_undone_step_by_step_in_one_way_stays(law: str) -> None:
    (element,) = elements_of(*bg.C("x", law=law)).values()
    assert with_inverse(element) is None


def _bladders(second: str, **more: object):
    nodes = [bg.Sf("pump", "Q"), bg.Zero("n"), bg.C("a", law="p_0*(V/(V - q_a))**1.4", effort="p", **more),
             bg.C("b", law=second, effort="p_b")]  # fmt: skip
    return bond_graph(nodes, "pump>n>a n>b")


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_two_accumulators_on_one_node_share_what_is_pumped(backend: str) -> None:
    """The second holds twice the first: a third and two thirds of what came."""
    equations = bg.derive(_bladders("p_0*(2*V/(2*V - q_b))**1.4", start=0.0))
    run = simulator(equations, {"p_0": 2.0, "V": 1.0}, backend=backend).run(
        np.linspace(0, 1, 5), inputs={"Q": 1.2}
    )
    held = 0.4 * run.time
    assert run["p"] == pytest.approx(2 * (1 - held) ** -1.4, rel=1e-8)
    # int p dq = p_0 V (s^-0.4 - 1)/0.4 with s = 1 - q/V.
    right = 2 * ((1 - held) ** -0.4 - 1) / 0.4
    assert run.energy("a") - run.energy("a")[0] == pytest.approx(right, abs=1e-8)
    assert abs(run.audit().residual) < 1e-9 * run.audit().turned_over


def test_laws_that_are_not_turned_round_are_refused_by_name() -> None:
    with pytest.raises(bg.BondGraphError, match="the law at 'b' drives a dependent storage"):
        bg.derive(_bladders("q_b**3"))
    both = _bladders("q_b**3")
    both.nodes["a"]["law"] = "q_a**3"
    with pytest.raises(bg.CausalityError, match="; or give 'a' the inverse of its law, with which"):
        bg.derive(both)


def test_a_nonlinear_storage_behind_another_needs_no_inverse() -> None:
    """Two masses on one shaft: J w + asinh(J w) = T t."""
    nodes = [bg.Se("T", "T"), bg.One("a"), bg.I("J", "J", flow="w", priority=1),
             bg.I("fast", law="sinh(p_fast)/J")]  # fmt: skip
    run = simulator(bg.derive(bond_graph(nodes, "T>a>J a>fast")), {"J": 2.0}).run(
        np.linspace(0, 1, 11), inputs={"T": 3.0}
    )
    assert 2 * run["w"] + np.arcsinh(2 * run["w"]) == pytest.approx(3 * run.time, abs=1e-8)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_accumulators_empty_through_a_valve_that_an_input_opens(backend: str) -> None:
    """Derived once more for the input: of both ``p/(r (1 + closed))`` leaves, as of one thrice as large."""
    graph = _bladders("p_0*(2*V/(2*V - q_b))**1.4")
    graph.add_nodes_from([bg.R("valve", "r*(1 + closed)")])
    graph.add_edge("n", "valve")
    run = simulator(bg.derive(graph), {"p_0": 2.0, "V": 1.0, "r": 4.0}, backend=backend).run(
        np.linspace(0, 1, 5), {"p": 4.0}, {"Q": 0.0, "closed": Step(0.5, 1.0)}
    )

    def rate(t: float, q: np.ndarray) -> np.ndarray:
        return -2 * (1 - q / 3) ** -1.4 / (4 * (1 + (t >= 0.5)))

    q = 3 * (1 - 0.5 ** (1 / 1.4))
    first = solve_ivp(rate, (0, 0.5), [q], "DOP853", [0.25, 0.5 - 1e-15], rtol=1e-11, atol=1e-12)
    last = solve_ivp(
        rate, (0.5, 1), first.y[:, -1], "DOP853", [0.5, 0.75, 1], rtol=1e-11, atol=1e-12
    )
    held = np.array([q, first.y[0, 0], *last.y[0]])
    assert run["p"] == pytest.approx(2 * (1 - held / 3) ** -1.4, rel=1e-8)


@pytest.mark.parametrize("law", ["k*atan(f_r)", "k*(sqrt(1 + f_r) - 1)"])
@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_a_value_that_a_law_never_has_is_refused(law: str, backend: str) -> None:
    """Nothing has an arc of -2, and no root is -1: squares and tangents would have answers."""
    equations = bg.derive(bond_graph([bg.Se("s", "u"), bg.One("j"), bg.R("r", law=law)], "s>j>r"))
    model = simulator(equations, {"k": 2.0}, backend=backend)
    right = {"k*atan(f_r)": np.tan(-0.5), "k*(sqrt(1 + f_r) - 1)": -0.75}[law]
    assert model.run([0, 1], inputs={"u": -1.0})["f_r"] == pytest.approx(right, rel=1e-12)
    with pytest.raises(bg.SimulationError, match="f_r has no value"):
        model.run([0, 1], inputs={"u": -4.0})


def test_a_tangent_stays_between_its_poles() -> None:
    """``f + tan f`` of 4 is at 1.22 by brentq, and at 3.56 behind the pole."""
    graph = bond_graph([bg.Se("s", "u"), bg.One("j"), bg.R("r", law="f_r + tan(f_r)")], "s>j>r")
    run = simulator(bg.derive(graph), {}).run([0, 1], inputs={"u": 4.0})
    right = brentq(lambda f: f + np.tan(f) - 4, 0, 1.57, xtol=1e-14)
    assert run["f_r"] == pytest.approx(right, rel=1e-12)
