"""`derive`: sources that drive dependent storages, open ports, outputs, edge cases."""

import pytest
import sympy as sp
from references.build import bond_graph
from references.matrices import differences
from references.random_graphs import chain

import bondgraph as bg

c1, c2, r, m, k, b, n = sp.symbols("c1 c2 r m k b n")


def test_source_over_two_capacitors_in_series_enters_by_its_rate() -> None:
    """e1 + e2 = v and c1 e1' = c2 e2' + e2/r, so (c1 + c2) e1' = c2 v' + (v - e1)/r."""
    nodes = [
        bg.Se("v", "v"), bg.One("j"), bg.C("c1", "c1"), bg.Zero("z"), bg.C("c2", "c2"),
        bg.R("r", "r"),
    ]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "v>j>c1 j>z>c2 z>r"), outputs=["z", "v"])
    assert equations.states == sp.symbols("e_c1,")
    for matrix, expected in (
        (equations.A, c1 + c2), (equations.J, -1 / r), (equations.B, 1 / r), (equations.E, c2),
    ):  # fmt: skip
        assert differences(matrix, [[expected]]) == {}
    # Current of the source: c1 e1' with e1' from above.
    share = c1 / (c1 + c2)
    assert differences(equations.F, [[-1], [-share / r]]) == {}
    assert differences(equations.D, [[1], [share / r]]) == {}
    assert differences(equations.G, [[0], [share * c2]]) == {}


def test_driven_case_of_a_differential_accelerates_both_wheels() -> None:
    """w1 + w2 = 2 w and equal torques: I1 w1' = I2 w2' with w2' = 2 w' - w1'."""
    nodes = [
        bg.Sf("w", "w"), bg.TF("halves", 2), bg.Zero("sum"), bg.One("l"), bg.One("r"),
        bg.I("I1", "I1"), bg.I("I2", "I2"),
    ]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "w>halves>sum sum>l>I1 sum>r>I2"), outputs=["I2"])
    I1, I2 = sp.symbols("I1 I2")
    assert equations.states == sp.symbols("f_I1,")
    assert differences(equations.A, [[I1 + I2]]) == {}
    assert differences(equations.E, [[2 * I2]]) == {}
    assert differences(equations.B, [[0]]) == {}
    assert differences(equations.F, [[-1]]) == {}
    assert differences(equations.D, [[2]]) == {}


def test_force_on_a_driven_mass_is_its_inertia_force() -> None:
    nodes = [bg.Sf("v", "v"), bg.One("j"), bg.I("m", "m"), bg.C("k", "1/k")]
    equations = bg.derive(bond_graph(nodes, "v>j j>m j>k"), outputs=["v"])
    assert equations.states == sp.symbols("e_k,")
    assert equations.E.todok() == {}
    for matrix, expected in ((equations.F, 1), (equations.D, 0), (equations.G, m)):
        assert differences(matrix, [[expected]]) == {}


def test_open_port_that_gives_flow_receives_the_effort() -> None:
    """A pump draws f_p from a tank: c e' = -f_p; power counts into the port."""
    nodes = [bg.Zero("tank"), bg.C("c1", "c1"), bg.R("pump", gives="flow")]
    equations = bg.derive(bond_graph(nodes, "tank>c1 tank>pump"))
    assert (equations.inputs, equations.outputs) == (sp.symbols("f_pump,"), sp.symbols("e_pump,"))
    assert differences(equations.B, [[-1]]) == {}
    assert differences(equations.F, [[1]]) == {}


def test_open_port_that_gives_flow_makes_a_mass_dependent() -> None:
    nodes = [bg.Se("s", "u"), bg.One("j"), bg.I("m", "m"), bg.R("p", flow="w", gives="flow")]
    equations = bg.derive(bond_graph(nodes, "s>j j>m j>p"))
    assert (equations.states, equations.inputs) == ((), sp.symbols("u w"))
    assert differences(equations.D, [[1, 0]]) == {}
    assert differences(equations.G, [[0, -m]]) == {}


@pytest.mark.parametrize("bonds", ["j>p", "p>j"])
def test_power_counts_into_a_port_whichever_way_it_is_drawn(bonds: str) -> None:
    nodes = [bg.One("j"), bg.I("m", "m"), bg.R("p", effort="brake"), bg.R("d", "b")]
    equations = bg.derive(bond_graph(nodes, f"j>m d>j {bonds}"))
    assert differences(equations.J, [[-b]]) == {}
    assert differences(equations.B, [[-1]]) == {}
    assert differences(equations.F, [[1]]) == {}


def test_graph_without_storages_has_equations_without_states() -> None:
    """A voltage divider."""
    nodes = [bg.Se("s", "u"), bg.One("j"), bg.R("r", "r"), bg.R("b", "b")]
    equations = bg.derive(bond_graph(nodes, "s>j j>r j>b"), outputs=["j", "s"])
    assert equations.states == ()
    assert equations.A.shape == (0, 0)
    assert differences(equations.D, [[1 / (r + b)], [1 / (r + b)]]) == {}


def test_outputs_of_storages_and_resistances_are_what_they_receive() -> None:
    nodes = [
        bg.Se("s", "u"),
        bg.One("j", flow="v"),
        bg.I("m", "m"),
        bg.C("k", "1/k"),
        bg.R("b", "b"),
    ]
    names = ["k", "m", "b", "j", "s"]
    equations = bg.derive(bond_graph(nodes, "s>j j>m j>k j>b"), outputs=names)
    assert equations.outputs == sp.symbols("f_k e_m f_b v f_s")
    assert differences(equations.F, [[1, 0], [-b, -1], [1, 0], [1, 0], [1, 0]]) == {}
    assert differences(equations.D, [[0], [1], [0], [0], [0]]) == {}


def test_outputs_only_select_rows() -> None:
    nodes = [bg.One("j"), bg.I("m", "m"), bg.R("p"), bg.R("q")]
    graph = bond_graph(nodes, "j>m j>p j>q")
    every, one, none = (bg.derive(graph, outputs=o) for o in (None, ["q"], []))
    assert every.outputs == sp.symbols("f_p f_q")
    assert (one.outputs, one.F) == (every.outputs[1:], every.F[1:, :])
    assert (none.outputs, none.F.shape, none.D.shape) == ((), (0, 1), (0, 2))
    assert set(none.readings) == set(every.outputs)
    assert every.A == one.A == none.A


def test_sources_of_one_name_are_one_input() -> None:
    nodes = [bg.One("j"), bg.I("m", "m"), bg.Se("a", "u"), bg.Se("b", "u")]
    equations = bg.derive(bond_graph(nodes, "a>j b>j j>m"))
    assert equations.inputs == sp.symbols("u,")
    assert differences(equations.B, [[2]]) == {}


def test_known_sources_and_closed_ports_are_inputs_with_laws() -> None:
    nodes = [
        bg.Se("s", "F_0*sin(w*t)"), bg.One("j"), bg.I("m", "m", flow="v"),
        bg.R("brake", law=bg.DryFriction("mu"), effort="tau"), bg.R("drag", law="c*v*abs(v)"),
    ]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "s>j j>m j>brake j>drag"))
    assert equations.inputs == sp.symbols("e_s tau e_drag")
    assert equations.outputs == ()
    assert list(equations.laws) == ["s", "brake", "drag"]
    F_0, w, t, c, v = sp.symbols("F_0 w t c v")
    assert equations.laws["s"] == bg.ExpressionLaw(F_0 * sp.sin(w * t))
    assert equations.laws["brake"] == bg.DryFriction("mu")
    assert equations.laws["drag"] == bg.ExpressionLaw(c * v * sp.Abs(v))
    assert [port.element.name for port in equations.ports] == ["s", "brake", "drag"]
    assert differences(equations.B, [[1, -1, -1]]) == {}


def test_storage_with_a_law_owns_its_state() -> None:
    """A hardening spring gives e = law(q); its charge q_k has the rate that it receives."""
    nodes = [bg.One("j"), bg.I("m", "m", flow="v"), bg.C("k", law="k1*q_k + k3*q_k**3")]
    equations = bg.derive(bond_graph(nodes, "j>m j>k"), outputs=["k"])
    assert (equations.states, equations.inputs) == (sp.symbols("v,"), sp.symbols("e_k,"))
    assert equations.laws["k"].state == sp.Symbol("q_k")
    assert differences(equations.B, [[-1]]) == {}
    assert differences(equations.F, [[1]]) == {}


def test_chain_of_many_nodes_is_derived_as_a_chain() -> None:
    """Neighbours only are coupled: m v' = e_left - e_right - b v and c e' = v_left - v_right."""
    count = 600
    equations = bg.derive(chain(count))
    places = {str(state): at for at, state in enumerate(equations.states)}
    assert len(places) == 2 * count
    expected = {}
    for j in range(count):
        speed, effort = places[f"f_I{j}"], places[f"e_C{j}"]
        expected[speed, speed] = -sp.Symbol(f"b{j}")
        expected[speed, effort], expected[effort, speed] = -1, 1
        if j + 1 < count:
            after = places[f"f_I{j + 1}"]
            expected[effort, after], expected[after, effort] = -1, 1
    assert equations.J.todok() == expected
    assert equations.B.todok() == {(places["f_I0"], 0): 1}


@pytest.mark.parametrize(
    ("output", "message"),
    [
        ("nobody", "output 'nobody' is not a node"),
        ("g", "output 'g' is a TF, which has two efforts and two flows"),
        ("a-b", "output 'a-b': the junction's name makes no symbol"),
    ],
)
def test_output_that_cannot_be_shown_is_refused(output: str, message: str) -> None:
    nodes = [bg.Se("s", "u"), bg.TF("g", "n"), bg.One("a-b"), bg.I("m", "m")]
    with pytest.raises(bg.StructureError, match=message):
        bg.derive(bond_graph(nodes, "s>g>a-b>m"), outputs=[output])


def test_name_alone_is_not_a_list_of_outputs() -> None:
    graph = bond_graph([bg.One("j"), bg.I("m", "m"), bg.R("p")], "j>m j>p")
    with pytest.raises(bg.StructureError, match="outputs must be a list of nodes, not 'p'"):
        bg.derive(graph, outputs="p")
