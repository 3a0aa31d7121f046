"""Which law closes which port: merged, ordered, loops found, misuse refused."""

import pytest
from references.build import bond_graph

import bondgraph as bg
from codegen.program.closing import Closing, close_ports
from codegen.program.lower import lower


def _mass(*ports: tuple, more: str = "") -> bg.StateEquations:
    """A mass with one-ports beside it."""
    nodes = [bg.One("n"), bg.I("m", 1, flow="v"), *ports]
    bonds = " ".join(f"n>{name}" for name, _ in ports)
    return bg.derive(bond_graph(nodes, f"n>m {bonds} {more}"))


def _close(equations: bg.StateEquations, laws=None, parameters=()) -> Closing:
    return close_ports(equations, laws or {}, set(parameters))


def _order(closing: Closing) -> list[tuple[list[str], bool]]:
    return [([name.name for name in names], loop) for names, loop in closing.order]


def test_laws_that_use_one_another_are_put_in_order() -> None:
    equations = _mass(bg.R("a", law="e_b + e_c"), bg.R("b", law="2*e_c"), bg.R("c", law="v"))
    assert _order(_close(equations)) == [(["e_c"], False), (["e_b"], False), (["e_a"], False)]


def test_independent_laws_keep_the_order_of_declaration() -> None:
    equations = _mass(bg.R("z", law="v"), bg.R("a", law="2*v"), bg.R("k", law="3*v"))
    assert [names for names, _ in _order(_close(equations))] == [["e_z"], ["e_a"], ["e_k"]]


def test_laws_that_determine_one_another_are_a_loop() -> None:
    equations = _mass(
        bg.R("a", law="e_b/2 + v"), bg.R("b", law="e_a/2"), bg.R("c", law="e_a"), bg.R("d", law="v")
    )
    order = _order(_close(equations))
    assert (["e_a", "e_b"], True) in order
    assert order.index((["e_a", "e_b"], True)) < order.index((["e_c"], False))
    assert (["e_d"], False) in order


def test_a_law_of_its_own_value_is_a_loop() -> None:
    assert _order(_close(_mass(bg.R("a", law="e_a/2 + v")))) == [(["e_a"], True)]


def test_a_law_is_a_loop_where_the_structure_brings_its_value_back() -> None:
    """A diode in series with a resistance receives V - R i: its own flow, through D."""
    nodes = [bg.Se("s", "V"), bg.One("n"), bg.R("r", "R"),
             bg.R("diode", law="exp(e_diode) - 1", gives="flow")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "s>n>r n>diode"))
    assert _order(_close(equations, parameters=["R"])) == [(["f_diode"], True)]


def test_laws_are_sorted_by_what_they_depend_on() -> None:
    equations = _mass(
        bg.R("open"), bg.R("rub", law=bg.DryFriction("F")), bg.Se("known", "P*sin(w*t) + wind"),
        bg.R("damper", law="b*v"), bg.R("after", law="e_rub/2"), bg.R("later", law="e_after"),
    )  # fmt: skip
    closing = _close(equations, parameters=["F", "P", "w", "b"])
    assert [name.name for name in closing.external] == ["e_open", "wind"]
    assert [name.name for name in closing.known] == ["e_known"]
    assert [name.name for name in closing.friction] == ["e_rub"]
    assert [name.name for name in closing.coupled] == ["e_after", "e_later"]
    assert _order(closing) == [(["e_damper"], False)]


def test_what_is_given_goes_before_what_is_declared() -> None:
    equations = _mass(bg.R("a", law="v"), bg.R("b", law="v"))
    closing = _close(equations, {"a": "3*v", "e_b": "5*v"})
    assert {str(name): str(law.expression) for name, law in closing.laws.items()} == {
        "e_a": "3*v", "e_b": "5*v",
    }  # fmt: skip


def test_a_spring_with_a_law_keeps_its_state_under_another_law() -> None:
    equations = _mass(bg.C("s", law="q_s"))
    closing = _close(equations, {"s": "q_s + 2*q_s**3"})
    assert [name.name for name in closing.law_states] == ["q_s"]


def test_an_open_input_that_parameters_name_is_held_at_that_number() -> None:
    closing = _close(_mass(bg.Se("push", "P"), bg.R("open")), parameters=["P"])
    assert [name.name for name in closing.external] == ["e_open"]


REFUSED = [
    ({"nowhere": "v"}, bg.StructureError, "no open port or source is called 'nowhere'; there are"),
    ({"m": "v"}, bg.StructureError, "no open port or source is called 'm'"),
    ({"a": "v +"}, bg.ExpressionError, "law at 'a': 'v \\+' is not an expression"),
    ({"a": None}, bg.ExpressionError, "law at 'a': None is neither a number"),
    ({"a": float("nan")}, bg.ExpressionError, "law at 'a': nan is not a finite number"),
    (
        {"flowing": bg.DryFriction(1, "1 + slip")},
        bg.StructureError,
        "law at 'flowing': dry friction that gives a flow .* has one level",
    ),
    ({"s": bg.DryFriction(1)}, bg.ExpressionError, "'s': a storage takes an expression in q_s"),
]


@pytest.mark.parametrize(("laws", "error", "message"), REFUSED)
def test_misplaced_laws_are_refused(laws, error, message: str) -> None:
    nodes = [bg.One("n"), bg.I("m", 1, flow="v"), bg.R("a"), bg.C("s", law="q_s"), bg.Zero("z"),
             bg.R("flowing", gives="flow"), bg.C("c", 1)]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "n>m n>a n>s n>z>flowing z>c"))
    with pytest.raises(error, match=message):
        _close(equations, laws)


def test_a_key_that_names_a_node_and_another_nodes_input_is_refused() -> None:
    equations = _mass(bg.R("a", effort="b"), bg.R("b"))
    with pytest.raises(bg.StructureError, match="names a node and another node's input"):
        _close(equations, {"b": "v"})


def test_one_input_closed_by_two_laws_is_refused() -> None:
    equations = _mass(bg.Se("left", "P"), bg.Se("right", "P"))
    with pytest.raises(bg.StructureError, match="input P is closed by two different laws"):
        _close(equations, {"left": "1", "right": "2"})


@pytest.mark.parametrize("name", ["v", "e_a", "f_a", "q_s", "f_o", "t"])
def test_a_parameter_that_names_a_signal_is_refused(name: str) -> None:
    equations = _mass(bg.R("a", law="v", flow="f_a"), bg.C("s", law="q_s"), bg.R("o"))
    with pytest.raises(bg.ParameterError, match=f"parameter {name} names a signal of the model"):
        _close(equations, parameters=[name])


def test_a_law_over_a_dependent_storage_is_refused() -> None:
    """A damper whose effort drives a compliance with nothing between: its slope would be needed."""
    nodes = [bg.Zero("n"), bg.R("plate"), bg.C("c", "C"), bg.I("m", "m")]
    equations = bg.derive(bond_graph(nodes, "n>plate n>c n>m"))
    with pytest.raises(bg.DependentSourceError, match=r"'plate'.*dependent storage.*gives='flow'"):
        lower(equations, {"plate": "b*f_plate**2"}, ["C", "m", "b"])
    # Turned round, a law gives its flow there, and the compliance is a state; so with dry friction.
    turned = lower(equations, {"plate": "b*f_plate"}, ["C", "m", "b"])
    assert [state.name for state in turned.states] == ["e_c", "f_m"]
    program = lower(equations, {"plate": bg.DryFriction("F")}, ["C", "m", "F"])
    assert [state.name for state in program.states] == ["e_c", "f_m"]
    assert [port.slides for port in program.friction] == [True, True]
    # What time alone determines is a known source and may drive it.
    assert lower(equations, {"plate": "b*sin(t)"}, ["C", "m", "b"]).known.ports == ("plate",)


def _beside(friction: bg.DryFriction) -> bg.StateEquations:
    """Friction that moves nothing but a damper: its slip is what its own effort leaves of the force."""
    nodes = [bg.Se("push", "P"), bg.One("plate"), bg.R("damper", 4),
             bg.R("rub", law=friction, effort="f", flow="s")]  # fmt: skip
    return bg.derive(bond_graph(nodes, "push>plate>damper plate>rub"))


def test_friction_of_one_level_beside_a_resistance_is_affine_in_each_mode() -> None:
    """Which way it slips the mode says; how fast, what it gives does not read."""
    for friction in (bg.DryFriction(2), bg.DryFriction("L", 0.9, 1.5), bg.DryFriction("2 + w")):
        program = lower(_beside(friction), parameters={"L"})
        assert not program.joint
        assert program.affine


def test_friction_that_reads_its_own_slip_beside_a_resistance_is_solved_for() -> None:
    for friction in (bg.DryFriction(2, "1 + slip/8"), bg.DryFriction("2 + s/8")):
        program = lower(_beside(friction))
        assert program.joint
        assert not program.affine


def _late(closing: Closing) -> list[str]:
    return [name.name for names, _ in closing.order[closing.early :] for name in names]


def _brake(heat: str, *more: tuple, bonds: str = "") -> Closing:
    """A brake on a mass, and a heat flow into a body of its own."""
    nodes = [bg.One("a"), bg.I("J", 1, flow="w"), bg.Se("heat", heat), bg.One("th"),
             bg.I("body", 1, flow="T"),
             bg.R("c", effort="tau", flow="s", law=bg.DryFriction("N")), *more]  # fmt: skip
    return _close(bg.derive(bond_graph(nodes, f"a>J a>c heat>th>body {bonds}")), parameters=["N"])


def test_laws_that_only_read_what_friction_gives_come_after_it() -> None:
    closing = _brake("tau*s")
    assert (_late(closing), closing.coupled) == (["e_heat"], ())


def test_laws_that_read_late_laws_are_late_and_in_order() -> None:
    closing = _brake("2*f_gas", bg.Sf("gas", "tau*s"), bg.C("tank", 1), bonds="gas>tank")
    assert (_late(closing), closing.coupled) == (["f_gas", "e_heat"], ())


@pytest.mark.parametrize(
    ("push", "bonds"), [(bg.Se("push", "tau/3"), "push>a"), (bg.R("push", law="tau/3"), "a>push")]
)
def test_laws_that_push_on_what_friction_holds_are_solved_with_it(push, bonds) -> None:
    closing = _brake("tau*s", push, bonds=bonds)
    assert (_late(closing), [one.name for one in closing.coupled]) == (["e_heat"], ["e_push"])


def test_laws_that_push_on_a_nonlinear_inertia_that_friction_holds_are_solved_with_it() -> None:
    """They act on its momentum, which is a law's own state, and that on the slip's rate."""
    nodes = [bg.One("a"), bg.I("J", law="p_J + p_J**3"), bg.Se("push", "tau/3"),
             bg.R("c", effort="tau", flow="s", law=bg.DryFriction("N"))]  # fmt: skip
    closing = _close(bg.derive(bond_graph(nodes, "a>J a>c push>a")), parameters=["N"])
    assert (_late(closing), [one.name for one in closing.coupled]) == ([], ["e_push"])
