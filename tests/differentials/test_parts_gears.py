"""Gears, clutches, shafts and wheels as parts, by hand; whole graphs renamed, and refused ones."""

import networkx as nx
import pytest
import sympy as sp

import bondgraph as bg
import codegen
import differentials
from differentials.parts import (
    Part,
    assemble,
    brake,
    clutch,
    compliant_shaft,
    double_planetary,
    halfshaft,
    inertia,
    planetary,
    shaft,
    wheel,
)

h, k, b, J_a, J_b, J_w, w_a, w_b, w_c = sp.symbols("h k b J_a J_b J_w w_a w_b w_c")
t_a, t_b, t_c, slip = sp.symbols("t_a t_b t_c slip")


def turning(*names: str) -> Part:
    """Shafts with inertias J_<name> at the speeds w_<name>, in this order the states."""
    return assemble(
        *(shaft(name) for name in names),
        *(inertia(f"J_{name}", f"J_{name}", at=name, speed=f"w_{name}") for name in names),
    )


def load(name: str) -> Part:
    """A brake t_<name> at a shaft."""
    return brake(f"load_{name}", f"t_{name}", f"s_{name}", at=name)


def power(found: bg.StateEquations) -> sp.Expr:
    """What flows into the storages."""
    x, u = sp.Matrix(found.states), sp.Matrix(len(found.inputs), 1, found.inputs)
    return sp.cancel((x.T * (found.J * x + found.B * u))[0])


def same(found: sp.Matrix, expected: list[list[object]]) -> bool:
    difference = sp.Matrix(found) - sp.Matrix(expected)
    return difference.applyfunc(sp.cancel).is_zero_matrix is True


def geared(part: Part) -> bg.StateEquations:
    """A gear with inertias at a and b, a massless shaft c, and a brake at each."""
    return bg.derive(
        assemble(turning("a", "b"), shaft("c", "w_c"), part, load("a"), load("b"), load("c")),
        outputs=["c"],
    )


def test_willis_of_a_planetary_gear() -> None:
    """(w_sun - w_carrier)/(w_ring - w_carrier) = -h; torques sun : ring : carrier = 1 : h : -(1 + h)."""
    found = geared(planetary("gear", "h", sun="a", ring="b", carrier="c"))
    (carrier,) = found.F * sp.Matrix([w_a, w_b])
    assert sp.cancel((w_a - carrier) / (w_b - carrier)) == -h
    assert same(found.A, sp.diag(J_a, J_b).tolist())
    assert same(found.J, [[0, 0], [0, 0]])
    # A brake on the carrier alone loads the sun by 1/(1 + h) and the ring by h/(1 + h) of it.
    assert same(found.B, [[-1, 0, -1 / (1 + h)], [0, -1, -h / (1 + h)]])
    assert sp.cancel(power(found) + t_a * w_a + t_b * w_b + t_c * carrier) == 0


def test_willis_of_a_double_planetary_gear() -> None:
    """(w_driven - w_carrier)/(w_driving - w_carrier) = h; torques in h : -1 : -(h - 1)."""
    found = geared(double_planetary("gear", "h", driving="a", driven="b", carrier="c"))
    (carrier,) = found.F * sp.Matrix([w_a, w_b])
    assert sp.cancel((w_b - carrier) / (w_a - carrier)) == h
    # A brake on the carrier takes h/(h - 1) of it from the driving sun and gives 1/(h - 1) to the driven.
    assert same(found.B, [[-1, 0, -h / (h - 1)], [0, -1, 1 / (h - 1)]])
    assert sp.cancel(power(found) + t_a * w_a + t_b * w_b + t_c * carrier) == 0


@pytest.mark.parametrize("part", [planetary, double_planetary])
def test_a_gear_without_housing_turns_as_a_block(part: object) -> None:
    """At one speed of all shafts; so its torques sum to zero."""
    found = geared(part("gear", "z_2/z_1 + 1", "a", "b", "c"))
    assert same(found.F * sp.ones(2, 1), [[1]])
    assert same(sp.ones(1, 2) * found.B, [[-1, -1, -1]])
    z = sp.Symbol("z_2") / sp.Symbol("z_1") + 1
    ratio = [1 / (1 + z), z / (1 + z)] if part is planetary else [z / (z - 1), -1 / (z - 1)]
    assert same(found.F, [ratio])


def test_a_brake_works_against_the_housing() -> None:
    found = bg.derive(assemble(turning("a"), brake("brake", "tau", "slip", at="a")))
    assert (found.outputs, found.F.tolist(), found.B.tolist()) == ((slip,), [[1]], [[-1]])


@pytest.mark.parametrize(("speedup", "ratio"), [("h", h), ("1/h", 1 / h), ("h + 1", h + 1)])
def test_a_clutch_behind_a_speedup_gear(speedup: str, ratio: sp.Expr) -> None:
    """Its slip is h w_a - w_b; it brakes a with h times the torque that drives b."""
    part = clutch("clutch", "tau", "slip", driving="a", driven="b", speedup=speedup)
    found = bg.derive(assemble(turning("a", "b"), part))
    assert found.outputs == (slip,)
    assert same(found.F, [[ratio, -1]])
    assert same(found.B, [[-ratio], [1]])
    assert sp.cancel(power(found) + sp.Symbol("tau") * (ratio * w_a - w_b)) == 0


@pytest.mark.parametrize("damping", [None, "b"])
def test_a_compliant_shaft_is_a_spring_and_a_damper(damping: str | None) -> None:
    """torque = k twist + b (w_a - w_b); the ends get it with opposite signs, only b loses power."""
    part = compliant_shaft("rod", "a", "b", "2*k", damping, torque="tau", spring_torque="tau_k")
    found = bg.derive(assemble(turning("a"), part, turning("b")), outputs=["rod"])
    d = b if damping else 0
    assert sp.Tuple(*found.states, *found.outputs) == sp.Tuple(*sp.symbols("w_a tau_k w_b tau"))
    assert same(found.A, sp.diag(J_a, 1 / (2 * k), J_b).tolist())
    assert same(found.J, [[-d, -1, d], [1, 0, -1], [d, 1, -d]])
    assert same(found.F, [[d, 1, -d]])
    assert sp.cancel(power(found) + d * (w_a - w_b) ** 2) == 0


@pytest.mark.parametrize("damping", [None, "b"])
@pytest.mark.parametrize(
    ("twist", "rate", "spring", "whole"),
    [
        (0.04, 3.0, 0.0, 0.0),
        (0.07, 3.0, 2.0, 32.0),
        (-0.07, -3.0, -2.0, -32.0),
        (0.07, -0.1, 2.0, 1.0),
        (0.07, -3.0, 2.0, 0.0),
        (-0.07, 3.0, -2.0, 0.0),
    ],
)
def test_a_halfshaft_with_a_gap(
    damping: str | None, twist: float, rate: float, spring: float, whole: float
) -> None:
    """Fig. 5: zero in a gap of 0.1, outside 100 (twist -+ 0.05), with b = 10 rate but never pulling."""
    part = halfshaft(1, "a", "b", "k", damping, "gap")
    found = bg.derive(assemble(turning("a"), part, turning("b")), outputs=["halfshaft_1"])
    assert (found.states, str(found.outputs[0])) == ((w_a, w_b), "tau_hs1")
    values = {"J_a": 2.0, "J_b": 4.0, "k": 100.0, "gap": 0.1} | ({"b": 10.0} if damping else {})
    model = codegen.simulator(found, values)
    state = {"w_a": 5.0 + rate, "w_b": 5.0, "q_halfshaft_1_spring": twist}
    assert set(model.states) == set(state)
    rates = dict(zip(model.states, model.rhs(0, [state[s] for s in model.states]), strict=True))
    torque = whole if damping else spring
    expected = {"w_a": -torque / 2, "w_b": torque / 4, "q_halfshaft_1_spring": rate}
    assert rates == pytest.approx(expected, abs=1e-9)


def test_a_wheel_is_an_inertia_and_a_tire() -> None:
    found = bg.derive(assemble(shaft("hub"), wheel(3, "hub", "J_w", "omega_t3")))
    assert [str(s) for s in (*found.states, *found.inputs)] == ["omega_t3", "tau_t3"]
    assert [m.tolist() for m in (found.A, found.J, found.B, found.F)] == [
        [[J_w]], [[0]], [[-1]], [[1]]]  # fmt: skip


@pytest.mark.parametrize(
    "name", ["passive_input_clutch", "passive_input_shaft", "passive_halfshafts"]
)
def test_variants_without_a_full_model_are_refused(name: str) -> None:
    for build in (differentials.graph, differentials.equations):
        with pytest.raises(bg.StructureError, match=f"^{name} .* no model with halfshafts"):
            build(name, halfshafts=True)


@pytest.mark.parametrize("name", sorted(set(differentials.catalog) - {"passive_input_shaft"}))
def test_backlash_without_a_compliant_shaft_is_refused(name: str) -> None:
    with pytest.raises(bg.StructureError, match=f"^{name}.* no shaft that could have backlash"):
        differentials.graph(name, backlash=True)


@pytest.mark.parametrize("name", list(differentials.catalog))
@pytest.mark.parametrize("lumped", [True, False])
def test_neither_names_of_nodes_nor_the_order_of_bonds_matter(name: str, lumped: bool) -> None:
    """Nor the arrows at storages and resistances: power counts into them."""
    full = differentials.catalog[name].full and lumped
    graph = differentials.graph(name, halfshafts=full, lumped=lumped)
    names = {node: at for at, node in enumerate(graph)}
    ends = {node for node, kind in graph.nodes(data="kind") if kind in ("I", "C", "R")}
    other = nx.DiGraph()
    other.add_nodes_from((names[node], data) for node, data in graph.nodes(data=True))
    for tail, head in reversed(list(graph.edges)):
        bond = (head, tail) if {tail, head} & ends else (tail, head)
        other.add_edge(*(names[node] for node in bond))
    expected, found = bg.derive(graph), bg.derive(other)
    for part in ("states", "inputs", "outputs"):
        assert getattr(found, part) == getattr(expected, part)
    for part in "AJBEFDG":
        assert same(getattr(found, part), getattr(expected, part).tolist())
