"""Explicit rates: the printed momenta's rates of other tools, simulators at random points, loops of laws."""

import copy
import pickle
import random

import networkx as nx
import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph
from references.cases import CASES
from references.random_graphs import random_graph

import bondgraph as bg
from codegen import Simulator, simulator


@pytest.mark.parametrize("name", CASES)
def test_energy_states_have_the_printed_rates(name: str) -> None:
    case = CASES[name]
    found = bg.explicit(bg.derive(bond_graph(case.nodes, case.bonds), outputs=[]), energy=True)
    for state, text in case.rates.items():
        if sp.Symbol(state) in found:
            expected = bg.expression(text, state)
            assert sp.cancel(found[sp.Symbol(state)] - expected) == 0, state
    assert {str(state) for state in found} <= set(case.rates)


def _closed(seed: int) -> tuple[bg.StateEquations, dict]:
    equations = None
    for at in range(100 * seed, 100 * seed + 99):
        try:
            equations = bg.derive(random_graph(random.Random(at), 9, mesh=0.3), outputs=[])
        except bg.BondGraphError:
            continue
        if equations.states and not equations.E.todok():
            break
    rng = np.random.default_rng(seed)
    return equations, {n.name: float(rng.uniform(0.5, 2)) for n in equations.parameters}


@pytest.mark.parametrize("seed", range(15))
def test_rates_are_the_simulators_at_random_points(seed: int) -> None:
    equations, numbers = _closed(seed)
    ready = simulator(equations, numbers)
    rng = np.random.default_rng(seed)
    x, u = rng.normal(size=len(ready.states)), rng.normal(size=len(ready.inputs))
    point = {
        **numbers,
        **dict(zip(ready.states, x, strict=True)),
        **dict(zip(ready.inputs, u, strict=True)),
    }
    found = bg.explicit(equations)
    rates = [float(found[sp.Symbol(s)].subs(point)) for s in ready.states]
    assert rates == pytest.approx(ready.rhs(0.0, x, u), rel=1e-9, abs=1e-12)


def _linkage() -> nx.DiGraph:
    """A crank that moves a dependent mass, a nonlinear spring, and a law that reads an effort."""
    nodes = [bg.Se("drive", "3*sin(t)"), bg.One("rot"), bg.I("J", "J", flow="omega"),
             bg.Df("angle", integrate="theta"), bg.TF("crank", "r*sin(theta)"), bg.One("slider"),
             bg.I("m", "m", priority=-1), bg.C("k", law="k*q_k + q_k**3"), bg.Zero("z"), bg.R("b", "b"),
             bg.One("o"), bg.R("valve", law="c*abs(e_b)*f_valve")]  # fmt: skip
    return bond_graph(
        nodes, "drive>rot>J rot>angle rot>crank>slider>m slider>k slider>z>b z>o>valve"
    )


def test_laws_moving_ratios_and_known_sources_are_put_in() -> None:
    nodes_graph = _linkage()
    nodes_graph.nodes["valve"]["law"] = "c*f_valve"
    equations = bg.derive(nodes_graph, outputs=[])
    numbers = {"J": 0.5, "r": 0.3, "m": 2.0, "k": 4.0, "b": 0.7, "c": 0.2}
    for law in ("c*f_valve", "c*omega"):
        found = bg.explicit(equations, laws={"valve": law})
        ready = simulator(equations, numbers, laws={"valve": law})
        _agree_at_a_state(found, ready, numbers)


def _agree_at_a_state(found: bg.ExplicitRates, ready: Simulator, numbers: dict[str, float]) -> None:
    state = {"omega": 1.3, "theta": 0.4, "q_k": -0.2}
    rates = ready.rhs(0.9, [state[name] for name in ready.states])
    point = {**numbers, **state, "t": 0.9}
    assert [float(found[sp.Symbol(s)].subs(point)) for s in ready.states] == pytest.approx(rates)


def test_the_rate_of_an_input_is_a_symbol_and_of_a_known_source_its_slope() -> None:
    def divider(value: object) -> bg.StateEquations:
        nodes = [bg.Se("s", value), bg.One("n"), bg.Zero("z"), bg.R("r", "R"), bg.C("a", "C_1"),
                 bg.C("b", "C_2", effort="v", priority=1)]  # fmt: skip
        return bg.derive(bond_graph(nodes, "s>n>a n>z>b z>r"), outputs=[])

    C_1, C_2, R, v, t = sp.symbols("C_1 C_2 R v t")
    for value, rate in (("V", sp.Symbol("d_V")), ("2*sin(3*t)", 6 * sp.cos(3 * t))):
        (found,) = bg.explicit(divider(value)).values()
        assert sp.simplify(found - (C_1 * rate - v / R) / (C_1 + C_2)) == 0


def test_a_long_chain_has_rates_of_neighbours_only() -> None:
    chain: list = [bg.Se("u", "u")]
    path = "u"
    for j in range(60):
        chain += [
            bg.One(f"j{j}"),
            bg.I(f"m{j}", 1, flow=f"v{j}"),
            bg.Zero(f"z{j}"),
            bg.R(f"r{j}", 1),
        ]
        path += f">j{j}>z{j}"
    bonds = path + " " + " ".join(f"j{j}>m{j} z{j}>r{j}" for j in range(60))
    found = bg.explicit(bg.derive(bond_graph(chain, bonds), outputs=[]))
    v = sp.symbols("v:60")
    assert found[v[0]] == sp.Symbol("u") - v[0] + v[1]
    assert [found[v[j]] for j in range(1, 59)] == [
        v[j - 1] - 2 * v[j] + v[j + 1] for j in range(1, 59)
    ]


def test_energy_states_need_values_that_stay() -> None:
    with pytest.raises(bg.StructureError, match="values of this graph change in time"):
        bg.explicit(bg.derive(_linkage(), outputs=[]), laws={"valve": "0*omega"}, energy=True)


def test_rates_are_a_mapping_that_is_copied_and_pickled() -> None:
    found = bg.explicit(bg.derive(_linkage(), outputs=[]), laws={"valve": "c*omega"})
    again = pickle.loads(pickle.dumps(found))
    assert (again, copy.deepcopy(found)) == (found, found)
    assert again == dict(found.items())
    assert repr(again) == f"ExplicitRates({dict(found)})"


def test_latex_has_every_matrix_that_is_not_zero() -> None:
    nodes = [bg.Se("u", "tau_e"), bg.One("j"), bg.I("J", "J", flow="omega_1"), bg.R("b", "b"),
             bg.R("clutch", effort="tau_f", flow="omega_f")]  # fmt: skip
    text = bg.latex(bg.derive(bond_graph(nodes, "u>j>J j>b j>clutch")))
    assert text.count(r"\begin{matrix}") == 9
    for part in (r"\omega_{1}", r"\tau_{f}", r"\frac{d}{dt}", "- b"):
        assert part in text
