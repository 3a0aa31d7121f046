"""`latex` of whatever is made of equations, against lines written by hand."""

import networkx as nx
import pytest
import sympy as sp
from references.build import bond_graph

import bondgraph as bg


def _mass() -> nx.DiGraph:
    nodes = [bg.Se("push", "F"), bg.One("mass"), bg.I("m", "m", flow="omega_1"), bg.R("drag", "b")]
    return bond_graph(nodes, "push>mass>m mass>drag")


def _column(entry: str) -> str:
    return rf"\left[\begin{{matrix}}{entry}\end{{matrix}}\right]"


EQUATIONS = bg.derive(_mass(), outputs=["drag"])
MODEL = bg.linearize(EQUATIONS)


def test_explicit_rates_are_aligned() -> None:
    body = r"\dot{\omega}_{1} &= \frac{F - b \omega_{1}}{m}"
    assert bg.latex(bg.explicit(EQUATIONS)) == rf"\begin{{aligned}} {body} \end{{aligned}}"


def test_a_linear_model_has_its_matrices_and_in_numbers_its_poles() -> None:
    speed, rate = _column(r"\omega_{1}"), r"\frac{d}{dt}"
    first = f"{_column('m')}{rate}{speed} = {_column('- b')}{speed} + {_column('1')}{_column('F')}"
    assert bg.latex(MODEL).split(" \\\\\n") == [
        first,
        f"{_column('f_{drag}')} = {_column('1')}{speed}",
    ]
    first, second, poles = bg.latex(MODEL.numeric({"m": 4, "b": 1})).split(" \\\\\n")
    assert first == f"{rate}{speed} = {_column('-0.25')}{speed} + {_column('0.25')}{_column('F')}"
    assert second == f"{_column('f_{drag}')} = {_column('1')}{speed}"
    assert poles == r"\text{poles [1/s]: } -0.25"
    numbers = bg.linearize(bg.derive(_numbers()))
    assert bg.latex(numbers).endswith(r"\text{poles [1/s]: } -0.25")


def _numbers() -> nx.DiGraph:
    nodes = [bg.Se("push", "F"), bg.One("mass"), bg.I("m", 4), bg.R("drag", 1)]
    return bond_graph(nodes, "push>mass>m mass>drag")


def test_expressions_matrices_and_mappings_are_typeset() -> None:
    found = MODEL.transfer_function()
    assert bg.latex(found) == _column(r"\frac{1}{b + m s}")
    assert bg.latex(found[0]) == r"\frac{1}{b + m s}"
    told = {sp.Symbol("tau_1"): sp.Symbol("a") / 2, "b": "c + 1", "d": 0.5}
    rows = [r"\tau_{1} &= \frac{a}{2}", "b &= c + 1", r"d &= \frac{1}{2}"]
    body = " \\\\\n".join(rows)
    assert bg.latex(told) == rf"\begin{{aligned}} {body} \end{{aligned}}"
    assert bg.latex({}) == ""


def test_an_explanation_is_the_body_of_a_document() -> None:
    explained = bg.explain(_mass())
    assert bg.latex(explained) == explained.latex()


@pytest.mark.parametrize(
    ("subject", "says"),
    [
        (_mass(), "not DiGraph; derive the graph first"),
        (bg.assign_causality(_mass()), "not CausalGraph; derive the graph first"),
        ("omega", "not str"),
        (None, "not NoneType"),
        (3, "not int"),
    ],
)
def test_what_has_no_formulas_is_refused(subject: object, says: str) -> None:
    with pytest.raises(bg.StructureError, match=f"latex takes state equations, .*, {says}"):
        bg.latex(subject)


def test_a_mapping_to_what_is_no_expression_is_refused_by_name() -> None:
    with pytest.raises(bg.ExpressionError, match="latex of a: None is neither"):
        bg.latex({"a": None})
