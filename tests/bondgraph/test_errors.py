"""Each stage refuses with its own error, all of one base, and names the place."""

import inspect

import pytest
from references.brute_force import regular, regular_port_choices
from references.build import Graph, Node, bond_graph

import bondgraph as bg
from bondgraph import errors


def _parallel_paths() -> Graph:
    """Two 0-junctions side by side between two 1-junctions: how they share the effort is open."""
    nodes = [bg.Se("s", "u"), bg.One("a"), bg.Zero("p"), bg.Zero("q"), bg.One("b"), bg.I("m", "m")]
    return bond_graph(nodes, "s>a a>p>b a>q>b b>m")


def _transformer_ring(first: object, second: object) -> Graph:
    """e_1 = m_1 e_2 and e_2 = m_2 e_1: with m_1 m_2 = 1 any flow may circulate."""
    nodes = [
        bg.Zero("z1"), bg.TF("p", first), bg.Zero("z2"), bg.TF("q", second), bg.I("m", "m"),
        bg.R("r", "r"),
    ]  # fmt: skip
    return bond_graph(nodes, "z1>p>z2>q>z1>m z2>r")


def test_every_error_is_of_one_base() -> None:
    found = [kind for _, kind in inspect.getmembers(errors, inspect.isclass)]
    classes = [kind for kind in found if kind.__module__ == errors.__name__]
    assert len(classes) > 5
    refusals = [kind for kind in classes if not issubclass(kind, Warning)]
    assert all(issubclass(kind, bg.BondGraphError) for kind in refusals)
    assert all(issubclass(kind, bg.ModelWarning) for kind in set(classes) - {*refusals})
    assert issubclass(bg.BondGraphError, ValueError)


def test_parallel_paths_are_refused() -> None:
    graph = _parallel_paths()
    assert not regular(graph)
    assert regular_port_choices(graph) == []
    with pytest.raises(bg.AlgebraicLoopError, match=r"effort of bond '[apqb]' -> '[apqb]'"):
        bg.assign_causality(graph)


@pytest.mark.parametrize(
    "moduli",
    [
        (2, "1/2"),
        ("m1", "1/m1"),
        ("h - 1", "1/(h - 1)"),
        ("sqrt(2)", "sqrt(2)/2"),
        ("sqrt(2) - 1", "sqrt(2) + 1"),
        ("cos(a)", "1/cos(a)"),
        ("exp(a)", "exp(-a)"),
    ],
)
def test_transformer_ring_of_ratio_one_is_refused(moduli: tuple[object, object]) -> None:
    with pytest.raises(bg.AlgebraicLoopError, match=r"'(z1|z2|p|q)'.*loop"):
        bg.derive(_transformer_ring(*moduli))


@pytest.mark.parametrize(
    "moduli", [("tan(a)", "cos(a)/sin(a)"), ("sin(a)**2", "1/(1 - cos(a)**2)")]
)
def test_transformer_ring_whose_ratio_is_one_by_an_identity_is_refused(
    moduli: tuple[object, object],
) -> None:
    with pytest.raises(bg.AlgebraicLoopError, match=r"'(z1|z2|p|q)'.*loop"):
        bg.derive(_transformer_ring(*moduli))


@pytest.mark.parametrize(
    "moduli",
    [(2, 3), ("m1", "m2"), (2, "-1/2"), ("sqrt(2)", "sqrt(2)"), ("sqrt(x**2)", "-1/x")],
)
def test_other_transformer_rings_hold_their_efforts_at_zero(moduli: tuple[object, object]) -> None:
    equations = bg.derive(_transformer_ring(*moduli), outputs=["m", "r"])
    assert equations.F.todok() == equations.J.todok() == {}


def test_resistances_that_cancel_in_a_loop_are_refused() -> None:
    with pytest.raises(bg.AlgebraicLoopError, match="resistances 'a', 'b' form a loop"):
        bg.derive(bond_graph([bg.R("a", "r"), bg.R("b", "-r")], "a>b"))


def _coupled(first: object, second: object, third: object) -> Graph:
    """Three inertias of which one turns with the sum of the others' speeds."""
    nodes: list[Node] = [
        bg.Zero("z"), bg.One("a"), bg.One("b"), bg.I("I_1", first), bg.I("I_2", second),
        bg.I("I_3", third, priority=-1),
    ]  # fmt: skip
    return bond_graph(nodes, "a>z b>z z>I_3 a>I_1 b>I_2")


@pytest.mark.parametrize(
    "values", [(1, 1, -0.5), ("m", "n", "-m*n/(m + n)"), ("sqrt(2)", "sqrt(8)", "-sqrt(8)/3")]
)
def test_inertias_that_make_the_mass_matrix_singular_are_refused(values: tuple) -> None:
    """det A = I_1 I_2 + I_3 (I_1 + I_2)."""
    with pytest.raises(bg.SingularStorageError, match=r"f_I_[12]' is not determined"):
        bg.derive(_coupled(*values))


@pytest.mark.parametrize("number", [2, 3, 5, 31, 41, 53, 101])
def test_roots_that_make_the_mass_matrix_singular_are_refused(number: int) -> None:
    """With w = sqrt(n): w + I_3 (w + 1) = 0 where I_3 = -w/(w + 1) = (w - n)/(n - 1)."""
    third = f"(sqrt({number}) - {number})/({number} - 1)"
    with pytest.raises(bg.SingularStorageError, match=r"f_I_[12]' is not determined"):
        bg.derive(_coupled(f"sqrt({number})", 1, third))


def test_inertias_that_cancel_each_other_are_refused() -> None:
    nodes = [bg.Se("s", "u"), bg.One("j"), bg.I("a", "m"), bg.I("b", "-m")]
    with pytest.raises(bg.SingularStorageError, match="f_a' cancel each other"):
        bg.derive(bond_graph(nodes, "s>j j>a j>b"))


def test_negative_inertia_is_accepted_where_it_leaves_the_matrix_regular() -> None:
    assert bg.derive(_coupled(2, 2, "-1/2")).A.det() == 2
