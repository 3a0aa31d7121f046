"""Which corners a program has, what they hang on, and where they count."""

import networkx as nx
import pytest
import sympy as sp
from oracles.models import oscillator
from references.build import bond_graph

import bondgraph as bg
from codegen.corners.located import with_corners
from codegen.program.lower import lower
from codegen.program.records import Program

q, v, t = sp.symbols("q_s v t")


def _graph(spring: object = "k*q_s", damper: object = "v") -> nx.DiGraph:
    nodes = [bg.One("n"), bg.I("m", "m", flow="v"), bg.C("s", law=spring), bg.R("d", law=damper)]
    return bond_graph(nodes, "n>m n>s n>d")


def _program(timed: bool = True, **laws: object) -> Program:
    return with_corners(lower(bg.derive(_graph(**laws)), None, ["m", "k", "gap"], timed))


def _hung(program: Program) -> list[tuple[object, sp.Expr]]:
    """Each corner's node, and what it hangs on."""
    found = program.corners
    return [] if found is None else list(
        zip(found.nodes, found.values.results[: len(found.sides)], strict=True)
    )  # fmt: skip


@pytest.mark.parametrize(
    ("law", "hangs"),
    [
        (sp.Abs(q), q),
        (sp.Max(0, sp.Symbol("k") * (q - 1)), sp.Symbol("k") * (q - 1)),
        (sp.Min(q, 2 * q), q),
        (sp.Piecewise((q, 2 * q - 2 > 0), (3 * q - 2, True)), q - 1),
        (sp.Abs(v) * q, v),
    ],
    ids=str,
)
def test_a_corner_hangs_on_what_is_compared(law: sp.Expr, hangs: sp.Expr) -> None:
    ((node, found),) = _hung(_program(spring=law))
    assert node == "s"
    assert sp.simplify(found / hangs).is_number


def test_a_program_without_corners_is_the_same_object() -> None:
    for graph in (_graph(), oscillator(law=bg.DryFriction("k", "exp(-slip)"))):
        program = lower(bg.derive(graph), None, ["m", "k"], True)
        assert with_corners(program) is program


def test_corners_of_time_alone_have_instants_of_their_own() -> None:
    assert _hung(_program(damper=sp.Abs(sp.sin(t)) * v + sp.Piecewise((v, t > 1), (0, True)))) == []
    (found,) = _hung(_program(damper=sp.Abs(v - sp.sin(t))))
    assert found[0] == "d"


def test_one_corner_of_several_laws_is_one() -> None:
    program = _program(spring=sp.Abs(v) * q, damper=sp.Max(v, 2 * v) + sp.sign(v) * v**2)
    assert len(_hung(program)) == 1


def test_a_corner_counts_where_its_branch_is_taken() -> None:
    law = sp.Piecewise((sp.Max(0, q - 2), q > 1), (0, True))
    program = _program(spring=law)
    assert program.corners is not None
    hung = [str(found) for _, found in _hung(program)]
    outer, inner = (program.sides[hung.index(text)] for text in ("q_s - 1", "q_s - 2"))
    *_, a, b = program.corners.on_sides.results
    counts = dict(zip(program.sides, (a, b), strict=True))
    told = sp.lambdify([outer], [counts[outer], counts[inner]])
    assert (told(1), told(-1)) == ([1, 1], [1, 0])


def test_names_that_are_taken_are_passed_over() -> None:
    graph = _graph(spring=sp.Abs(q) * sp.Symbol("side_1"))
    program = with_corners(lower(bg.derive(graph), None, ["m", "side_1"], True))
    assert [side.name for side in program.sides] == ["side_1_"]
