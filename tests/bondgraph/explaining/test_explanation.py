"""Derivations put into themselves: what they state first gives what they state last, and that is derived."""

import random
from functools import cache

import networkx as nx
import pytest
import sympy as sp
from references.build import bond_graph
from references.derivations import Reader, explained, result_rows, solved_rates, vanishes
from references.random_graphs import random_graph

import bondgraph as bg
import differentials


def _ladder() -> nx.DiGraph:
    nodes = [bg.Se("u", "U"), bg.One("w"), bg.R("R_1", "R_1"), bg.Zero("n"), bg.R("R_2", "R_2"),
             bg.One("b"), bg.R("R_3", "R_3"), bg.C("c", "C", effort="v")]  # fmt: skip
    return bond_graph(nodes, "u>w>R_1 w>n>R_2 n>b>R_3 b>c")


def _tanks() -> nx.DiGraph:
    """Two tanks joined by a long pipe; a pump, and an outlet."""
    nodes = [bg.Sf("pump", "Q_in"), bg.Zero("p_1"), bg.C("tank_1", "A_1/(rho*g)", effort="P_1"),
             bg.One("pipe"), bg.I("water", "rho*L/a", flow="Q"), bg.R("wall", "R_w"), bg.Zero("p_2"),
             bg.C("tank_2", "A_2/(rho*g)", effort="P_2"), bg.R("outlet", effort="P_o", gives="flow",
             flow="Q_o")]  # fmt: skip
    return bond_graph(nodes, "pump>p_1>tank_1 p_1>pipe>water pipe>wall pipe>p_2>tank_2 p_2>outlet")


def _crank() -> nx.DiGraph:
    nodes = [bg.Se("drive", "tau"), bg.One("shaft"), bg.I("J", "J", flow="omega"),
             bg.Df("angle", integrate="theta"), bg.TF("yoke", "r*sin(theta)"), bg.One("slider"),
             bg.I("m", "m", priority=-1), bg.R("rod", effort="F_r")]  # fmt: skip
    return bond_graph(nodes, "drive>shaft>J shaft>angle shaft>yoke>slider>m slider>rod")


def _ring() -> nx.DiGraph:
    nodes = [bg.One("p"), bg.One("q"), bg.TF("one", "n"), bg.TF("two", "k"), bg.I("m", "m"),
             bg.Se("F", "F")]  # fmt: skip
    return bond_graph(nodes, "p>one>q>two>p p>m F>q")


def _motor() -> nx.DiGraph:
    """A motor whose armature has no inductance, on a geared load drawn with arrows turned round."""
    nodes = [bg.Se("supply", "u"), bg.One("wire"), bg.R("R_a", "R_a"), bg.GY("motor", "K"),
             bg.One("shaft"), bg.I("J_1", "J_1", flow="omega"), bg.TF("gear", "n"),
             bg.I("J_2", "J_2")]  # fmt: skip
    return bond_graph(nodes, "supply>wire>R_a wire>motor>shaft>gear>J_2 J_1>shaft")


def _tail() -> nx.DiGraph:
    """A storage that is the tail of its bond to a transformer."""
    nodes = [bg.I("J_2", "J_2", priority=-1), bg.TF("gear", "n"), bg.One("shaft"),
             bg.I("J_1", "J_1", flow="omega"), bg.Se("drive", "tau")]  # fmt: skip
    return bond_graph(nodes, "J_2>gear>shaft>J_1 drive>shaft")


def _driven() -> nx.DiGraph:
    """A source that rules a capacitor, and with another a second one: E is not zero."""
    nodes = [bg.Se("u", "U"), bg.Zero("n"), bg.C("c", "C"), bg.One("w"), bg.R("R", "R"),
             bg.C("c_2", "C_2", effort="v"), bg.C("c_3", "C_3")]  # fmt: skip
    return bond_graph(nodes, "u>n>c n>w>R w>c_2 w>c_3")


def _divider() -> nx.DiGraph:
    nodes = [bg.Se("s", "V"), bg.One("n"), bg.Zero("z"), bg.R("r", "R"), bg.C("a", "C_1"),
             bg.C("b", "C_2", effort="v", priority=1)]  # fmt: skip
    return bond_graph(nodes, "s>n>a n>z>b z>r")


def _coupled() -> nx.DiGraph:
    """Coupled coils, of which one is ruled by a third coil's current."""
    graph: nx.DiGraph = nx.DiGraph()
    graph.add_nodes_from([
        bg.Se("u", "U"), bg.One("w"), bg.I("L", "L", flow="i", priority=1), bg.Se("u_2", "U_2"),
        bg.I("coils", [["L_1", "M"], ["M", "L_2"]], ports=["a", "b"]), bg.One("w_2"),
    ])  # fmt: skip
    graph.add_edges_from([("u", "w"), ("w", "L"), ("u_2", "w_2")])
    graph.add_edge("w", "coils", port="a")
    graph.add_edge("w_2", "coils", port="b")
    return graph


def _moving_inertia() -> nx.DiGraph:
    """An inertia that depends on the angle of its own shaft."""
    nodes = [bg.Se("drive", "tau"), bg.One("shaft"), bg.I("J", "J + m*cos(theta)**2", flow="omega"),
             bg.Df("angle", integrate="theta")]  # fmt: skip
    return bond_graph(nodes, "drive>shaft>J shaft>angle")


def _relativistic() -> nx.DiGraph:
    """A mass whose momentum is no multiple of its speed, ruled through a lever."""
    law, inverse = "p_fast/sqrt(m**2 + p_fast**2/c**2)", "m*f_fast/sqrt(1 - f_fast**2/c**2)"
    nodes = [bg.Se("T", "T"), bg.One("a"), bg.I("J", "J", flow="w", priority=1), bg.TF("lever", "n"),
             bg.One("b"), bg.I("fast", law=law, inverse=inverse)]  # fmt: skip
    return bond_graph(nodes, "T>a>J a>lever>b>fast")


def _two_inputs_of_one_name() -> nx.DiGraph:
    nodes = [bg.Se("left", "F"), bg.One("a"), bg.I("m", "m", flow="v"), bg.C("k", "1/k"), bg.One("b"),
             bg.I("M", "M", flow="V"), bg.Se("right", "F"), bg.Zero("between")]  # fmt: skip
    return bond_graph(nodes, "left>a>m a>between>b between>k b>M right>b")


def _boost() -> nx.DiGraph:
    """A coil charged by a transistor, which a diode hands to a capacitor; a second diode across that."""
    nodes = [bg.Se("s", "E"), bg.One("l"), bg.I("L", "L", flow="i"), bg.R("r", "R_L"), bg.Zero("n"),
             bg.Sw("q", on="gate"), bg.One("w"), bg.Diode("d"), bg.Zero("o"), bg.C("c", "C", effort="v"),
             bg.R("load", "R"), bg.Diode("clamp")]  # fmt: skip
    return bond_graph(nodes, "s>l>L l>r l>n>q n>w>d w>o>c o>load o>clamp")


GRAPHS = {
    "boost": _boost,
    "ladder": _ladder, "tanks": _tanks, "crank": _crank, "ring": _ring, "motor": _motor, "tail": _tail,
    "driven": _driven, "divider": _divider, "coupled": _coupled, "moving inertia": _moving_inertia,
    "relativistic": _relativistic, "one input twice": _two_inputs_of_one_name,
}  # fmt: skip
SEEDS = (18, 28, 31, 32, 34, 38)
GRAPHS |= {
    f"{name}{', full' if full else ''}": lambda name=name, full=full: differentials.graph(
        name, full
    )
    for name, model in differentials.catalog.items()
    for full in ((False, True) if model.full else (False,))
}
GRAPHS |= {
    f"random {seed}": lambda seed=seed: random_graph(random.Random(seed), 9, mesh=0.5)
    for seed in SEEDS
}
GRAPHS["alsd, not lumped"] = lambda: differentials.graph("alsd", lumped=False)


@cache
def _told(name: str) -> tuple[bg.Explanation, Reader]:
    made = explained(name) if name in differentials.catalog else bg.explain(GRAPHS[name]())
    return made, Reader(made)


@pytest.fixture(params=GRAPHS)
def name(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture
def explanation(name: str) -> bg.Explanation:
    return _told(name)[0]


@pytest.fixture
def reader(name: str) -> Reader:
    return _told(name)[1]


def test_what_ports_receive_follows_from_the_junctions(reader: Reader) -> None:
    received = reader.equations("received")
    assert received
    for one in [*received, *reader.equations("loops")]:
        given = one.right.xreplace(reader.detected)
        assert vanishes(one.left.xreplace(reader.signals).xreplace(reader.detected) - given), one


def test_resistances_give_what_their_laws_say(reader: Reader) -> None:
    solved = reader.equations("resistances")
    laws = [one for one in reader.equations("laws") if one.right != 0]
    assert len(solved) == len(laws)
    for one in laws:
        assert vanishes(reader.value(one.left) - reader.value(one.right)), one


def test_storages_with_everything_put_in_are_the_result(
    explanation: bg.Explanation, reader: Reader
) -> None:
    """Every storage's law holds: of dependent ones identically, of states as the rows of A, J, B, E."""
    left = [rate - reader.value(effect) for rate, effect in reader.storages()]
    rows = [row for row in left if not vanishes(row)]
    expected = result_rows(explanation.result)[: len(explanation.result.states)]
    assert len(left) == len(rows) + len(explanation.result.reduction.dependent)
    assert all(vanishes(row - want) for row, want in zip(rows, expected, strict=True))


def test_outputs_are_the_results_with_rates_put_in(reader: Reader) -> None:
    _check_outputs(reader)


def _check_outputs(reader: Reader) -> set[sp.Symbol]:
    """Every output over states and inputs; the rates of states that were put in for that."""
    result = reader.result
    rates = {sp.Symbol(f"{name}'") for name in result.states}
    used: set[sp.Symbol] = set()
    rows = result_rows(result)
    lower = rows[len(rows) - len(result.outputs) :]
    for name, row in zip(result.outputs, lower, strict=True):
        value = reader.value(name)
        if value.free_symbols & rates:
            used |= value.free_symbols & rates
            value = value.xreplace(solved_rates(result))
        assert vanishes(value - (name - row))
    return used


def test_a_torque_behind_a_dependent_inertia_has_rates_put_in() -> None:
    explanation = bg.explain(differentials.graph("passive"), outputs=["bevel_torque", "input"])
    assert _check_outputs(Reader(explanation)) == {*sp.symbols("omega_1' omega_2'")}


def test_every_side_of_every_equation_is_equal(reader: Reader) -> None:
    held = {one.left: one.right for one in reader.equations("storages")}
    for topic in ("resistances", "dependent", "balances"):
        for one in reader.equations(topic):
            sides = [_over_states(reader, side, held) for side in one.expressions]
            if topic == "balances" and one.node is not None:
                sides = sides[1:]  # the storage's own law, which makes the result
            assert all(vanishes(side - sides[-1]) for side in sides), one


def _over_states(reader: Reader, side: sp.Expr, held: dict[sp.Expr, sp.Expr]) -> sp.Expr:
    """A side with the rates of signals, and of what storages hold, as rates of states and inputs."""
    known = {f"{name}'" for name in (*reader.result.states, *reader.result.inputs)}
    for name in [s for s in side.free_symbols if str(s).endswith("'") and str(s) not in known]:
        plain = sp.Symbol(str(name)[:-1])
        value = reader.integrals.get(plain)
        if value is None:
            value = reader.rate(reader.value(held.get(plain, plain)))
        side = side.xreplace({name: value})
    return reader.value(side.xreplace({k: v for k, v in held.items() if not str(k).endswith("'")}))


def test_the_result_is_what_derive_gives(
    name: str, explanation: bg.Explanation, reader: Reader
) -> None:
    derived = bg.derive(GRAPHS[name]())
    assert explanation.result == derived
    rows = [row for row in result_rows(derived) if not vanishes(row)]
    stated = [one.left - one.right for one in reader.equations("result")]
    assert len(rows) == len(stated)
    assert all(vanishes(row - want) for row, want in zip(stated, rows, strict=True))


def test_the_matrices_make_a(explanation: bg.Explanation) -> None:
    formulas = [one for step in explanation.steps for one in step.formulas]
    if not explanation.result.states:
        assert not formulas
        return
    (formula,) = formulas
    assert formula.left.matrix == explanation.result.A
    assert all(vanishes(entry) for entry in formula.right - sp.Matrix(explanation.result.A))


def test_numbers_count_through(explanation: bg.Explanation) -> None:
    numbers = [
        one.number for step in explanation.steps for one in (*step.equations, *step.formulas)
    ]
    assert numbers == list(range(1, len(numbers) + 1))


def test_the_passive_differential_goes_as_in_the_paper() -> None:
    """Eqs. (1) to (6) of the paper, each among the equations that are stated."""
    explanation = bg.explain(differentials.graph("passive"))
    reader = Reader(explanation)
    i, I_i, I_w1, w1, w2, t1, tau_e = sp.symbols("i I_i I_w1 omega_1 omega_2 tau_t1 tau_e")
    dw1, dw2, dwe, given = sp.symbols("omega_1' omega_2' omega_e' e_I_i")
    stated = {(one.left, one.right) for step in explanation.steps for one in step.equations}
    right = sp.Symbol("e_bevel_torque_right")
    torque = reader.signals[right]
    assert (
        reader.signals[sp.Symbol("e_input_final_drive")] == tau_e - given
    )  # (1), with (I_i w_i') below
    assert (I_i * dwe, given) in stated
    assert reader.value(sp.Symbol("e_I_w1")).coeff(t1) == -1  # (2)
    assert sp.expand(torque - i / 2 * (tau_e - given)) == 0  # (4)
    assert reader.signals[sp.Symbol("e_bevel_torque_left")] == torque
    assert (sp.Symbol("omega_e"), i * w1 / 2 + i * w2 / 2) in stated  # (5)
    assert (dwe, i * dw1 / 2 + i * dw2 / 2) in stated
    balance = i / 2 * tau_e - i / 2 * I_i * i / 2 * (dw1 + dw2) - t1
    assert (I_w1 * dw1, sp.expand(balance)) in {(a, sp.expand(b)) for a, b in stated}
    final = (I_w1 + i**2 * I_i / 4) * dw1 + i**2 * I_i / 4 * dw2
    assert (sp.expand(final), i / 2 * tau_e - t1) in {(sp.expand(a), b) for a, b in stated}  # (6)


def test_the_story_names_who_rules_the_dependent_storage() -> None:
    explanation = bg.explain(differentials.graph("passive"))
    story = explanation.steps[0].sentences
    assert story[0] == "engine (Se) imposes its effort; it gives the effort tau_e to input"
    assert story[-1].startswith(
        "I_i (I) is dependent: its flow omega_e is imposed by I_w1, I_w2 by way of"
    )
    for name in ("left", "right", "case", "input"):
        assert any(line.startswith(f"{name} (1-junction) takes its flow") for line in story)
    assert any(
        line.startswith("bevel_torque (0-junction)") and "bevel_halves" in line for line in story
    )


def test_loops_are_told() -> None:
    steps = {step.topic: step for step in bg.explain(_ladder()).steps}
    assert steps["resistances"].sentences == ("R_1, R_2, R_3 see one another: solved together",)
    assert "loops" not in steps
    steps = {step.topic: step for step in bg.explain(_ring()).steps}
    assert len(steps["loops"].sentences) == 2


def test_laws_are_stated_and_stay_inputs() -> None:
    nodes = [bg.Se("drive", "tau"), bg.One("shaft"), bg.I("J", "J", flow="omega"),
             bg.C("spring", law="k*q_spring**3"), bg.R("brake", law=bg.DryFriction("tau_h"))]  # fmt: skip
    explanation = bg.explain(bond_graph(nodes, "drive>shaft>J shaft>spring shaft>brake"))
    steps = {step.topic: step for step in explanation.steps}
    k, q = sp.symbols("k q_spring")
    assert [(one.left, one.right) for one in steps["laws"].equations] == [
        (sp.Symbol("e_spring"), k * q**3)
    ]
    assert "dry friction" in steps["laws"].sentences[0]
    assert (sp.Symbol("q_spring'"), sp.Symbol("f_spring")) in {
        (one.left, one.right) for one in steps["storages"].equations
    }


def test_both_ways_of_a_switch_are_told() -> None:
    (step,) = (step for step in bg.explain(_boost()).steps if step.topic == "laws")
    assert step.title == (
        "Resistances, detectors and switches; what switches give stays an input of the equations"
    )
    told = dict(sentence.split(": ", 1) for sentence in step.sentences)
    assert told["clamp"] == (
        "an ideal switch; on, it keeps e_clamp = 0 by what f_clamp that takes, and turns off as f_clamp "
        "falls below zero; off, it gives f_clamp = 0, and turns on as e_clamp rises above zero; so e_clamp "
        "is never positive and f_clamp never negative"
    )
    forms = {one.name: one.gives for one in bg.derive(_boost()).switches}
    assert forms["q"] != forms["d"]
    q, free, kept = told["q"], *(("e_q", "f_q") if forms["q"] == "effort" else ("f_q", "e_q"))
    assert f"it gives {free} = 0" in q
    assert f"it keeps {kept} = 0 by what {free} that takes" in q
    assert q.index(f"{'it gives e_q' if free == 'e_q' else 'it keeps e_q'}") < q.index("off, ")
    assert q.endswith("and turns on as gate rises above zero")


def test_laws_and_switches_share_a_title() -> None:
    nodes = [
        bg.Se("s", "E"),
        bg.One("j"),
        bg.I("L", "L"),
        bg.R("r", law="f_r**3"),
        bg.Sw("k", on="g"),
    ]
    (step,) = (s for s in bg.explain(bond_graph(nodes, "s>j>L j>r j>k")).steps if s.topic == "laws")
    assert step.title.startswith(
        "Resistances, detectors, laws and switches; what laws and switches"
    )


def test_what_derive_refuses_is_refused_alike() -> None:
    nodes = [bg.Se("a", "a"), bg.Se("b", "b"), bg.Zero("n"), bg.I("m", "m")]
    graph = bond_graph(nodes, "a>n b>n n>m")
    messages = []
    for stage in (bg.derive, bg.explain):
        with pytest.raises(bg.CausalityError, match="both impose the effort") as refusal:
            stage(graph)
        messages.append(str(refusal.value))
    assert messages[0] == messages[1]
    with pytest.raises(bg.StructureError, match="output 'x' is not a node"):
        bg.explain(_ladder(), outputs=["x"])
