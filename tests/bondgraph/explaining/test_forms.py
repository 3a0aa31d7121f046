"""Derivations as text, LaTeX and Markdown: aligned, closed, and short however large the graph."""

import re
from functools import cache

import networkx as nx
import pytest
from references.build import bond_graph
from references.derivations import explained
from references.latex_checks import check_latex
from references.random_graphs import chain
from references.random_switches import random_switched

import bondgraph as bg
import differentials

PASSIVE = """\
5. Differentiated: what dependent storages give
  (24)  I_i   omega_e = i/2*omega_1 + i/2*omega_2
  (25)  I_i  omega_e' = i/2*omega_1' + i/2*omega_2'
  (26)  I_i     e_I_i = I_i*omega_e' = I_i*i/2*omega_1' + I_i*i/2*omega_2'

6. Put into the storages' laws and the outputs
  (27)  I_w1  I_w1*omega_1' = e_I_w1
                            = i/2*tau_e - i/2*e_I_i - tau_t1
                            = i/2*tau_e - tau_t1 - I_i*i^2/4*omega_1' - I_i*i^2/4*omega_2'
"""

INERTIA = """\
  (29)  A = M_x + S_xd M_d S_xd^T

       = [ I_w1     0 ] + [ -i/2 ] [ I_i ] [ -i/2  -i/2 ]
         [    0  I_w2 ]   [ -i/2 ]
"""


def test_the_passive_differential_reads_as_in_the_paper() -> None:
    text = explained("passive").text()
    assert PASSIVE in text
    assert INERTIA in text
    assert text == str(bg.explain(differentials.graph("passive")))


def test_equations_of_a_step_stand_below_one_another() -> None:
    text = explained("alsd").text().partition("\n\nIn matrices")[0]
    for step in re.split(r"\n\n(?=\d+\. )", text):
        lines = [
            line for line in step.splitlines() if re.match(r"  \(\d+\) ", line) and " = " in line
        ]
        if "The matrix" not in step:
            assert len({line.index(" = ") for line in lines}) <= 1, step


@pytest.mark.parametrize("name", ["passive", "alsd", "stationary_tvd"])
def test_lines_are_short(name: str) -> None:
    """Only a single term, with all of its factor, may be longer than a line."""
    for line in explained(name).text().splitlines():
        right = line.split("=")[-1]
        while "(" in right:
            right = re.sub(r"\([^()]*\)", "", right)
        assert len(line) <= 100 or len(re.split(r" [+-] ", right.strip())) == 1, line


def _awkward() -> nx.DiGraph:
    """Names that LaTeX and Markdown would read as commands."""
    nodes = [bg.Se("100 % & more", "u", flow="f"), bg.One("a_b^c"),
             bg.I("{J}", "J", flow="omega", effort="tau"), bg.R("R#1~$x$", "R", effort="e", flow="w"),
             bg.C("back\\slash", "1/k", effort="tau_k", flow="w_k")]  # fmt: skip
    graph: nx.DiGraph = nx.DiGraph()
    graph.add_nodes_from(nodes)
    graph.add_edges_from([("100 % & more", "a_b^c"), *(("a_b^c", node) for node, _ in nodes[2:])])
    return graph


@cache
def _large() -> bg.Explanation:
    """Of a chain of 120 storages."""
    return bg.explain(chain(60))


FORMS = {
    **{name: lambda name=name: explained(name) for name in differentials.catalog},
    "awkward": lambda: bg.explain(_awkward()),
    "switched": lambda: bg.explain(random_switched(3, most=3)),
    "large": _large,
}


@pytest.mark.parametrize("name", FORMS)
def test_latex_and_markdown_are_well_formed(name: str) -> None:
    explanation = FORMS[name]()
    check_latex(explanation.latex(), tabs=3)
    markdown = explanation._repr_markdown_()
    check_latex(re.sub(r"\\([*_<>`|\[\]])", "", markdown.replace("**", "")), tabs=5)
    assert markdown.count(r"\begin{aligned}") == explanation.latex().count(r"\begin{align*}")


def test_letters_are_greek_and_rates_have_dots() -> None:
    latex = explained("passive").latex()
    assert r"I_{w1} \dot{\omega}_{1} & = " in latex.replace("&=", "& =")
    assert r"\frac{i}{2} \tau_{e}" in latex
    assert r"it gives the effort $\tau_{e}$ to input" in latex


def test_numbers_are_the_same_in_every_form() -> None:
    explanation = explained("alsd")
    numbers = [
        str(n) for s in explanation.steps for n in (e.number for e in (*s.equations, *s.formulas))
    ]
    assert re.findall(r"\\tag\{(\d+)\}", explanation.latex()) == numbers
    assert re.findall(r"\\text\{\((\d+)\)\}", explanation._repr_markdown_()) == numbers
    assert re.findall(r"^  \((\d+)\) ", explanation.text(), flags=re.M) == numbers


def test_large_graphs_are_summarised_unless_all_is_asked_for() -> None:
    explanation = _large()
    short, whole = explanation.text(), explanation.text(limit=None)
    assert len(short.splitlines()) < 150
    assert re.search(r"^  \.\.\. and \d+ more, up to \(\d+\)$", short, flags=re.M)
    assert "... and" not in whole
    stated = sum(len(step.equations) for step in explanation.steps)
    assert len(whole.splitlines()) > stated
    assert len(explanation.text(limit=3)) < len(short)
    assert len(explanation._repr_markdown_()) < 20_000


def test_long_factors_are_told_by_their_length() -> None:
    """A train of gears: the one state's inertia has thirty terms."""
    nodes: list = [bg.Se("u", "u"), bg.One("j0"), bg.I("m0", "m0", priority=1)]
    bonds = "u>j0>m0"
    for k in range(1, 30):
        nodes += [bg.TF(f"t{k}", f"n{k}"), bg.One(f"j{k}"), bg.I(f"m{k}", f"m{k}")]
        bonds += f" j{k - 1}>t{k}>j{k}>m{k}"
    text = bg.explain(bond_graph(nodes, bonds)).text()
    assert re.search(r"<\d+ operations>\*f_m0' = u$", text, flags=re.M)
    assert "M_d: 29 x 29, 29 entries" in text
