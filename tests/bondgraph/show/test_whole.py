"""Whole equations as a textbook has them: nothing that is needed is left out, nothing stays unexplained."""

import networkx as nx
import pytest
import sympy as sp
from references.build import bond_graph
from references.latex_checks import check_latex
from references.pictured import PICTURED

import bondgraph as bg
from bondgraph.show.putting_in import closed
from bondgraph.show.statements import statements

ELECTRIC = "u>s>R s>D s>n>C n>load"


def _reaction() -> nx.DiGraph:
    """A <-> C by mass action."""
    nodes = [bg.C("A", law="RT*log(K_A*q_A)", effort="mu_A"),
             bg.C("Cc", law="RT*log(K_C*q_Cc)", effort="mu_C"), bg.Zero("zA"), bg.Zero("zC"), bg.One("f"),
             bg.R("Re", law="k*(exp(mu_A/RT) - exp(mu_C/RT))", gives="flow")]  # fmt: skip
    return bond_graph(nodes, "zA>A zC>Cc zA>f>zC f>Re")


def _drag() -> nx.DiGraph:
    nodes = [bg.Se("engine", "P/(v + v_0)"), bg.One("j"), bg.I("m", "m", flow="v"),
             bg.R("air", law="c*v*abs(v)")]  # fmt: skip
    return bond_graph(nodes, "engine>j>m j>air")


def _rectifier() -> nx.DiGraph:
    nodes = [bg.Se("u", "U*sin(w*t)"), bg.One("s"), bg.R("R", "R"), bg.Sw("D", on="e_D", off="-f_D"),
             bg.Zero("n"), bg.C("C", "C"), bg.R("load", "R_L")]  # fmt: skip
    return bond_graph(nodes, ELECTRIC)


def _sensed() -> nx.DiGraph:
    nodes = [bg.Se("tau", "tau"), bg.One("s"), bg.I("J", "J", flow="omega"), bg.R("b", "b"),
             bg.Df("angle", integrate="theta")]  # fmt: skip
    return bond_graph(nodes, "tau>s>J s>b s>angle")


def _rubbing() -> nx.DiGraph:
    nodes = [bg.Se("F", "F"), bg.One("s"), bg.I("m", "m", flow="v"),
             bg.R("mu", law=bg.DryFriction("F_c", "1 + 0.2*exp(-slip/v_s)"))]  # fmt: skip
    return bond_graph(nodes, "F>s>m s>mu")


def _diode_law() -> nx.DiGraph:
    nodes = [bg.Se("u", "u"), bg.One("s"), bg.R("R", "R"),
             bg.R("D", law="I_s*(exp(e_D/V_T) - 1)", gives="flow"), bg.Zero("n"), bg.C("C", "C")]  # fmt: skip
    return bond_graph(nodes, "u>s>R s>D s>n>C")


def _amplifier() -> nx.DiGraph:
    """An inverting one, with a capacitor and a resistance across; its output is -A times its input."""
    nodes = [bg.Se("source", "u"), bg.One("in"), bg.R("R1", "R_1"), bg.Zero("n", effort="e_n"),
             bg.One("back"), bg.Zero("pair"), bg.R("R2", "R_2"), bg.C("C", "C", effort="v_f"),
             bg.Zero("o"), bg.Se("amp", "-A*e_n")]  # fmt: skip
    return bond_graph(nodes, "source>in>R1 in>n>back>pair>R2 pair>C back>o amp>o")


REACTION = """\
  mu_A = RT*log(K_A*q_A)
  mu_C = RT*log(K_C*q_Cc)
  f_Re = k*(exp(mu_A/RT) - exp(mu_C/RT))
  q_A' = -f_Re
  q_Cc' = f_Re

with laws and sources put in
  q_A' = -k*(K_A*q_A - K_C*q_Cc)
  q_Cc' = k*(K_A*q_A - K_C*q_Cc)"""

DRAG = """\
[ m ] [v'] = [ 1  -1 ] [e_engine]
                       [   e_air]

where
  e_engine = P/(v + v_0)
  e_air = c*v*|v|

with laws and sources put in
  m*v' = P/(v + v_0) - c*v*|v|"""

SENSED = """\
[ J ] [omega'] = [ -b ] [omega] + [ 1 ] [tau]

where
  theta' = omega"""

RUBBING = """\
where
  f_mu = v
  mu: dry friction; e_mu = sign(f_mu)*F_c*(1 + exp(-|f_mu|/v_s)/5) slipping; sticking, f_mu = 0 by
    what e_mu that takes, while |e_mu| <= 6*F_c/5"""

RECTIFIER = """\
where
  e_u = U*sin(w*t)
  e_D = e_u - e_C - R*f_D
  D: an ideal switch; on, it keeps e_D = 0 by what f_D that takes, and turns off as f_D falls below
    zero; off, it gives f_D = 0, and turns on as e_D rises above zero; so e_D is never positive and
    f_D never negative"""

LOOP = """\
where
  f_D = I_s*(exp(e_D/V_T) - 1)
  e_D = u - e_C - R*f_D
  f_D and e_D follow from one another: they are solved together"""


TWO_REACTANTS = """\
  f_re_forward = kappa*(exp(e_re_forward/RT) - exp(-e_re_reverse/RT))
  f_re_reverse = kappa*(exp(e_re_forward/RT) - exp(-e_re_reverse/RT))
  q_c_A' = -f_re_forward
  q_c_B' = -f_re_forward
  q_c_C' = f_re_reverse

with laws and sources put in
  q_c_A' = -kappa*(K_A*K_B*q_c_A*q_c_B - K_C*q_c_C)
  q_c_B' = -kappa*(K_A*K_B*q_c_A*q_c_B - K_C*q_c_C)
  q_c_C' = kappa*(K_A*K_B*q_c_A*q_c_B - K_C*q_c_C)"""

AMPLIFIER = """\
where
  e_amp = -A*e_n
  e_n = v_f + e_amp
  e_amp and e_n follow from one another: they are solved together

with laws and sources put in
  C*v_f' = (A*v_f/(A + 1) + u)/R_1 - v_f*(1/R_2 + 1/R_1)"""

SERVO = """\
with laws and sources put in
  V/beta*e_chamber_A' = k*(x + x_0)*sqrt(|e_chamber_A - p_s|)*sign(p_s - e_chamber_A)
      - k*(x_0 - x)*sqrt(|e_chamber_A - p_t|)*sign(e_chamber_A - p_t) - v/S
  V/beta*e_chamber_B' = k*(x_0 - x)*sqrt(|e_chamber_B - p_s|)*sign(p_s - e_chamber_B) + v/S
      - k*(x + x_0)*sqrt(|e_chamber_B - p_t|)*sign(e_chamber_B - p_t)
  m*v' = F_L + (e_chamber_A - e_chamber_B)/S - b*v
  m_s*f_m_s' = k_p*(r - y) - b_s*f_m_s - e_spring
  e_spring'/k_s = f_m_s
  y' = v
  x' = f_m_s"""


@pytest.mark.parametrize(
    ("graph", "text"),
    [(_reaction, REACTION), (_drag, DRAG), (_sensed, SENSED), (_rubbing, RUBBING), (_rectifier, RECTIFIER),
     (_diode_law, LOOP), (PICTURED["reaction"], TWO_REACTANTS), (_amplifier, AMPLIFIER),
     (PICTURED["servo"], SERVO)],
)  # fmt: skip
def test_print_tells_the_whole_model(graph: object, text: str) -> None:
    assert str(bg.derive(graph())).endswith(text)  # type: ignore[operator]


@pytest.mark.parametrize(
    "graph", [_reaction, _drag, _sensed, _rubbing, _rectifier, _diode_law, _amplifier]
)
def test_latex_and_explanations_tell_it_too(graph: object) -> None:
    declared = graph()  # type: ignore[operator]
    equations = bg.derive(declared)
    latex, told = equations._repr_latex_(), bg.explain(declared)
    check_latex(latex, tabs=1)
    check_latex(told.latex(), tabs=3)
    rates = [f"{name}'" for name in (*equations.states, *equations.further_states)]
    assert [name for name in rates if name not in str(told)] == []
    stated = next(step for step in told.steps if step.topic == "result").equations
    assert len(stated) == len(rates) + len(equations.outputs)
    for one in statements(equations).given:
        assert sp.latex(one.left).split("_")[0] in latex


def test_a_reaction_is_told_by_the_rates_of_its_states() -> None:
    """The rates of mass action, in every view."""
    first, second, *_ = str(bg.explain(_reaction())).splitlines()
    assert first == "From a bond graph of 6 nodes and 5 bonds to the rates of 2 states"
    assert second.strip() == "2 states of laws and detectors: q_A, q_Cc"
    equations = bg.derive(_reaction())
    k, K_A, K_C, q_A, q_C = sp.symbols("k K_A K_C q_A q_Cc")
    rows = {str(one.left): one.value for one in closed(equations, statements(equations))}
    assert sp.expand(rows["q_A'"] - k * (K_C * q_C - K_A * q_A)) == 0
    assert sp.expand(rows["q_Cc'"] + rows["q_A'"]) == 0
    found = bg.explicit(equations)
    assert sp.expand(found[q_A] - k * (K_C * q_C - K_A * q_A)) == 0
    assert sp.expand(found[q_C] + found[q_A]) == 0
    right = r"\left(K_{A} q_{A} - K_{C} q_{Cc}\right)"
    for text in (equations._repr_latex_(), bg.explain(_reaction()).latex()):
        assert rf"-k {right}" in text
        assert rf"k {right}" in text.replace(rf"-k {right}", "")


def test_a_source_that_drives_a_dependent_storage_has_its_slope_put_in() -> None:
    """A voltage U sin(w t) on a capacitor takes C U w cos(w t)."""
    nodes = [bg.Se("u", "U*sin(w*t)"), bg.Zero("n"), bg.C("C", "C"), bg.One("s"), bg.R("R", "R"),
             bg.I("L", "L", flow="i")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "u>n>C n>s>R s>L"), outputs=["u"])
    rows = {str(one.left): one.value for one in closed(equations, statements(equations))}
    U, w, t, C, i = sp.symbols("U w t C i")
    assert sp.expand(rows["f_u"] - (C * U * w * sp.cos(w * t) + i)) == 0


def test_laws_stand_after_what_they_read() -> None:
    """Each valve's pressure drop before its flow, valves as they are declared."""
    found = statements(bg.derive(PICTURED["servo"]()))
    valves = [f"{letter}_valve_{at}" for at in ("PA", "PB", "AT", "BT") for letter in "ef"]
    assert [str(one.left) for one in found.given] == [*valves, "e_drive"]


def test_rows_are_written_in_the_order_of_states_and_powers_as_powers() -> None:
    """A pendulum on a cart: ``(M + m) v' + m l cos w' = F + m l w^2 sin``, Lagrange's first equation."""
    nodes = [bg.Se("force", "F"), bg.One("cart"), bg.I("M", "M", flow="v"), bg.One("turn"),
             bg.I("J", "J", flow="w"), bg.Df("angle", integrate="theta"), bg.TF("tx", "l*cos(theta)"),
             bg.Zero("sum"), bg.One("vx"), bg.I("mx", "m", priority=-1)]  # fmt: skip
    text = str(bg.derive(bond_graph(
        nodes, "force>cart>M cart>sum turn>J turn>angle turn>tx>sum>vx>mx"
    )))  # fmt: skip
    assert "(M + m)*v' + l*m*cos(theta)*w' = l*m*w^2*sin(theta) + F\n" in text
    assert "sin(theta)*w\n" not in text


def test_an_amplifier_without_a_solution_is_left_by_its_names() -> None:
    """``v_o = v_m`` leaves v_m open: nothing is put in, and nothing is raised."""
    graph = _amplifier()
    graph.nodes["amp"]["value"] = "1*e_n"
    text = str(bg.derive(graph))
    assert "e_amp = e_n\n" in text
    assert "put in" not in text


def test_tables_are_functions_in_latex() -> None:
    nodes = [bg.Se("F", "F"), bg.One("j"), bg.I("m", "m", flow="v"), bg.R("air", law="drag(v)")]
    graph = bond_graph(nodes, "F>j>m j>air")
    graph.graph["tables"] = [bg.LookupTable("drag", [0, 1, 2], [0, 1, 4])]
    assert r"e_{air} &= \operatorname{drag}\left(v\right)" in bg.derive(graph)._repr_latex_()


def test_what_is_long_is_left_under_its_name() -> None:
    law = " + ".join(f"a_{k}*f_R**{k}" for k in range(1, 80))
    nodes = [bg.One("s"), bg.I("m", "m", flow="v"), bg.R("R", law=law)]
    equations = bg.derive(bond_graph(nodes, "s>m s>R"), outputs=[])
    (row,) = closed(equations, statements(equations))
    assert row.value == -sp.Symbol("e_R")
    assert "a_79*f_R^79" in str(equations)
