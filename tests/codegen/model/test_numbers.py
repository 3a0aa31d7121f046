"""A program with numbers: matrices solved for the rates, and numbers that cannot be."""

import math
from fractions import Fraction

import numpy as np
import pytest
import sympy as sp
from oracles.models import exact_rate, series_circuit
from references.build import bond_graph

import bondgraph as bg
from codegen import simulator
from codegen.model.exact_values import exact_parameters
from codegen.model.numbers import numbers
from codegen.program.lower import lower

CIRCUIT = bg.derive(series_circuit())
GOOD = {"R": 5.0, "L": 0.3, "C": 0.02}


def _geared(second: str = "m2") -> bg.StateEquations:
    """Two masses joined by a gear: A = m1 + r^2 m2, one of them dependent."""
    nodes = [bg.Se("s", "P"), bg.One("n"), bg.I("m1", "m1", flow="v"), bg.TF("gear", "r"),
             bg.One("o"), bg.I("m2", second)]  # fmt: skip
    return bg.derive(bond_graph(nodes, "s>n>m1 n>gear>o>m2"))


def test_matrices_are_solved_for_the_rates() -> None:
    program = lower(CIRCUIT, parameters=GOOD)
    found = numbers(program, CIRCUIT, exact_parameters(GOOD))
    assert pytest.approx(np.diag([0.3, 0.02]), rel=1e-15) == found.A
    assert pytest.approx(np.array([[-5 / 0.3, -1 / 0.3], [50.0, 0.0]]), rel=1e-14) == found.P
    assert pytest.approx(np.array([[1 / 0.3], [0.0]]), rel=1e-14) == found.Q
    assert not found.R.any()


@pytest.mark.parametrize("seed", range(5))
def test_a_dependent_mass_counts_with_the_square_of_the_ratio(seed: int) -> None:
    rng = np.random.default_rng(seed)
    values = {name: round(float(rng.uniform(0.1, 9)), 3) for name in ("m1", "m2", "r")}
    rate = simulator(_geared(), values).rhs(0.0, [1.0], [2.0])
    expected = 2.0 / (values["m1"] + values["r"] ** 2 * values["m2"])
    assert rate == pytest.approx([expected], rel=1e-14)
    assert rate == pytest.approx(exact_rate(_geared(), values, [1.0], [2.0]), rel=1e-14)


@pytest.mark.parametrize(
    "value", [3, 3.0, np.float64(3), np.int32(3), Fraction(3), sp.Integer(3), sp.Rational(6, 2)]
)
def test_numbers_of_every_type_are_taken(value: object) -> None:
    assert exact_parameters({"R": value}) == {"R": sp.Integer(3)}


def test_a_float_stands_for_its_shortest_decimal() -> None:
    assert exact_parameters({"R": 0.1})["R"] == sp.Rational(1, 10)


@pytest.mark.parametrize("value", ["3", None, True, 1j, [3], np.array(3.0), sp.Symbol("x")])
def test_parameters_must_be_numbers(value: object) -> None:
    with pytest.raises(bg.ParameterError, match=r"parameter 'R': .* (not|neither) a number"):
        simulator(CIRCUIT, GOOD | {"R": value})


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, sp.nan, sp.oo, np.float64("nan")])
def test_parameters_must_be_finite(value: object) -> None:
    with pytest.raises(bg.ParameterError, match=r"parameter 'R': .* is not a finite number"):
        simulator(CIRCUIT, GOOD | {"R": value})


def test_names_of_parameters_are_texts() -> None:
    with pytest.raises(bg.ParameterError, match="a parameter's name must be a text"):
        simulator(CIRCUIT, {**GOOD, sp.Symbol("R"): 3.0})


def test_parameters_must_be_a_mapping() -> None:
    with pytest.raises(bg.BondGraphError, match="parameters"):
        simulator(CIRCUIT, [("R", 3.0)])


CANCELLING = [
    {"m1": 0.1, "m2": -0.1, "r": 1}, {"m1": 0.3, "m2": -0.1, "r": Fraction(1732, 1000)},
    {"m1": 0.09, "m2": -1.0, "r": 0.3}, {"m1": 0.7, "m2": -0.7, "r": -1},
]  # fmt: skip


@pytest.mark.parametrize("values", CANCELLING)
def test_singularity_is_decided_exactly(values) -> None:
    """0.3^2 is not 0.09 in floats, but the decimals meant cancel; and a near miss is no singularity."""
    singular = Fraction(str(values["m1"])) + Fraction(str(values["r"])) ** 2 * Fraction(
        str(values["m2"])
    )
    if singular == 0:
        with pytest.raises(
            bg.ParameterError, match="the matrix A is singular: v' is not determined"
        ):
            simulator(_geared(), values)
    else:
        with pytest.warns(bg.ModelWarning, match="the energy stored in"):
            run = simulator(_geared(), values)
        rate = run.rhs(0.0, [1.0], [2.0])
        assert rate == pytest.approx([2.0 / float(singular)], rel=1e-9)


def test_values_that_cancel_along_a_chain_are_singular() -> None:
    """Three dependent masses whose sum is 0.1 + 0.2 - 0.3: zero, though not in floats."""
    nodes = [bg.One("n"), bg.Se("s", "P"), *(bg.I(f"m{i}", f"m{i}", flow="v") for i in (1, 2, 3))]
    equations = bg.derive(bond_graph(nodes, "s>n>m1 n>m2 n>m3"))
    assert 0.1 + 0.2 - 0.3 != 0
    with pytest.raises(bg.ParameterError, match="the matrix A is singular"):
        simulator(equations, {"m1": 0.1, "m2": 0.2, "m3": -0.3})


def test_a_storage_of_zero_is_refused() -> None:
    with pytest.raises(
        bg.ParameterError, match=r"'coil'.* L .*zero|singular: i' is not determined"
    ):
        simulator(CIRCUIT, GOOD | {"L": 0})


@pytest.mark.parametrize(
    ("value", "used", "numbers"),
    [
        ("1/k", {"k": 0}, "k = 0"), ("1/(k - 0.1)", {"k": 0.1}, "k = 0.1"),
        ("sqrt(k)", {"k": -1}, "k = -1"), ("log(k)", {"k": 0}, "k = 0"),
        ("1/(a - b)", {"a": 0.3, "b": 0.3}, "a = 0.3, b = 0.3"), ("asin(k)", {"k": 2}, "k = 2"),
    ],
)  # fmt: skip
def test_an_entry_without_a_finite_real_value_is_named(value: str, used, numbers: str) -> None:
    nodes = [
        bg.One("n"),
        bg.I("m", 1, flow="v"),
        bg.C("spring", value, effort="F"),
        bg.Se("s", "P"),
    ]
    equations = bg.derive(bond_graph(nodes, "n>m n>spring s>n"))
    with pytest.raises(
        bg.ParameterError, match=rf"A\[1, 1\] = .* has no finite real value at {numbers}"
    ):
        simulator(equations, used)


@pytest.mark.parametrize(("value", "used"), [("exp(k)", 1e4), ("k**3", 1e200), ("exp(exp(k))", 10)])
def test_an_entry_beyond_the_range_of_floats_is_refused(value: str, used: float) -> None:
    nodes = [bg.One("n"), bg.I("m", value, flow="v"), bg.Se("s", "P")]
    equations = bg.derive(bond_graph(nodes, "n>m s>n"))
    with pytest.raises(bg.ParameterError, match="no finite real value at"):
        simulator(equations, {"k": used})
