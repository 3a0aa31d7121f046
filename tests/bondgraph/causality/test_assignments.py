"""Causal-order assignments: textbook lines by hand, and put in one after the other they are the readings."""

import random
import time
from collections.abc import Mapping
from itertools import groupby

import networkx as nx
import pytest
import sympy as sp
from references.alsd import alsd_graph
from references.build import Graph, bond_graph
from references.random_graphs import chain, random_graph
from references.random_switches import random_switched
from soak.families import seeds

import bondgraph as bg
from bondgraph.reduce.record import Reading

REFUSALS = (bg.CausalityError, bg.AlgebraicLoopError)


def _text(graph: Graph) -> list[str]:
    return [f"{line.kind} {line.symbol} = {line.right}" for line in bg.assignments(graph)]


def test_series_rlc() -> None:
    nodes = [bg.Se("source", "U"), bg.One("loop"), bg.I("L", "L", flow="i"),
             bg.C("C", "C", effort="u"), bg.R("R", "R")]  # fmt: skip
    assert _text(bond_graph(nodes, "source>loop>L loop>C loop>R")) == [
        "given U = U",
        "given i = i",
        "given u = u",
        "transfer f_source = i",
        "transfer f_C = i",
        "transfer f_R = i",
        "law e_R = R*f_R",
        "balance e_L = U - e_R - u",
    ]


def test_dc_motor() -> None:
    nodes = [bg.Se("supply", "u"), bg.One("circuit"), bg.I("L", "L", flow="i"), bg.R("R", "R"),
             bg.GY("motor", "k"), bg.One("shaft"), bg.I("J", "J", flow="w"), bg.R("b", "b")]  # fmt: skip
    graph = bond_graph(nodes, "supply>circuit>motor>shaft>J circuit>L circuit>R shaft>b")
    assert _text(graph) == [
        "given u = u",
        "given i = i",
        "given w = w",
        "transfer f_supply = i",
        "transfer f_circuit_motor = i",
        "transfer f_R = i",
        "transfer f_motor_shaft = w",
        "transfer f_b = w",
        "transfer e_motor_shaft = f_circuit_motor*k",
        "law e_R = R*f_R",
        "transfer e_circuit_motor = f_motor_shaft*k",
        "law e_b = b*f_b",
        "balance e_L = -e_R - e_circuit_motor + u",
        "balance e_J = -e_b + e_motor_shaft",
    ]


def test_the_alsd_has_its_input_inertia_as_a_rate() -> None:
    lines = {str(line.symbol): line for line in bg.assignments(alsd_graph())}
    expected = {
        "tau_e": "tau_e", "omega_1": "omega_1", "tau_t1": "tau_t1", "omega_2": "omega_2",
        "tau_t2": "tau_t2", "tau_f": "tau_f", "f_sum_left": "omega_1", "omega_t1": "omega_1",
        "f_sum_right": "omega_2", "omega_t2": "omega_2", "f_slip_right": "omega_2",
        "e_case_slip": "tau_f", "e_slip_right": "tau_f",
        "f_halves_sum": "f_sum_left + f_sum_right", "f_case": "f_halves_sum/2",
        "f_final_drive_case": "f_case", "f_case_slip": "f_case",
        "f_input": "f_final_drive_case*i", "omega_f": "f_case_slip - f_slip_right",
        "f_engine": "f_input", "f_I_i": "f_input", "e_I_i": "I_i*f_I_i",
        "e_input_final_drive": "-e_I_i + tau_e", "e_final_drive_case": "e_input_final_drive*i",
        "e_case_halves": "-e_case_slip + e_final_drive_case", "e_sum": "e_case_halves/2",
        "e_sum_left": "e_sum", "e_sum_right": "e_sum", "e_I_w1": "e_sum_left - tau_t1",
        "e_I_w2": "e_slip_right + e_sum_right - tau_t2",
    }  # fmt: skip
    assert {name: str(line.right) for name, line in lines.items()} == expected
    assert [name for name, line in lines.items() if line.kind == "rate"] == ["e_I_i"]
    rate, slip = lines["e_I_i"], lines["omega_f"]
    assert (rate.variable, rate.bond, rate.node) == ("effort", ("input", "I_i"), "I_i")
    assert (slip.variable, slip.bond, slip.node) == ("flow", ("slip", "clutch"), "slip")


def test_a_nonlinear_storage_that_is_dependent_is_the_rate_of_its_inverse_law() -> None:
    """A relativistic mass behind a lever: its momentum is m v/sqrt(1 - v^2/c^2)."""
    law, inverse = "p_fast/sqrt(m**2 + p_fast**2/c**2)", "m*f_fast/sqrt(1 - f_fast**2/c**2)"
    nodes = [bg.Se("T", "T"), bg.One("a"), bg.I("J", "J", flow="w", priority=1), bg.TF("lever", "n"),
             bg.I("fast", law=law, inverse=inverse)]  # fmt: skip
    for bonds in ("T>a>J a>lever>fast", "T>a>J fast>lever>a"):
        (rate,) = (line for line in bg.assignments(bond_graph(nodes, bonds)) if line.kind == "rate")
        m, c, v = sp.symbols("m c f_fast")
        momentum = m * v / sp.sqrt(1 - v**2 / c**2)
        # The bond's effort is the element's negative where the element is its tail.
        assert rate.right == (momentum if rate.bond[1] == "fast" else -momentum)


def test_a_loop_is_one_group() -> None:
    """Two resistances in series with a source: e_r = r f_r, f_p = e_p/p and the junction in a loop."""
    nodes = [bg.Se("s", "U"), bg.One("a"), bg.R("r", "r"), bg.R("p", "p")]
    lines = bg.assignments(bond_graph(nodes, "s>a>r a>p"))
    assert [(line.group, f"{line.kind} {line.symbol} = {line.right}") for line in lines] == [
        (0, "given U = U"),
        (1, "law e_r = f_r*r"),
        (1, "transfer f_r = f_p"),
        (1, "balance e_p = U - e_r"),
        (1, "law f_p = e_p/p"),
        (2, "transfer f_s = f_p"),
    ]


def test_power_that_counts_against_an_arrow_turns_the_effort() -> None:
    """A spring that is the tail of a bond into a transformer: the effort is the negative of its own."""
    nodes = [bg.C("c", "c", effort="F"), bg.TF("lever", "m"), bg.One("j"), bg.I("m_1", "m_1"),
             bg.R("r", "r")]  # fmt: skip
    lines = {
        str(line.symbol): line for line in bg.assignments(bond_graph(nodes, "c>lever>j>m_1 j>r"))
    }
    assert str(lines["e_c_lever"].right) == "-F"
    assert "F" not in lines
    assert lines["f_c"].bond == ("c", "lever")


def test_symbols_are_identifiers_that_clash_with_nothing() -> None:
    """One flow called ``w`` thrice is one symbol only; made names avoid parameters and each other."""
    nodes = [bg.Se(1, "u"), bg.One("a b", flow="w"), bg.I("m", "e_a_b_x", flow="w"), bg.GY("x", "k"),
             bg.Zero("a_b"), bg.C("c", "c"), bg.R("r", "r", flow="w"), bg.GY("y", "k")]  # fmt: skip
    graph = bond_graph(nodes, "a_b>c a_b>y")
    graph.add_edges_from([(1, "a b"), ("a b", "m"), ("a b", "x"), ("x", "a_b"), ("a b", "r")])
    graph.add_nodes_from([bg.Zero("z"), bg.C("k_z", "k_z")])
    graph.add_edges_from([("y", "z"), ("z", "k_z")])
    lines = bg.assignments(graph)
    names = [line.symbol.name for line in lines]
    assert len(set(names)) == len(names) == 2 * graph.number_of_edges()
    assert all(name.isidentifier() for name in names)
    assert "e_a_b_x" not in names
    assert "e_a_b_x_2" in names
    assert names.count("w") == 1


def test_values_read_signals_that_come_before() -> None:
    """The ratio follows ``fast``, the far shaft's flow, which is three times omega."""
    nodes = [bg.Se("drive", "tau"), bg.One("rot"), bg.I("J", "J", flow="omega"),
             bg.Df("angle", integrate="theta"), bg.TF("crank", "c*fast*cos(theta)"), bg.One("slider"),
             bg.I("m", "m", priority=-1), bg.TF("gear", 3), bg.One("far", flow="fast"),
             bg.I("n", "n", priority=-1)]  # fmt: skip
    graph = bond_graph(nodes, "drive>rot>J rot>angle rot>crank>slider>m rot>gear>far>n")
    lines = {str(line.symbol): line for line in bg.assignments(graph)}
    assert str(lines["f_slider"].right) == "c*f_rot_crank*fast*cos(theta)"
    assert str(lines["fast"].right) == "3*f_rot_gear"
    assert lines["fast"].group < lines["f_slider"].group
    assert lines["e_angle"].right == 0
    assert lines["e_m"].kind == "rate"


def test_a_causal_graph_will_do_and_refusals_pass_on() -> None:
    assert bg.assignments(bg.assign_causality(alsd_graph())) == bg.assignments(alsd_graph())
    with pytest.raises(bg.StructureError, match="the graph has no nodes"):
        bg.assignments(nx.DiGraph())


Known = dict[tuple[tuple[object, object], str], sp.Expr]


def _put_in(lines: tuple[bg.Assignment, ...], dots: Mapping[sp.Symbol, sp.Symbol]) -> Known:
    """Every signal over states, inputs and their rates, line by line; loops are solved.

    In a loop a rate is an unknown of its own until the rest is known: what it differentiates must not
    depend on it.
    """
    known: dict[sp.Symbol, sp.Expr] = {}
    result: Known = {}
    for _, group in groupby(lines, key=lambda line: line.group):
        members = list(group)
        if len(members) == 1 and members[0].symbol not in members[0].right.free_symbols:
            solved = {members[0].symbol: members[0].right.xreplace(known)}
        else:
            solved = _loop_solved(members, known)
        rates = {line.symbol: line for line in members if line.kind == "rate"}
        for name, line in rates.items():
            stored = (
                line.right.xreplace(known).xreplace(solved) if len(members) > 1 else solved[name]
            )
            stored = sp.expand(sp.cancel(stored))
            assert not stored.free_symbols & rates.keys() - dots.keys()
            solved[name] = stored.xreplace(dict(dots))
        for line in members:
            value = solved[line.symbol].xreplace({name: solved[name] for name in rates})
            result[line.bond, line.variable] = value
            known[line.symbol] = value
    return result


def _loop_solved(
    members: list[bg.Assignment], known: Mapping[sp.Symbol, sp.Expr]
) -> dict[sp.Symbol, sp.Expr]:
    unknown = [line.symbol for line in members if line.kind != "rate"]
    equations = [line.symbol - line.right.xreplace(dict(known)) for line in members
                 if line.kind != "rate"]  # fmt: skip
    (values,) = sp.linsolve(equations, unknown)
    return dict(zip(unknown, values, strict=True))


def _expression(reading: Reading, columns: tuple[list[sp.Symbol], ...]) -> sp.Expr:
    rows = zip(reading.parts, columns, strict=True)
    return sp.Add(*(entry * names[j] for row, names in rows for j, entry in row.items()))


def _check(graph: Graph, derived: bg.StateEquations | None = None) -> None:
    equations = derived or bg.derive(graph)
    lines = bg.assignments(graph)
    controlled = sum(
        "on" in data for _, data in graph.nodes(data=True) if data["kind"] in ("Zero", "One")
    )
    assert len(lines) == 2 * (graph.number_of_edges() + controlled)
    assert len({line.symbol for line in lines}) == len(lines)
    _check_order(lines, {*equations.states, *equations.inputs})
    dots = {name: sp.Symbol(f"rate of {name}") for name in (*equations.states, *equations.inputs)}
    x, u = list(equations.states), list(equations.inputs)
    columns = (x, u, [dots[name] for name in x], [dots[name] for name in u])
    found = _put_in(lines, dots)
    for bond in graph.edges:
        for variable, reading in zip(("effort", "flow"), equations.bond(*bond), strict=True):
            difference = found[bond, variable] - _expression(reading, columns)
            assert sp.cancel(sp.expand(difference)) == 0, (bond, variable)


def _check_order(lines: tuple[bg.Assignment, ...], base: set[sp.Symbol]) -> None:
    """Right sides hold earlier signals, those of their own loop, and states and inputs."""
    group = {line.symbol: line.group for line in lines}
    assert sorted(group.values()) == list(group.values())
    for line in lines:
        for name in line.right.free_symbols & group.keys() - base:
            alone = list(group.values()).count(line.group) == 1
            assert group[name] < line.group or (group[name] == line.group and not alone)


def _numeric(seed: int) -> Graph:
    rng = random.Random(seed)
    return random_graph(rng, rng.randint(3, 25), mesh=0.4, symbols=False)


def _symbolic(seed: int) -> Graph:
    rng = random.Random(seed)
    return random_graph(rng, rng.randint(3, 10), mesh=0.3)


def _accepted(graph: Graph) -> bg.StateEquations | None:
    try:
        return bg.derive(graph)
    except (*REFUSALS, bg.SingularStorageError):
        return None


def test_laws_detectors_and_moving_values_are_the_readings() -> None:
    nodes = [bg.Se("field", "u_f*sin(t)"), bg.One("coil"), bg.I("L_f", "L_f", flow="i_f"),
             bg.R("R_f", "R_f"), bg.Sf("armature", "i_a"), bg.Df("meter", integrate="charge"),
             bg.One("loop"), bg.GY("motor", "K*i_f"), bg.One("shaft"), bg.C("twist", law="k*q_twist**3"),
             bg.I("J", "J", flow="w"), bg.R("air", "c*abs(w)"), bg.R("brake", law=bg.DryFriction("h")),
             bg.Zero("end"), bg.De("gauge"), bg.R("leak", "r + charge")]  # fmt: skip
    bonds = "field>coil>L_f coil>R_f armature>loop>motor>shaft>J loop>meter shaft>air shaft>brake"
    _check(bond_graph(nodes, f"{bonds} shaft>end>leak end>gauge shaft>twist"))


def test_fields_are_the_readings() -> None:
    """A field of resistances that gives an effort and a flow; one of inertias with a dependent port."""
    nodes = [bg.Se("s", "u"), bg.One("a"), bg.Zero("b"), bg.C("c", "c"), bg.One("d"), bg.Sf("v", "v"),
             bg.R("D", [["d1", "d12"], ["d21", "d2"]], ports=["x", "y"]),
             bg.I("M", [["m1", "m12"], ["m12", "m2"]], ports=["x", "y"])]  # fmt: skip
    graph = bond_graph(nodes, "s>a b>c v>d")
    for tail, head, port in (("a", "D", "x"), ("b", "D", "y"), ("a", "M", "x"), ("d", "M", "y")):
        graph.add_edge(tail, head, port=port)
    lines = {str(line.symbol): line for line in bg.assignments(graph)}
    assert lines["f_D_y"].kind == "law"
    assert sp.simplify(lines["f_D_y"].right - sp.sympify("(e_D_y - d21*f_D_x)/d2")) == 0
    assert (lines["e_M_y"].kind, lines["e_M_y"].node) == ("rate", "M")
    assert str(lines["e_M_y"].right) == "f_M_x*m12 + f_M_y*m2"
    _check(graph)


@pytest.mark.parametrize("seed", seeds("assignments"))
def test_put_in_one_after_the_other_they_are_the_readings(seed: int) -> None:
    if derived := _accepted(graph := _numeric(seed)):
        _check(graph, derived)


@pytest.mark.parametrize("seed", range(15))
def test_the_same_with_switches(seed: int) -> None:
    if derived := _accepted(graph := random_switched(seed)):
        _check(graph, derived)


@pytest.mark.parametrize("seed", seeds("assignments-in-symbols"))
def test_the_same_with_symbols(seed: int) -> None:
    if derived := _accepted(graph := _symbolic(seed)):
        _check(graph, derived)


def test_random_graphs_are_of_all_sorts() -> None:
    """Of the graphs above most are accepted; loops and rates are among them."""
    graphs = [graph for seed in range(120) if _accepted(graph := _numeric(seed))]
    looped = rated = 0
    for graph in graphs:
        lines = bg.assignments(graph)
        looped += lines[-1].group + 1 < len(lines)
        rated += any(line.kind == "rate" for line in lines)
    assert len(graphs) > 60
    assert 15 < looped < len(graphs) - 15
    assert rated > 15


def test_long_chains_take_time_in_proportion() -> None:
    """Printed, not asserted: seconds for chains of up to 2 000 storages."""
    for n in (250, 1000):
        causal = bg.assign_causality(chain(n))
        start = time.perf_counter()
        lines = bg.assignments(causal)
        print(f"{2 * n} storages: {time.perf_counter() - start:.2f} s")  # noqa: T201
        assert len(lines) == 10 * n
        assert lines[-1].group == len(lines) - 1
