"""Sub-models as functions: copies under prefixes, joined at terminals, against graphs written by hand."""

import networkx as nx
import pytest
import sympy as sp
from references.build import bond_graph

import bondgraph as bg
from bondgraph import assemble, prefixed

MATRICES = "AJBEFDG"


def _same(found: nx.DiGraph, expected: nx.DiGraph) -> bg.StateEquations:
    """Both graphs give the same equations under the same names."""
    one, other = bg.derive(found), bg.derive(expected)
    for part in ("states", "inputs", "outputs", "integrals", "laws", "parameters", *MATRICES):
        assert getattr(one, part) == getattr(other, part), part
    assert set(one.signals) == set(other.signals)
    return one


def _rlc() -> nx.DiGraph:
    """A cell of a ladder: R and L in series, C to ground; terminals ``before`` and ``after``."""
    nodes = [bg.One("loop"), bg.R("R", "R"), bg.I("L", "L", flow="i"), bg.Zero("node"),
             bg.C("C", "C", effort="u")]  # fmt: skip
    graph = bond_graph(nodes, "loop>R loop>L loop>node>C")
    graph.add_edges_from([("before", "loop"), ("node", "after")])
    return graph


def _ladder() -> nx.DiGraph:
    ends = bond_graph([bg.Se("source", "U"), bg.Zero("in"), bg.Zero("middle")], "source>in")
    load = bond_graph([bg.Zero("out"), bg.R("load", "R_L")], "out>load")
    return assemble(
        ends,
        prefixed(_rlc(), "a_", {"before": "in", "after": "middle"}),
        prefixed(_rlc(), "b_", {"before": "middle", "after": "out"}, parameters=["R"]),
        load,
    )


def test_two_cells_of_a_ladder_are_the_ladder_by_hand() -> None:
    nodes = [
        bg.Se("source", "U"), bg.Zero("in"), bg.Zero("middle"),
        bg.One("a_loop"), bg.R("a_R", "R"), bg.I("a_L", "L", flow="a_i"), bg.Zero("a_node"),
        bg.C("a_C", "C", effort="a_u"),
        bg.One("b_loop"), bg.R("b_R", "b_R"), bg.I("b_L", "L", flow="b_i"), bg.Zero("b_node"),
        bg.C("b_C", "C", effort="b_u"), bg.Zero("out"), bg.R("load", "R_L"),
    ]  # fmt: skip
    graph = bond_graph(
        nodes, "source>in in>a_loop a_loop>a_R a_loop>a_L a_loop>a_node>a_C a_node>middle "
        "middle>b_loop b_loop>b_R b_loop>b_L b_loop>b_node>b_C b_node>out out>load"
    )  # fmt: skip
    equations = _same(_ladder(), graph)
    assert [str(state) for state in equations.states] == ["a_i", "a_u", "b_i", "b_u"]
    R, b_R, R_L = sp.symbols("R b_R R_L")
    J = [[-R, -1, 0, 0], [1, 0, -1, 0], [0, 1, -b_R, -1], [0, 0, 1, -1 / R_L]]
    assert sp.Matrix(J) == equations.J
    assert sp.diag(*sp.symbols("L C L C")) == equations.A


def _quarter_car() -> nx.DiGraph:
    """A wheel on its tire carries a body by a spring whose law is nonlinear; ``road`` moves it."""
    nodes = [
        bg.Sf("road", "v_r"), bg.Zero("tire"), bg.C("k_t", "1/k_t", effort="F_t"), bg.One("wheel"),
        bg.I("m_w", "m_w", flow="v_w"), bg.Zero("strut"), bg.One("twist"),
        bg.C("spring", law="k*q_spring + c*q_spring**3"), bg.R("damper", "b*(1 + e*abs(v_w))"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "road>tire>wheel>strut>twist>spring tire>k_t wheel>m_w twist>damper")
    graph.add_edge("strut", "body")
    return graph


def _half_car(left: nx.DiGraph, right: nx.DiGraph) -> nx.DiGraph:
    body = bond_graph([bg.One("body"), bg.I("m", "m", flow="v")], "body>m")
    return assemble(body, left, right)


def test_two_quarter_cars_share_parameters_and_a_body() -> None:
    found = _half_car(*(prefixed(_quarter_car(), side, ["body"]) for side in ("l_", "r_")))
    by_hand = []
    for s in ("l_", "r_"):
        nodes = [
            bg.Sf(f"{s}road", f"{s}v_r"), bg.Zero(f"{s}tire"),
            bg.C(f"{s}k_t", "1/k_t", effort=f"{s}F_t"), bg.One(f"{s}wheel"),
            bg.I(f"{s}m_w", "m_w", flow=f"{s}v_w"), bg.Zero(f"{s}strut"), bg.One(f"{s}twist"),
            bg.C(f"{s}spring", law=f"k*q_{s}spring + c*q_{s}spring**3"),
            bg.R(f"{s}damper", f"b*(1 + e*abs({s}v_w))"),
        ]  # fmt: skip
        by_hand.append(bond_graph(nodes, f"{s}road>{s}tire>{s}wheel>{s}strut>{s}twist>{s}spring "
                                         f"{s}tire>{s}k_t {s}wheel>{s}m_w {s}twist>{s}damper"))  # fmt: skip
        by_hand[-1].add_edge(f"{s}strut", "body")
    equations = _same(found, _half_car(*by_hand))
    assert {str(name) for name in equations.parameters} == {"b", "e", "k_t", "m", "m_w"}
    law = equations.laws["l_spring"]
    assert law.state == sp.Symbol("q_l_spring")
    assert equations.varying == sp.symbols("l_v_w r_v_w")


def _motor() -> nx.DiGraph:
    nodes = [bg.Se("supply", "u"), bg.One("circuit"), bg.I("L", "L", flow="i"), bg.R("R", "R"),
             bg.GY("motor", "k")]  # fmt: skip
    graph = bond_graph(nodes, "supply>circuit>motor circuit>L circuit>R")
    graph.add_edge("motor", "shaft")
    return graph


def test_two_motors_drive_one_shaft() -> None:
    shaft = bond_graph(
        [bg.One("shaft"), bg.I("J", "J", flow="w"), bg.R("b", "b")], "shaft>J shaft>b"
    )
    motors = [prefixed(_motor(), side, ["shaft"], parameters=True) for side in ("m1_", "m2_")]
    equations = bg.derive(assemble(*motors, shaft))
    k_1, k_2, R_1, R_2, b = sp.symbols("m1_k m2_k m1_R m2_R b")
    assert equations.states == sp.symbols("m1_i m2_i w")
    assert equations.inputs == sp.symbols("m1_u m2_u")
    assert sp.Matrix([[-R_1, 0, -k_1], [0, -R_2, -k_2], [k_1, k_2, -b]]) == equations.J
    assert sp.diag(*sp.symbols("m1_L m2_L J")) == equations.A


def test_prefixes_nest() -> None:
    twice = prefixed(_ladder(), "x_", ["out"])
    assert {"x_in", "x_a_loop", "x_b_C", "out"} < set(twice)
    equations = bg.derive(twice)
    assert [str(state) for state in equations.states] == ["x_a_i", "x_a_u", "x_b_i", "x_b_u"]
    assert equations.inputs == (sp.Symbol("x_U"),)
    assert sp.Symbol("f_x_a_R") in equations.signals
    plain = bg.derive(_ladder())
    assert all(getattr(equations, name) == getattr(plain, name) for name in MATRICES)


def test_friction_keeps_its_slip_and_reads_the_new_names() -> None:
    law = bg.DryFriction("tau_h + mu*v", "1 + 0.2*exp(-slip/v_0) + slip*f_mass**2", "1.3 + v**2")
    nodes = [bg.One("mass"), bg.I("m", "m", flow="v"), bg.R("drag", law=law, flow="slip")]
    found = prefixed(bond_graph(nodes, "mass>m mass>drag"), "left_", parameters=["v_0"])
    expected = bg.DryFriction(
        "tau_h + mu*left_v", "1 + 0.2*exp(-slip/left_v_0) + slip*f_left_mass**2", "1.3 + left_v**2"
    )
    assert found.nodes["left_drag"] == {"kind": "R", "law": expected, "flow": "left_slip"}
    assert bg.derive(found).laws == {"left_drag": expected}


def test_modulated_values_and_integrals() -> None:
    nodes = [bg.Se("drive", "tau"), bg.One("rot"), bg.I("J", "J", flow="omega"),
             bg.Df("angle", integrate="theta"), bg.TF("crank", "r*cos(theta)"), bg.One("slider"),
             bg.I("m", "m", priority=-1)]  # fmt: skip
    equations = bg.derive(
        prefixed(bond_graph(nodes, "drive>rot>J rot>angle rot>crank>slider>m"), "a_")
    )
    theta, r, m, J = sp.symbols("a_theta r m J")
    assert equations.integrals == {theta: sp.Symbol("f_a_angle")}
    assert sp.simplify(equations.A[0] - J - m * r**2 * sp.cos(theta) ** 2) == 0


def test_values_of_every_form_are_rewritten_by_symbols() -> None:
    """``ab`` holds the letters of ``a`` and ``b`` and stays; assumptions of parameters stay."""
    k = sp.Symbol("k", positive=True)
    ready = bg.ExpressionLaw(k * sp.Symbol("p_m") + sp.Symbol("ab"), sp.Symbol("p_m"))
    nodes = [bg.One("a"), bg.I("m", law=ready), bg.R("r", 0.5), bg.R("s", "ab*f_a"),
             bg.R("t", sp.Symbol("f_a") ** 2 * k), bg.Se("w", "-m*g*sin(t)")]  # fmt: skip
    graph = prefixed(bond_graph(nodes, "w>a>m a>r a>s a>t"), "b_", parameters=["k"])
    f, p = sp.symbols("f_b_a p_b_m")
    positive = sp.Symbol("b_k", positive=True)
    assert graph.nodes["b_m"]["law"] == bg.ExpressionLaw(positive * p + sp.Symbol("ab"), p)
    assert [graph.nodes[f"b_{name}"]["value"] for name in "rst"] == [
        0.5, sp.Symbol("ab") * f, f**2 * positive,
    ]  # fmt: skip
    assert graph.nodes["b_w"]["value"] == "-m*g*sin(t)"
    bg.derive(graph)


def test_default_names_follow_nodes_and_equal_names_stay_equal() -> None:
    """One name by default and by declaration stays one; numbers are names of nodes too."""
    nodes = [bg.One("a"), bg.I("m", 1, flow="f_a"), bg.R(7, "f_7 + f_a"), bg.Zero("no name")]
    graph = bond_graph(nodes, "a>m")
    graph.add_edges_from([("a", 7), ("a", "no name")])
    found = prefixed(graph, "n_")
    assert list(found) == ["n_a", "n_m", "n_7", "n_no name"]
    assert found.nodes["n_m"]["flow"] == "f_n_a"
    assert found.nodes["n_7"]["value"] == sp.Symbol("f_n_7") + sp.Symbol("f_n_a")


def test_a_kept_terminal_keeps_what_it_names() -> None:
    nodes = [bg.One("hub", flow="w"), bg.I("J", "J", flow="w"), bg.R("drag", "c*abs(w)*e_J")]
    graph = bond_graph(nodes, "hub>J hub>drag")
    assert prefixed(graph, "x_", ["hub"]).nodes["x_J"]["flow"] == "w"
    assert prefixed(graph, "x_", {"hub": "axle"}).nodes["axle"] == {"kind": "One", "flow": "w"}
    bare = bond_graph([bg.R("drag", "c*abs(f_hub)")], "")
    bare.add_edge("hub", "drag")
    value = prefixed(bare, "x_", {"hub": "axle"}).nodes["x_drag"]["value"]
    assert value == sp.Symbol("c") * sp.Abs(sp.Symbol("f_axle"))


def test_fields_and_energies_carry_the_prefix_and_ports_stay() -> None:
    nodes = [
        bg.One("a"), bg.One("b"), bg.I("M", sp.Matrix([["m", "n"], ["n", "m"]]), ports=["x", "y"],
                                       flow={"x": "v"}),
        bg.C("K", energy="k*(q_K_x - q_K_y)**2 + k*q_K_x**4", ports=["x", "y"]),
        bg.R("D", [["d*abs(v)", "e"], ["e", "d"]], ports=["x", "y"]),
    ]  # fmt: skip
    graph = bond_graph(nodes, "")
    for tail, port in (("a", "x"), ("b", "y")):
        for head in "MKD":
            graph.add_edge(tail, head, port=port)
    found = prefixed(graph, "l_", parameters=["d"])
    equations, plain = bg.derive(found), bg.derive(graph)
    assert equations.states == sp.symbols("l_v f_l_M_y")
    new = {sp.Symbol(old): sp.Symbol(name) for old, name in (
        ("v", "l_v"), ("f_M_y", "f_l_M_y"), ("d", "l_d"), ("q_K_x", "q_l_K_x"), ("q_K_y", "q_l_K_y"),
    )}  # fmt: skip
    assert plain.J.xreplace(new) == equations.J
    assert plain.A == equations.A
    for port in ("K.x", "K.y"):
        law = plain.laws[port]
        renamed = bg.ExpressionLaw(law.expression.xreplace(new), law.state.xreplace(new))
        assert equations.laws[port.replace("K", "l_K")] == renamed


def test_the_time_is_nobodys_parameter() -> None:
    graph = bond_graph([bg.Se("s", "U*sin(t)"), bg.One("j"), bg.R("r", "r*(1 + t)")], "s>j>r")
    found = prefixed(graph, "a_", parameters=True)
    t = sp.Symbol("t")
    assert found.nodes["a_s"]["value"] == sp.Symbol("a_U") * sp.sin(t)
    assert found.nodes["a_r"]["value"] == sp.Symbol("a_r") * (1 + t)


def test_the_part_itself_stays_as_it_was() -> None:
    graph = _quarter_car()
    before = nx.DiGraph(graph)
    prefixed(graph, "l_", parameters=True)
    assert nx.utils.graphs_equal(graph, before)


@pytest.mark.parametrize("prefix", ["", "1_", "left-", "a b", 3, None])
def test_a_prefix_makes_identifiers(prefix: object) -> None:
    with pytest.raises(bg.StructureError, match=r"prefix .* makes no identifiers"):
        prefixed(_rlc(), prefix)


def test_names_that_the_part_has_not_are_refused() -> None:
    with pytest.raises(bg.StructureError, match="keep: 'bfore' is not a node of the part"):
        prefixed(_rlc(), "a_", ["bfore"])
    with pytest.raises(bg.StructureError, match="keep must be a list of nodes"):
        prefixed(_rlc(), "a_", "before")
    with pytest.raises(
        bg.StructureError, match="'i' is not a parameter of the part; there are C, L, R"
    ):
        prefixed(_rlc(), "a_", parameters=["i"])
    with pytest.raises(bg.StructureError, match="parameters must be True, False or a list"):
        prefixed(_rlc(), "a_", parameters="R")
    with pytest.raises(bg.StructureError, match="kind 'Q'; there are"):
        prefixed(bond_graph([("q", {"kind": "Q"})], ""), "a_")
    with pytest.raises(bg.StructureError, match=r"a part is a networkx.DiGraph, not a Graph"):
        prefixed(nx.Graph(), "a_")


def test_collisions_are_refused() -> None:
    with pytest.raises(bg.StructureError, match="'before' and 'after' would both be called 'x'"):
        prefixed(_rlc(), "a_", {"before": "x", "after": "x"})
    with pytest.raises(
        bg.StructureError, match="'loop' and 'before' would both be called 'a_loop'"
    ):
        prefixed(_rlc(), "a_", {"before": "a_loop"})
    nodes = [bg.One("j"), bg.I("m", "m", flow="v"), bg.R("r", "a_v")]
    with pytest.raises(bg.StructureError, match="'a_v' and 'v' would both be called 'a_v'"):
        prefixed(bond_graph(nodes, "j>m j>r"), "a_")
    nodes = [bg.One("j"), bg.I("m", "m", flow="ip"), bg.R("r", law=bg.DryFriction("h"))]
    with pytest.raises(bg.StructureError, match="'slip' and 'ip' would both be called 'slip'"):
        prefixed(bond_graph(nodes, "j>m j>r"), "sl")
    nodes = [bg.One("j"), bg.I("m", "m", flow="mbda"), bg.R("r", "r")]
    with pytest.raises(bg.StructureError, match="'lambda' cannot be a symbol"):
        prefixed(bond_graph(nodes, "j>m j>r"), "la")


def test_one_prefix_twice_is_refused_by_assemble() -> None:
    copy = prefixed(_rlc(), "a_", ["before", "after"])
    with pytest.raises(bg.StructureError, match="two parts declare the bond 'a_loop' -> 'a_R'"):
        assemble(copy, copy)
