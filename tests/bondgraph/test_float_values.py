"""Floats as values change no structural decision.

A float counts as the rational of its shortest decimal form, both decide alike, and symbols likewise
unless a value makes an expression vanish.
"""

import random
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import networkx as nx
import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph
from references.random_graphs import random_graph
from soak.families import seeds

import bondgraph as bg
from codegen import simulator

if TYPE_CHECKING:
    Graph = nx.DiGraph[Any]
else:
    Graph = nx.DiGraph

STORED = (0.1, 0.2, 0.3, -0.1, -0.2, -0.3)
MODULI = (0.1, 10.0, 1.0, -1.0, 0.5, 2.0, -0.1)
"""Few values, so that sums and products cancel often; 0.1 + 0.2 - 0.3 in decimals only."""

FORMS: dict[str, Callable[[float], object]] = {
    "rational": lambda value: sp.Rational(str(value)),
    "fraction": lambda value: Fraction(str(value)),
    "text": str,
    "numpy": np.float64,
    "sympy": sp.Float,
    "sum": lambda value: sp.Float(value) + sp.Integer(0),
}
Outcome = tuple[object, ...]


def _drawn(seed: int, largest: int = 12) -> Graph:
    """A random graph with decimals for its values, negative ones as well."""
    rng = random.Random(seed)
    graph = random_graph(rng, rng.randint(3, largest), mesh=0.5)
    for _, attributes in graph.nodes(data=True):
        if str(attributes.get("value", "")).startswith("v"):
            attributes["value"] = rng.choice(
                MODULI if attributes["kind"] in ("TF", "GY") else STORED
            )
    return graph


def _written(graph: Graph, form: Callable[[float], object]) -> Graph:
    """The same graph with its floats in another form."""
    other: Graph = graph.copy()
    for _, attributes in other.nodes(data=True):
        if isinstance(attributes.get("value"), float):
            attributes["value"] = form(attributes["value"])
    return other


def _outcome(graph: Graph) -> Outcome:
    """States, inputs and matrices, or the refusal and its words."""
    outputs = [node for node in graph if graph.nodes[node]["kind"] not in ("TF", "GY")]
    try:
        equations = bg.derive(graph, outputs=outputs)
    except bg.BondGraphError as error:
        return type(error), str(error)
    names = (equations.states, equations.inputs, equations.outputs)
    return *names, *(getattr(equations, name) for name in "AJBEFDG")


@pytest.mark.parametrize("seed", seeds("float-values"))
def test_floats_are_derived_as_the_decimals_they_are_written_as(seed: int) -> None:
    graph = _drawn(seed)
    expected = _outcome(_written(graph, FORMS["rational"]))
    assert _outcome(graph) == expected
    form = sorted(FORMS)[seed % len(FORMS)]
    assert _outcome(_written(graph, FORMS[form])) == expected, form


def test_random_decimals_are_refused_for_all_reasons() -> None:
    outcomes = [_outcome(_drawn(seed)) for seed in range(150)]
    refusals = {outcome[0] for outcome in outcomes if len(outcome) == 2}
    assert {bg.CausalityError, bg.AlgebraicLoopError, bg.SingularStorageError} <= refusals
    assert sum(len(outcome) > 2 for outcome in outcomes) > 60


def _causality(graph: Graph) -> object:
    """Which storages are states and all strokes, or the type of the refusal."""
    try:
        causal = bg.assign_causality(graph)
    except bg.BondGraphError as error:
        return type(error)
    return causal.integral, causal.derivative, dict(causal.strokes)


def _prime_fractions(graph: Graph) -> Graph:
    """The same graph with floats of fifteen random digits: nothing vanishes but what always does."""
    rng = random.Random(1)
    return _written(graph, lambda _: round(rng.uniform(0.1, 1), 15))


@pytest.mark.parametrize("seed", seeds("symbols-as-floats"))
def test_symbols_decide_as_floats_unless_a_value_makes_something_vanish(seed: int) -> None:
    """Floats of many digits make nothing vanish."""
    graph = _prime_fractions(_drawn(seed))
    names = iter(f"p{k}" for k in range(1000))
    symbolic = _written(graph, lambda _: next(names))
    assert _causality(graph) == _causality(symbolic)
    outcome, general = _outcome(graph), _outcome(symbolic)
    assert (len(outcome) == 2) == (len(general) == 2)
    assert outcome[0] == general[0]
    for matrix, entries in zip(outcome[3:], general[3:], strict=False):
        assert isinstance(matrix, sp.ImmutableSparseMatrix)
        assert isinstance(entries, sp.ImmutableSparseMatrix)
        assert set(matrix.todok()) == set(entries.todok())


def _ring(first: object, second: object) -> Graph:
    """Two junctions joined by two transformers: the loop is undetermined where first * second = 1."""
    nodes = [bg.Se("u", "u"), bg.One("a"), bg.I("m", "m"), bg.TF("t1", first), bg.TF("t2", second),
             bg.One("b"), bg.R("r", "r")]  # fmt: skip
    return bond_graph(nodes, "u>a>m a>t1>b>t2>a b>r")


def _storages(first: object, second: object) -> Graph:
    """Two capacitors at one effort: A is their sum."""
    nodes = [bg.Sf("i", "i"), bg.Zero("n"), bg.C("c1", first), bg.C("c2", second)]
    return bond_graph(nodes, "i>n>c1 n>c2")


def _resistances(first: object, second: object) -> Graph:
    """A voltage over two resistances with a coil across the second: r1 + r2 must not vanish."""
    nodes = [bg.Se("V", "V"), bg.One("a"), bg.R("r1", first), bg.Zero("z"), bg.R("r2", second),
             bg.I("coil", 1)]  # fmt: skip
    return bond_graph(nodes, "V>a>r1 a>z>r2 z>coil")


def _three(c1: object, c2: object, c3: object) -> Graph:
    nodes = [bg.Sf("i", "i"), bg.Zero("n"), bg.C("c1", c1), bg.C("c2", c2), bg.C("c3", c3)]
    return bond_graph(nodes, "i>n>c1 n>c2 n>c3")


def _bridge(p: object, q: object, r: object) -> Graph:
    """Three transformers in parallel from an effort to a sum of efforts, (p + q - r) V, over a coil."""
    nodes = [bg.Zero("n"), bg.Se("V", "V"), bg.One("sum"), bg.TF("p", p), bg.TF("q", q), bg.TF("r", r),
             bg.I("coil", 1), bg.R("damper", 1)]  # fmt: skip
    return bond_graph(nodes, "V>n n>p>sum n>q>sum sum>r>n sum>coil sum>damper")


VANISHING: dict[str, tuple[Callable[..., Graph], tuple[float, ...], type[Exception]]] = {
    "storages 0.1 - 0.3 + 0.2": (_three, (0.1, 0.2, -0.3), bg.SingularStorageError),
    "storages 0.3 - 0.1 - 0.2": (_three, (0.3, -0.1, -0.2), bg.SingularStorageError),
    "two storages": (_storages, (0.7, -0.7), bg.SingularStorageError),
    "ring 0.1 * 10": (_ring, (0.1, 10.0), bg.AlgebraicLoopError),
    "resistances": (_resistances, (0.3, -0.3), bg.AlgebraicLoopError),
}


@pytest.mark.parametrize("case", VANISHING)
def test_what_vanishes_in_decimals_is_refused_in_every_form(case: str) -> None:
    build, values, error = VANISHING[case]
    expected = _outcome(build(*map(FORMS["rational"], values)))
    assert expected[0] is error
    assert _outcome(build(*values)) == expected
    for name, form in FORMS.items():
        assert _outcome(build(*map(form, values))) == expected, name


@pytest.mark.parametrize("case", VANISHING)
def test_what_is_nearly_nothing_is_accepted_in_every_form(case: str) -> None:
    """A last digit more than in the cases above, in every form that can say so."""
    build, values, _ = VANISHING[case]
    near = (float(np.nextafter(values[0], 1)), *values[1:])
    outcome = _outcome(build(*map(FORMS["rational"], near)))
    assert len(outcome) > 2
    assert _outcome(build(*near)) == outcome
    for name, form in FORMS.items():
        assert _outcome(build(*map(form, near))) == outcome, name


def test_a_sum_of_moduli_that_vanishes_in_decimals_shows_in_the_equations() -> None:
    """0.1 + 0.2 - 1/r with r = 1/0.3 as text: B is nothing in every form."""
    exact = _outcome(_bridge(sp.Rational(1, 10), sp.Rational(1, 5), sp.Rational(10, 3)))
    text = _outcome(_bridge("0.1", "0.2", "1/0.3"))
    assert text == exact
    assert _outcome(_bridge(0.1, 0.2, Fraction(10, 3))) == exact


def test_a_third_is_not_0_333() -> None:
    third = _outcome(_three(Fraction(1, 3), Fraction(1, 3), Fraction(-2, 3)))
    assert third[0] is bg.SingularStorageError
    near = _outcome(_three(0.333, 0.333, Fraction(-2, 3)))
    assert near[3] == sp.ImmutableSparseMatrix([[sp.Rational(-1, 1500)]])
    digits = sp.Rational("0.3333333333333333")
    long = _outcome(_three(1 / 3, 1 / 3, Fraction(-2, 3)))
    assert long[3] == sp.ImmutableSparseMatrix([[2 * digits - sp.Rational(2, 3)]])
    assert _outcome(_three(1 / 3, 1 / 3, -2 / 3))[0] is bg.SingularStorageError


def test_decimals_are_numbers_or_refused_alike_everywhere() -> None:
    """`decimal.Decimal` is exact: taken as it is written, or refused by name, but never rounded."""
    outcome = _outcome(_three(Decimal("0.1"), Decimal("0.2"), Decimal("-0.3")))
    assert outcome[0] in (bg.SingularStorageError, bg.ExpressionError)
    if outcome[0] is bg.ExpressionError:
        assert "node 'c1'" in str(outcome[1])


@pytest.mark.parametrize("small", [np.float32, np.float16])
def test_short_numpy_floats_are_the_decimals_they_print(small: type) -> None:
    values = (small(0.1), small(0.2), small(-0.3))
    assert _outcome(_three(*values)) == _outcome(_three("0.1", "0.2", "-0.3"))


@pytest.mark.parametrize("value", [0.1, 0.3, 1 / 3, 1e-7, 6.02e23, 1e22, 123456789.123456789])
def test_a_value_is_its_shortest_decimal(value: float) -> None:
    equations = bg.derive(_storages(value, value), outputs=[])
    assert equations.A[0, 0] == 2 * sp.Rational(repr(value))


SUM = {"a": 0.1, "b": 0.2, "c": -0.3}


@pytest.mark.parametrize("form", [float, np.float64, FORMS["rational"], FORMS["fraction"]])
def test_parameters_that_make_A_singular_in_decimals_are_refused(
    form: Callable[[float], object],
) -> None:
    equations = bg.derive(_three("a", "b", "c"))
    values = {name: form(value) for name, value in SUM.items()}
    with pytest.raises(bg.ParameterError, match="A is singular"):
        simulator(equations, values)
    near = values | {"a": form(0.1000000000000001)}
    with pytest.warns(bg.ModelWarning, match="the energy stored in"):
        run = simulator(equations, near)
    assert run.closed.constant.A[0, 0] == pytest.approx(1e-16, rel=0.9)


@pytest.mark.parametrize("form", [float, np.float64, FORMS["rational"], FORMS["fraction"]])
def test_parameters_that_make_a_loop_singular_in_decimals_are_refused(
    form: Callable[[float], object],
) -> None:
    """r1 + r2 = a + b + c = 0: there is no current."""
    equations = bg.derive(_resistances("a + b", "c"))
    values = {name: form(value) for name, value in SUM.items()}
    with pytest.raises(bg.ParameterError, match=r"no finite real value|without a solution"):
        simulator(equations, values)


def test_parameters_that_make_a_ring_undetermined_are_refused() -> None:
    """0.1 * 10 = 1: as values the ring is refused, so it must be as parameters."""
    with pytest.raises(bg.ParameterError):
        simulator(bg.derive(_ring("p", "q")), {"m": 1, "r": 1, "p": 0.1, "q": 10})


def test_parameters_that_make_a_value_vanish_in_decimals_are_refused() -> None:
    equations = bg.derive(_storages("a + b + c", 1))
    with pytest.raises(bg.ParameterError, match="C 'c1'"):
        simulator(equations, SUM)


@pytest.mark.parametrize("seed", seeds("late-values"))
def test_values_given_late_decide_as_values_given_early(seed: int) -> None:
    """Symbols with numbers in `simulator`: what decimals make singular is refused at both times."""
    graph = _drawn(seed)
    values: dict[str, float] = {}

    def named(value: float) -> str:
        values[name := f"p{len(values)}"] = value
        return name

    symbolic = _written(graph, named)
    early, late = _outcome(graph), _outcome(symbolic)
    if len(late) == 2 or len(early) > 2:
        return
    if early[0] in (bg.SingularStorageError, bg.AlgebraicLoopError, bg.CausalityError):
        with pytest.raises(bg.ParameterError):
            simulator(bg.derive(symbolic), values)
