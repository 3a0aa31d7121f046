"""Rows of held ports along the tangents of laws: where they are made, and what they leave as it was."""

import pytest
import sympy as sp
from references.build import bond_graph

import bondgraph as bg
from codegen import simulator
from codegen.program.lower import lower
from codegen.program.slopes import NoSlopeError, slope

v, p = sp.symbols("v p")


def rubbing(law: str, *more: tuple, bonds: str = "") -> bg.StateEquations:
    """A mass that rubs on what a law lets move."""
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"), bg.Zero("z"),
             bg.R("belt", law=law, gives="flow", flow="w"),
             bg.R("rub", law=bg.DryFriction("L")), *more]  # fmt: skip
    return bg.derive(bond_graph(nodes, f"push>n>m n>z z>belt z>rub {bonds}"))


def _slip(law: str) -> tuple[dict[str, sp.Expr], object]:
    """What the slip v - w has of each state along the law's tangent, and the program."""
    program = lower(rubbing(law), parameters=("m", "L"))
    name = program.readings[program.friction[0].reading]
    row = program.equations.readings[name].F
    return {str(program.states[j]): entry for j, entry in row.items()}, program


def test_an_affine_law_stays_affine_and_constant() -> None:
    """v - (q - v/2) = 3 v/2 - q: what is left of the law is known, and so is its rate."""
    row, program = _slip("q - v/2")
    assert row == {"v": sp.Rational(3, 2)}
    assert program.affine
    assert not program.varying
    assert program.friction[0].moving is None
    assert program.friction[0].plain is not None
    assert {program.inputs[j] for j in program.beyond} <= {
        program.inputs[j] for j in program.known.inputs
    }


def test_a_nonlinear_law_makes_the_row_move() -> None:
    """d/dv of v - v^3/3 - q v is 1 - v^2 - q, and q' v is what moves beside it."""
    row, program = _slip("v**3/3 + q*v")
    assert sp.expand(row["v"] - (1 - v**2 - sp.Symbol("q"))) == 0
    assert program.varying
    assert not program.affine
    moving = program.equations.readings[program.readings[program.friction[0].moving]]
    assert not moving.F
    assert not moving.D
    assert [*moving.K.values()] == [-v]


def test_what_a_search_finds_is_left_as_it_was() -> None:
    law = "(sin(v) - w**3)/2"
    _, program = _slip(law)
    assert program.friction[0].plain is None
    assert not program.beyond
    with pytest.raises(bg.SimulationError, match="the slope in time of w, which a law gives of"):
        simulator(rubbing(law), {"m": 1.0, "L": 1.0}).run([0, 0.1], {}, {"P": 0.5})


def test_a_port_beside_a_resistance_needs_none() -> None:
    """It holds at once, by its own effort over the resistance."""
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", 1, flow="v"), bg.Zero("z"), bg.R("rub", law=
             bg.DryFriction("L")), bg.R("leak", 2), bg.R("belt", law="sin(v)", gives="flow")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "push>n>m n>z z>belt z>rub z>leak"))
    program = lower(equations, parameters=("L",))
    assert not program.beyond
    assert not program.varying


def test_slopes_have_a_value_at_corners_jumps_and_poles() -> None:
    q = sp.Symbol("q")
    assert slope(sp.Abs(p), p, {p}) == sp.sign(p)
    assert slope(sp.Min(p, q), p, {p, q}).subs({p: 1, q: 2}) == 1
    assert slope(sp.sign(p) * p, p, {p}) == sp.sign(p)
    assert slope(sp.sqrt(p), p, {p}).subs(p, 4) == sp.Rational(1, 4)
    assert slope(sp.sqrt(p), p, {p}).subs(p, 0) == 0
    assert slope(p**2 / q, p, {p}) == 2 * p / q
    with pytest.raises(NoSlopeError, match="no slope along p"):
        slope(sp.floor(p), p, {p})
