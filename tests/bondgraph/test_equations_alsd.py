"""The ALSD of the paper: Appendix B, however the graph is written."""

import random
from collections.abc import Hashable
from fractions import Fraction

import pytest
import sympy as sp
from references import alsd
from references.build import Graph, renamed, shuffled, turned
from references.matrices import differences, leading_minors, rationals
from rig.walked import WALKED

import bondgraph as bg

pytestmark = WALKED

#: Bonds between junctions, none at a transformer. Three of them close the loop over the clutch.
LEFT, RIGHT = ("sum", "left"), ("sum", "right")
CASE_SLIP, SLIP_RIGHT = ("case", "slip"), ("slip", "right")
PORTS = ("engine", "I_i", "I_w1", "I_w2", "clutch", "tire_1", "tire_2")


def test_matrices_are_those_of_appendix_b() -> None:
    equations = bg.derive(alsd.alsd_graph(), outputs=["clutch"])
    assert equations.states == alsd.STATES
    assert equations.inputs == alsd.INPUTS
    assert equations.outputs == alsd.OUTPUTS
    assert differences(equations.A, alsd.A) == {}
    assert differences(equations.B, alsd.B) == {}
    assert differences(equations.F, alsd.F) == {}


def test_rigid_differential_has_no_other_terms() -> None:
    equations = bg.derive(alsd.alsd_graph(), outputs=["clutch"])
    for matrix, shape in zip(
        (equations.J, equations.E, equations.D, equations.G),
        ((2, 2), (2, 4), (1, 4), (1, 4)),
        strict=True,
    ):
        assert matrix.shape == shape
        assert matrix.todok() == {}
    assert equations.parameters == sp.symbols("I_i I_w1 I_w2 i")
    assert dict(equations.laws) == {}


def test_plain_dicts_give_the_same() -> None:
    one, other = (bg.derive(g) for g in (alsd.alsd_graph(), alsd.plain_graph()))
    assert one == other


def test_clutch_column_is_minus_the_slip_row() -> None:
    equations = bg.derive(alsd.alsd_graph())
    assert equations.outputs == sp.symbols("omega_f omega_t1 omega_t2")
    assert differences(equations.B[:, 1:], -equations.F.T) == {}


def test_mass_matrix_is_symmetric_and_positive_definite() -> None:
    A = bg.derive(alsd.alsd_graph()).A
    assert differences(A, A.T) == {}
    rng = random.Random(1)
    for _ in range(20):
        values = {name: Fraction(rng.randint(1, 99), 10) for name in ("I_i", "I_w1", "I_w2", "i")}
        assert all(minor > 0 for minor in leading_minors(rationals(A, values)))


def _bonds_to_turn(graph: Graph, rng: random.Random) -> set[tuple[Hashable, Hashable]]:
    """Any bonds of one-ports, and of the loop over the clutch an even number.

    Turning one or three bonds of a loop changes which flows add and which subtract there: another
    machine. An even number only turns the positive direction of what lies between.
    """
    chosen = {bond for bond in graph.edges if set(bond) & set(PORTS) and rng.random() < 0.5}
    if rng.random() < 0.5:
        chosen.add(LEFT)
    return chosen | set(rng.sample([RIGHT, CASE_SLIP, SLIP_RIGHT], rng.choice([0, 2])))


def _signs(turned_bonds: set[tuple[Hashable, Hashable]]) -> dict[str, int]:
    """The sign that each signal gets, seen from `sum` and `case`, which keep their directions."""
    left, right = (-1 if bond in turned_bonds else 1 for bond in (LEFT, RIGHT))
    slip = -1 if CASE_SLIP in turned_bonds else 1
    engine = -1 if ("engine", "input") in turned_bonds else 1
    return {
        "omega_1": left, "tau_t1": left, "omega_2": right, "tau_t2": right,
        "tau_f": slip, "omega_f": slip, "tau_e": engine,
    }  # fmt: skip


@pytest.mark.parametrize("seed", range(40))
def test_turned_renamed_and_reordered_graph_changes_names_signs_and_order_only(seed: int) -> None:
    rng, graph = random.Random(seed), alsd.alsd_graph()
    bonds = _bonds_to_turn(graph, rng)
    signs = _signs(bonds)
    used = [*map(str, alsd.STATES + alsd.INPUTS + alsd.OUTPUTS), "i", "I_i", "I_w1", "I_w2"]
    symbols = dict(zip(used, rng.sample([f"q{k}" for k in range(50)], len(used)), strict=True))
    nodes = dict(zip(graph, rng.sample([f"n{k}" for k in range(50)], len(graph)), strict=True))
    other = shuffled(renamed(turned(graph, bonds), nodes, symbols), rng)
    equations = bg.derive(other, outputs=[nodes["clutch"]])
    places = [
        [names.index(sp.Symbol(symbols[str(name)])) for name in original]
        for names, original in (
            (equations.states, alsd.STATES),
            (equations.inputs, alsd.INPUTS),
            (equations.outputs, alsd.OUTPUTS),
        )
    ]
    x, u, y = (
        sp.diag(*(signs[str(name)] for name in group))
        for group in (alsd.STATES, alsd.INPUTS, alsd.OUTPUTS)
    )
    back = {sp.Symbol(new): sp.Symbol(old) for old, new in symbols.items()}
    A, B, F = (sp.Matrix(m).xreplace(back) for m in (equations.A, equations.B, equations.F))
    assert differences(x * A.extract(places[0], places[0]) * x, alsd.A) == {}
    assert differences(x * B.extract(places[0], places[1]) * u, alsd.B) == {}
    assert differences(y * F.extract(places[2], places[0]) * x, alsd.F) == {}


def test_output_that_depends_on_the_rates_is_resolved() -> None:
    """The torque that accelerates wheel 1 is ``I_w1 omega_1'``, with ``omega'`` from Appendix B."""
    equations = bg.derive(alsd.alsd_graph(), outputs=["I_w1"])
    assert equations.F.todok() == {}
    expected = sp.Symbol("I_w1") * (alsd.A.inv() * alsd.B)[0, :]
    assert differences(equations.D, expected) == {}


def test_case_speed_is_the_mean_of_the_wheel_speeds() -> None:
    equations = bg.derive(alsd.alsd_graph(), outputs=["case", "I_i"])
    i, half = sp.Symbol("i"), sp.Rational(1, 2)
    assert equations.outputs == sp.symbols("f_case f_I_i")
    assert differences(equations.F, [[half, half], [i / 2, i / 2]]) == {}


def test_same_input_gives_the_same_text() -> None:
    one, other = (bg.derive(alsd.alsd_graph()) for _ in range(2))
    assert repr(one) == repr(other)
