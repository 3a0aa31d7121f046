"""Dry friction put later over a port that drives a dependent storage: the graph is derived once more."""

import random

import pytest
import sympy as sp
from references.build import bond_graph
from references.matrices import differences
from references.random_graphs import random_graph
from references.switched_modes import answers, determinant
from soak.families import seeds

import bondgraph as bg
from bondgraph.analyse.turned import driving_ports, may_vanish, turned

FRICTION = bg.DryFriction("N")


def _spring(
    law: object = None, outputs: list[str] | None = None, **more: object
) -> bg.StateEquations:
    """A spring under an imposed speed, directly on a slider."""
    nodes = [bg.Sf("speed", "v"), bg.Zero("z"), bg.C("k", "1/k", effort="F"),
             bg.R("slider", effort="F_s", flow="s", law=law, **more)]  # fmt: skip
    return bg.derive(bond_graph(nodes, "speed>z>k z>slider"), outputs)


def test_it_is_what_the_graph_with_the_law_gives() -> None:
    before = _spring()
    text = repr(before)
    found, declared = turned(before, {"slider": FRICTION}), _spring(FRICTION)
    assert repr(before) == text
    assert (before.states, before.inputs[1].name) == ((), "F_s")
    assert (found.states, found.inputs, found.laws) == (
        declared.states,
        declared.inputs,
        declared.laws,
    )
    for name in "AJBE":
        assert differences(getattr(found, name), getattr(declared, name)) == {}
    # Its output is the slip as before, though it is what the port gives now.
    assert found.outputs == before.outputs
    assert (found.F.tolist(), found.D.tolist()) == ([[0]], [[0, 1]])
    assert not any(found.E)
    assert turned(found, {"slider": FRICTION}) is found
    assert turned(_spring(), {"F_s": FRICTION}) == found
    assert str(found) == str(turned(_spring(), {"slider": FRICTION}))


@pytest.mark.parametrize("laws", [None, {}, {"slider": "3*t"}, {"nobody": FRICTION}, ["slider"]])
def test_what_needs_no_other_causality_stays(laws: object) -> None:
    equations = _spring()
    assert turned(equations, laws) is equations


def test_a_port_that_gives_its_flow_to_a_mass_is_turned_too() -> None:
    """With gives="flow" it drives the mass; friction gives its effort there."""
    nodes = [
        bg.Se("push", "P"),
        bg.One("block"),
        bg.I("m", "m", flow="v"),
        bg.R("ground", effort="F", gives="flow"),
    ]
    equations = bg.derive(bond_graph(nodes, "push>block>m block>ground"))
    assert equations.states == ()
    assert equations.ports[1] in driving_ports(equations)
    model = bg.linearize(equations, laws={"ground": FRICTION}, at={"f_ground": 1}, inputs=["N"])
    assert list(map(str, model.states)) == ["v"]
    assert differences(model.B, [[1, -1]]) == {}


@pytest.mark.parametrize("held", [{"stuck": iter(["slider"])}, {"mode": {"slider": "stick"}}])
def test_a_port_without_a_law_is_held_on_a_spring(held: dict) -> None:
    """What holds it is the spring's effort, F' = k v."""
    model = bg.linearize(_spring(), outputs=["F_s", "e_speed"], **held)
    assert list(map(str, model.states)) == ["F"]
    assert differences(model.A.inv() * model.B, [[sp.Symbol("k")]]) == {}
    assert differences(model.F, [[1], [1]]) == {}


def test_only_the_ports_that_drive_are_turned() -> None:
    """A brake on a mass keeps its effort, beside a slider on a spring."""
    nodes = [bg.Se("push", "P"), bg.One("block"), bg.I("m", "m", flow="v"), bg.R("brake", effort="B"),
             bg.Zero("z"), bg.C("k", "1/k", effort="F"), bg.R("slider", effort="F_s", flow="s")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "push>block>m block>brake block>z>k z>slider"))
    found = turned(equations, {"brake": FRICTION, "slider": FRICTION})
    assert list(map(str, found.states)) == ["v", "F"]
    assert list(map(str, found.inputs)) == ["P", "B", "s"]
    assert list(map(str, found.outputs)) == ["f_brake", "s"]


def test_what_is_physics_is_refused_by_name() -> None:
    with pytest.raises(
        bg.StructureError, match=r"law at 'slider': dry friction that gives a flow .* one level"
    ):
        turned(_spring(), {"slider": bg.DryFriction("N", "1 + exp(-slip)")})
    with pytest.raises(
        bg.DependentSourceError, match="the law at 'slider' drives a dependent storage"
    ):
        bg.linearize(_spring(), laws={"slider": "c*s**2"})


@pytest.mark.parametrize(("ratio", "good"), [("r*sin(theta)", False), ("r*(2 + sin(theta))", True)])
def test_a_ratio_that_may_vanish_is_not_divided_by(ratio: str, good: bool) -> None:
    nodes = [bg.Sf("speed", "v"), bg.Zero("z"), bg.C("k", "1/k", effort="F"), bg.TF("cam", ratio),
             bg.R("slider", effort="F_s", flow="s"), bg.Se("drive", "T"), bg.One("shaft"),
             bg.I("J", "J", flow="w"), bg.Df("angle", integrate="theta")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "speed>z>k z>cam>slider drive>shaft>J shaft>angle"))
    if good:
        assert list(map(str, turned(equations, {"slider": FRICTION}).states)) == ["F", "w"]
        return
    with pytest.raises(bg.DependentSourceError, match=r"'slider' .* would divide by sin\(theta\)"):
        turned(equations, {"slider": FRICTION})


@pytest.mark.parametrize(
    ("expr", "expected"),
    [("x", True), ("x**2", True), ("x**2 + 1", False), ("3 - 2*cos(x)", False), ("1 - cos(x)", True),
     ("exp(x)", False), ("exp(x) + 1", False), ("abs(x) + 2", False), ("2 - abs(x)", True), ("a", False),
     ("a + cos(x)", True), ("-2 - sin(x)*cos(x)", True)],
)  # fmt: skip
def test_what_may_vanish(expr: str, expected: bool) -> None:
    x = bg.expression("x", "test")
    assert may_vanish(bg.expression(expr, "test"), {x}) is expected


def _regular(equations: bg.StateEquations, s: sp.Rational) -> bool:
    return not equations.states or determinant(sp.Matrix(s * equations.A - equations.J)) != 0


@pytest.mark.parametrize("seed", seeds("turned-friction"))
def test_turned_equations_are_those_of_the_same_graph(seed: int) -> None:
    """No port under friction drives what is dependent; and at any s the signals that follow from what ports
    give now are, put into the equations before, those that follow there: ports that gave u then receive it.
    """
    rng = random.Random(seed)
    graph = random_graph(rng, rng.randint(3, 14), symbols=False)
    try:
        before = bg.derive(graph)
    except (bg.CausalityError, bg.AlgebraicLoopError, bg.SingularStorageError):
        return
    nodes = [port.element.name for port in before.ports if port.element.kind.resists]
    after = turned(before, dict.fromkeys(nodes, FRICTION))
    assert not [port for port in driving_ports(after) if port.element.name in nodes]
    assert (set(after.signals), after.outputs) == (set(before.signals), before.outputs)
    s = sp.Rational(rng.randint(1, 40), 7)
    if not (_regular(before, s) and _regular(after, s)):
        return
    now, then = answers(after, (), s), answers(before, (), s)
    for name in now:
        found = dict.fromkeys(after.inputs, sp.Integer(0))
        for given, factor in then[name].items():
            for source, share in now[given].items():
                found[source] += factor * share
        assert {k: v for k, v in found.items() if v} == {k: v for k, v in now[name].items() if v}
