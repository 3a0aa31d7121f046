"""Impulses exchange what storages hold: which storages switches bind, what these hold, what is refused."""

import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph
from scipy.integrate import solve_ivp

import bondgraph as bg
from bondgraph.algebra.exact import rows_of
from bondgraph.reduce.impulses import Momenta, momenta
from codegen import simulator

SHARED = [bg.Zero("n"), bg.C("a", law="sinh(q_a)", effort="e_a"), bg.C("b", law="2*sinh(q_b)"), bg.One("j"),
          bg.Sw("s", on="t - 1", off="-1"), bg.Zero("m"), bg.C("c", "1/2", effort="e_c")]  # fmt: skip
BONDS = "n>a n>b n>j j>s j>m m>c"


def held(equations: bg.StateEquations) -> Momenta | None:
    """What impulses of a graph exchange."""
    shown = {name: (one, equations.signals[name]) for name, one in equations.readings.items()}
    known = equations.reduction, rows_of(equations.A), equations.readings
    return momenta(equations.switches, *known, shown)


def test_what_states_hold_has_the_slopes_of_A() -> None:
    """Told are charges: of the two on one node together, and of the one beyond the switch."""
    equations = bg.derive(bond_graph(SHARED, BONDS))
    found = held(equations)
    e, c = equations.states
    assert found is not None
    assert found.states == (sp.asinh(e) + sp.asinh(e / 2), c / 2)
    assert sp.simplify(sp.Matrix(found.states).jacobian([e, c]) - equations.A) == sp.zeros(2, 2)


def test_what_a_reading_of_rates_shows_is_told_too() -> None:
    """A meter before the storage that depends on the other reads the rate of what that one holds."""
    nodes = [*SHARED, bg.One("way"), bg.Df("meter", integrate="Q")]
    equations = bg.derive(bond_graph(nodes, "n>a n>way way>b way>meter n>j j>s j>m m>c"))
    known = equations.with_readings(equations.integrals.values())
    found = held(known)
    assert found is not None
    assert [*found.readings.values()] == [sp.asinh(known.states[0] / 2)]


def test_where_slopes_stay_there_is_nothing_to_tell() -> None:
    """Of linear storages, and where a resistance beside the switch leaves no impulse."""
    linear = [
        bg.C("a", "C_a", effort="e_a") if name == "a" else (name, more) for name, more in SHARED
    ]
    linear = [bg.C("b", "C_b") if name == "b" else (name, more) for name, more in linear]
    assert held(bg.derive(bond_graph(linear, BONDS))) is None
    assert held(bg.derive(bond_graph([*SHARED, bg.R("r", "r")], f"{BONDS} j>r"))) is None


def test_a_storage_that_a_switch_binds_is_ruled_by_what_its_law_gives() -> None:
    """It alone keeps its charge as its state, and so it does behind a resistance, or a law of one."""
    nodes = [bg.Zero("n"), bg.C("a", law="sinh(q_a)", effort="e_a"), bg.One("j"), bg.Se("E", "E"),
             bg.Sw("s", on="t - 1", off="-1")]  # fmt: skip

    def kept(*more: tuple) -> tuple[sp.Symbol, ...]:
        bonds = "n>a n>j j>s E>j" + "".join(f" j>{name}" for name, _ in more)
        return bg.derive(bond_graph([*nodes, *more], bonds)).states

    assert kept() == (sp.Symbol("e_a"),)
    assert kept(bg.R("r", "R")) == kept(bg.R("d", law="f_d**3", gives="effort")) == ()


def test_a_storage_whose_charge_others_read_is_bound_as_well() -> None:
    """A leak that falls with the charge; at t = 1 the charge jumps to ``-asinh(E)``."""
    nodes = [bg.Zero("n"), bg.C("a", law="sinh(q_a)", effort="e_a"), bg.R("r", "1 + q_a**2"), bg.One("j"),
             bg.Sw("s", on="t - 1", off="-1"), bg.Se("E", "E")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "n>a n>r n>j j>s E>j"))
    assert equations.states == (sp.Symbol("e_a"),)
    run = simulator(equations, {}).run([0.0, 0.5, 1.5], {"q_a": 1.0}, {"E": 3.0})
    right = solve_ivp(lambda t, q: -np.sinh(q) / (1 + q**2), (0, 0.5), [1.0], "DOP853", rtol=1e-11)
    assert run["q_a"] == pytest.approx([1.0, right.y[0, -1], -np.arcsinh(3.0)], rel=1e-8)
    assert run["f_r"][-1] == pytest.approx(-3.0 / (1 + np.arcsinh(3.0) ** 2))


def test_a_storage_that_a_switch_sets_keeps_its_state() -> None:
    nodes = [bg.Zero("n"), bg.C("a", law="sinh(q_a)"), bg.One("j"), bg.Se("E", "E"),
             bg.Sw("s", on="t - 1", off="-1", reset={"q_a": "0"})]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "n>a n>j j>s E>j"))
    assert equations.reduction.structure.states_of_laws == (sp.Symbol("q_a"),)


@pytest.mark.parametrize(("first", "second"), [("s", "z"), ("z", "s")])
def test_two_switches_bind_what_each_binds_alone(first: str, second: str) -> None:
    """Of a switch before a storage and one across it each binds it, but both no more."""
    nodes = {"s": bg.Sw("s", on="t - 1", off="-1"), "z": bg.Sw("z", on="t - 2", off="-1")}
    graph = bond_graph(
        [bg.Se("E", "E"), bg.One("j"), nodes[first], nodes[second], bg.Zero("n"),
         bg.C("a", law="sinh(q_a)", effort="e_a")], "E>j j>s j>n n>z n>a",
    )  # fmt: skip
    assert bg.derive(graph).states == (sp.Symbol("e_a"),)


def test_an_impulse_by_way_of_a_ratio_that_jumps_is_refused_by_name() -> None:
    """A ratio that a speed rules goes a way of its own while that jumps."""
    nodes = [bg.One("a"), bg.I("J", "J", flow="w"), bg.TF("gear", "1 + w**2"), bg.One("b"),
             bg.I("K", "K", priority=-1), bg.Zero("gap"), bg.Sw("dog", on="1 - t", off="t - 1"),
             bg.One("c"), bg.I("L", "L", flow="w_c")]  # fmt: skip
    with pytest.raises(
        bg.StructureError, match="switch 'dog' would give an impulse to w, w_c by way of"
    ):
        bg.derive(bond_graph(nodes, "a>J a>gear gear>b b>K a>gap gap>c c>L gap>dog"))


def test_behind_a_resistance_it_is_a_matter_of_time() -> None:
    equations = bg.derive(bond_graph([*SHARED, bg.R("r", "r")], f"{BONDS} j>r"))
    run = simulator(equations, {"r": 0.5}).run(np.linspace(0, 3, 7), {"e_a": 5.0})

    def rate(t: float, e: np.ndarray) -> list[float]:
        i = (e[0] - e[1]) / 0.5
        return [-i / (1 / np.hypot(1, e[0]) + 0.5 / np.hypot(1, e[0] / 2)), i / 0.5]

    right = solve_ivp(rate, (1, 3), [5.0, 0.0], "DOP853", run.time[2:], rtol=1e-11, atol=1e-12).y
    assert run["e_a"][2:] == pytest.approx(right[0], rel=1e-8)
    assert run["e_c"][2:] == pytest.approx(right[1], abs=1e-8)
