"""State equations on display: whole matrices, rows, or structure, whichever can be read."""

import re

import networkx as nx
import pytest
import sympy as sp
from references.build import bond_graph
from references.latex_checks import check_latex
from references.random_graphs import chain

import bondgraph as bg
import differentials
from bondgraph.algebra.expressions import expression
from bondgraph.show.display import equations_shown

ALSD = """\
                                                                          [ tau_e]
[ I_i*i^2/4 + I_w1         I_i*i^2/4 ] [omega_1'] = [ i/2  -1/2  -1   0 ] [ tau_f]
[        I_i*i^2/4  I_i*i^2/4 + I_w2 ] [omega_2']   [ i/2   1/2   0  -1 ] [tau_t1]
                                                                          [tau_t2]

[omega_f] = [ 1/2  -1/2 ] [omega_1]
                          [omega_2]"""


def test_small_systems_are_aligned_matrices() -> None:
    assert str(differentials.equations("alsd")) == ALSD


@pytest.mark.parametrize("name", ["passive", "stationary_tvd", "four_wheel_drive_tvd"])
def test_rows_say_what_the_matrices_say(name: str) -> None:
    """The text of every row, read as an expression, is the row of A, J, B, F."""
    equations = differentials.equations(name, halfshafts=name == "passive")
    form, text = equations_shown(equations)
    assert form == "rows"
    rows = re.sub(r"\n +", " ", text).split("\n")
    x, u = equations.states, equations.inputs
    rates = [sp.Symbol(f"{name}_rate") for name in x]
    lefts = [*(equations.A * sp.Matrix(rates)), *equations.outputs]
    rights = [
        *(equations.J * sp.Matrix(x) + equations.B * sp.Matrix(u)),
        *(equations.F * sp.Matrix(x)),
    ]
    assert len(rows) == len(lefts)
    for row, left, right in zip(rows, lefts, rights, strict=True):
        sides = (
            expression(side.replace("'", "_rate").replace("^", "**"), "row")
            for side in row.split("=")
        )
        for side, want in zip(sides, (left, right), strict=True):
            assert sp.cancel(side - want) == 0


def test_large_systems_are_told_by_their_structure() -> None:
    equations = bg.derive(chain(150), outputs=[])
    text = str(equations)
    n = len(equations.states)
    assert f"{n} states" in text
    assert f"A {n} x {n}: {len(equations.A.todok())}" in text
    assert len(text.splitlines()) < 40
    assert max(map(len, text.splitlines())) <= 120
    assert (
        repr(equations)
        == f"<StateEquations: {n} states, {len(equations.inputs)} inputs, 0 outputs>"
    )


def test_a_sketch_shows_where_entries_stand() -> None:
    equations = bg.derive(chain(10), outputs=[])
    drawn = str(equations).split("\n\n")[1].splitlines()[1:]
    assert len(drawn) == 20
    for i, line in enumerate(drawn):
        cells = [cell == "x" for cell in line.split()]
        assert cells[:20] == [entry != 0 for entry in equations.A[i, :]]
        assert cells[20:] == [entry != 0 for entry in equations.J[i, :]]


def test_a_system_without_states_shows_its_outputs() -> None:
    graph = bond_graph([bg.Se("u", "u"), bg.R("r", effort="e", gives="flow", flow="f")], "u>r")
    assert str(bg.derive(graph)) == "[e] = [ 1  0 ] [u]\n               [f]"


def test_notebooks_get_well_formed_formulas() -> None:
    for name in differentials.catalog:
        check_latex(differentials.equations(name)._repr_latex_())
    small = differentials.equations("alsd")._repr_latex_()
    assert small.startswith("$$")
    assert r"\omega_{1}" in small
    large = bg.derive(chain(150), outputs=[])._repr_latex_()
    check_latex(large)
    assert len(large) < 500
    assert r"A \dot{x} = J x + B u" in large


def test_rates_of_inputs_are_shown() -> None:
    nodes = [bg.Se("s", "V"), bg.One("n"), bg.Zero("z"), bg.R("r", "R"), bg.C("a", "C_1"),
             bg.C("b", "C_2", effort="v", priority=1)]  # fmt: skip
    graph: nx.DiGraph = bond_graph(nodes, "s>n>a n>z>b z>r")
    assert str(bg.derive(graph)) == "[ C_1 + C_2 ] [v'] = [ -1/R ] [v] + [ C_1 ] [V']"
