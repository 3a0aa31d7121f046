"""Derivative causality on demand: as taught, and its count against the rank of the state matrix."""

import random

import pytest
import sympy as sp
from references.brute_force import regular, regular_port_choices
from references.build import Graph, bond_graph
from references.matrices import rationals
from references.random_graphs import random_graph
from soak.families import seeds

import bondgraph as bg

NODES = [bg.Se("push", "F"), bg.One("mass"), bg.I("m", "m"), bg.C("spring", "c"), bg.R("drag", "b")]
OSCILLATOR = bond_graph(NODES, "push>mass>m mass>spring mass>drag")
FREE = bond_graph([one for one in NODES if one[0] != "spring"], "push>mass>m mass>drag")
COUPLED = bond_graph([*NODES, bg.I("more", "m_2")], "push>mass>m mass>spring mass>drag mass>more")


def test_all_storages_of_an_oscillator_can_have_derivative_causality() -> None:
    """Statics: a constant force leaves spring and mass where F = q/c and v = 0."""
    found = bg.assign_causality(OSCILLATOR, derivative=True)
    assert (found.integral, found.derivative) == ((), ("m", "spring"))
    assert found.strokes["mass", "m"] == "mass"
    assert found.strokes["mass", "spring"] == "spring"
    assert "is tried in derivative causality first" in found.why("m")[0]


def test_a_mass_without_drag_keeps_integral_causality() -> None:
    """No rest under a constant force: the state matrix has rank 0."""
    alone = bond_graph(NODES[:3], "push>mass>m")
    assert bg.assign_causality(alone, derivative=True).integral == ("m",)
    assert bg.assign_causality(FREE, derivative=True).integral == ()


def test_chosen_storages_alone() -> None:
    assert bg.assign_causality(COUPLED).derivative == ("more",)
    chosen = bg.assign_causality(COUPLED, derivative=["m"])
    assert (chosen.integral, chosen.derivative) == (("spring", "more"), ("m",))
    assert bg.assign_causality(COUPLED, derivative=[]).derivative == ("more",)


def test_equations_of_another_choice_of_states_are_the_same_in_its_states() -> None:
    """(m + m_2) v' = F - b v - F_spring, whichever of the two gives v."""
    chosen = bg.assign_causality(COUPLED, derivative=["m"])
    equations = bg.state_equations(bg.junction_structure(chosen))
    assert [str(name) for name in equations.states] == ["e_spring", "f_more"]
    m, m_2 = sp.symbols("m m_2")
    assert equations.A[1, 1] == m + m_2


def test_strokes_that_have_no_state_equations_are_refused_by_name() -> None:
    found = bg.assign_causality(OSCILLATOR, derivative=True)
    with pytest.raises(bg.CausalityError, match=r"'m' has derivative causality.*'spring'"):
        bg.state_equations(bg.junction_structure(found))


def test_fields_are_chosen_whole_and_unknown_storages_refused() -> None:
    with pytest.raises(bg.StructureError, match=r"'springs' is no storage.*did you mean 'spring'"):
        bg.assign_causality(OSCILLATOR, derivative=["springs"])
    with pytest.raises(bg.StructureError, match="'drag' is no storage"):
        bg.assign_causality(OSCILLATOR, derivative=["drag"])
    with pytest.raises(bg.StructureError, match="list of storages"):
        bg.assign_causality(OSCILLATOR, derivative="m")


def _small(seed: int) -> tuple[Graph, random.Random]:
    rng = random.Random(seed)
    return random_graph(rng, rng.randint(3, 9), mesh=0.3), rng


@pytest.mark.parametrize("seed", seeds("derivative-first"))
def test_those_that_stay_integral_are_what_the_state_matrix_lacks_in_rank(seed: int) -> None:
    graph, rng = _small(seed)
    if not regular(graph):
        return
    stay = bg.assign_causality(graph, derivative=True).integral
    choices = regular_port_choices(graph)
    prefers = {"I": "flow", "C": "effort"}
    kinds = {node: graph.nodes[node]["kind"] for node in choices[0]}
    least = min(sum(prefers.get(kinds[n]) == gives for n, gives in one.items()) for one in choices)
    assert len(stay) == least
    equations = bg.derive(graph, outputs=[])
    values = {
        p: sp.Rational(rng.randint(1, 10**6), rng.randint(1, 10**6)) for p in equations.parameters
    }
    J = rationals(equations.J, {name.name: value for name, value in values.items()})
    assert len(stay) == J.rows - (J.rank() if J.rows else 0)
