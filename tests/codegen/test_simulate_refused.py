"""Arguments that no run can use: each is refused by name before anything is integrated."""

import math

import numpy as np
import pytest
from oracles.models import oscillator, series_circuit
from references.build import bond_graph

import bondgraph as bg
from codegen import Step, simulator

CIRCUIT = bg.derive(series_circuit())
GOOD = {"R": 2.0, "L": 0.5, "C": 0.02}
RUN = simulator(CIRCUIT, GOOD)
TIMES = [0.0, 0.5, 1.0]


@pytest.mark.parametrize(
    ("time", "message"),
    [
        ([0.0, math.nan, 1.0], "time: a point is not finite"),
        ([0.0, 1.0, math.inf], "time: a point is not finite"),
        ([0.0, 1.0, 0.5], "time must increase; 1 is followed by 0.5"),
        ([1.0, 0.0], "time must increase; 1 is followed by 0"),
        ([0.0, 0.5, 0.5], "time must increase; 0.5 is followed by 0.5"),
        ([0.0], r"two or more points, not of shape \(1,\)"),
        ([], r"two or more points, not of shape \(0,\)"),
        (1.0, r"two or more points, not of shape \(\)"),
        ([[0.0, 1.0]], r"two or more points, not of shape \(1, 2\)"),
        (None, "time"),
        ("0, 1", "time must be numbers"),
        (["a", "b"], "time must be numbers"),
        ([0.0, 1j], "time must be numbers"),
        (np.array([0.0, 1j]), "time must be numbers: these are complex128"),
        ([0.0, np.complex128(1)], "time must be numbers"),
        (["0", "1"], "time must be numbers"),
        ([False, True], "time must be numbers: these are bool"),
        ([0.0, 10**400], "time must be numbers"),
    ],
)
def test_time_must_be_increasing_finite_points(time, message: str) -> None:
    with pytest.raises(bg.SignalError, match=message):
        RUN.run(time, inputs={"V": 1.0})


@pytest.mark.parametrize(
    ("inputs", "message"),
    [
        (
            None,
            r"missing input\(s\) V \(of Se 'source'\): give each a signal or a number in inputs",
        ),
        ({}, r"missing input\(s\) V"),
        ({"W": 1.0}, "unknown input 'W'; the model's inputs are V"),
        ({"V": 1.0, "i": 1.0}, "unknown input 'i'; the model's inputs are V"),
        ({"V": "1"}, "input 'V': '1' is neither a signal nor a number"),
        ({"V": None}, "input 'V': None is neither a signal nor a number"),
        ({"V": math.nan}, "input 'V': nan is not a finite number"),
        ({"V": 10**400}, "input 'V': 10+ is not a finite number"),
        ({"V": 1 + 5j}, r"input 'V': \(1\+5j\) is neither a signal nor a number"),
        ({"V": np.complex128(1 + 5j)}, r"input 'V': .*5j.* is neither a signal nor a number"),
        ({"V": np.bool_(True)}, "input 'V': .*True.* is neither a signal nor a number"),
        ([("V", 1.0)], "inputs must map names to values"),
        (5.0, "inputs must map names to values"),
    ],
)
def test_inputs_must_be_the_models_own(inputs, message: str) -> None:
    with pytest.raises(bg.SignalError, match=message):
        RUN.run(TIMES, inputs=inputs)


@pytest.mark.parametrize(
    ("parameters", "inputs", "message"),
    [
        ({"mass": 1, "k": 1}, {"F": 1}, r"missing input\(s\) f_bb \(did you mean 'f_b'\?; in"),
        ({"mas": 1, "k": 1}, {"F": 1}, r"missing parameter\(s\) mass \(did you mean 'mas'\?\); give each"),
        ({"mass": 1, "k": 1}, {"F": 1, "f_bc": 1}, r"unknown input 'f_bc' \(did you mean 'f_bb'\?\); the"),
    ],
)  # fmt: skip
def test_near_misses_are_told(parameters: dict, inputs: dict, message: str) -> None:
    nodes = [
        bg.Se("s", "F"),
        bg.One("n"),
        bg.I("m", "mass"),
        bg.R("d", law="k*abs(f_bb)", flow="f_b"),
    ]
    equations = bg.derive(bond_graph(nodes, "s>n>m n>d"))
    with pytest.raises(bg.BondGraphError, match=message):
        simulator(equations, parameters).run(TIMES, inputs=inputs)


def test_a_model_without_inputs_says_so() -> None:
    run = simulator(bg.derive(oscillator()), {"m": 1.0, "k": 1.0, "F_c": 1.0})
    with pytest.raises(bg.SignalError, match="unknown input 'P'; the model's inputs are none"):
        run.run(TIMES, inputs={"P": 1.0})


@pytest.mark.parametrize(
    ("initial", "message"),
    [
        ({"w": 1.0}, "'w' is not a state; there are i, v"),
        ({"V": 1.0}, "'V' is not a state; there are i, v"),
        ({"v": "1"}, "initial v: '1' is not a number"),
        ({"v": True}, "initial v: True is not a number"),
        ({"v": None}, "initial v: None is not a number"),
        ({"v": 1j}, "initial v: 1j is not a number"),
        ({"v": np.complex128(1 + 5j)}, "initial v: .*5j.* is not a number"),
        ({"v": 10**400}, "initial v: 10+ is not finite"),
        ({"v": [1.0]}, r"initial v: \[1.0\] is not a number"),
        ({"v": math.nan}, "initial v: nan is not finite"),
        ({"v": -math.inf}, "initial v: -inf is not finite"),
        ([1.0, 2.0], "initial must map names to values"),
    ],
)
def test_initial_values_must_be_numbers_of_states(initial, message: str) -> None:
    with pytest.raises(bg.SignalError, match=message):
        RUN.run(TIMES, initial, {"V": 1.0})


@pytest.mark.parametrize("method", ["RK45", "auto ", "", None, 3])
def test_methods_are_a_closed_list(method) -> None:
    with pytest.raises(
        bg.SignalError, match=r"unknown method .*; there are exact, auto, DOP853, Radau, CVODE"
    ):
        RUN.run(TIMES, inputs={"V": 1.0}, method=method)


@pytest.mark.parametrize("tolerances", [{"rtol": 0.0}, {"rtol": -1e-6}, {"rtol": math.nan}, {"atol": -1.0},
                                        {"atol": math.nan}, {"rtol": "1e-6"}, {"rtol": math.inf},
                                        {"atol": np.complex128(1e-9)}, {"rtol": True}])  # fmt: skip
def test_tolerances_must_be_positive_numbers(tolerances) -> None:
    with pytest.raises(bg.SignalError, match="tol"):
        RUN.run(TIMES, inputs={"V": 1.0}, **tolerances)


def test_backends_are_a_closed_list() -> None:
    with pytest.raises(bg.SignalError, match="unknown backend 'fortran'; there is numpy"):
        simulator(CIRCUIT, GOOD, backend="fortran")


@pytest.mark.parametrize("value", [1j, np.complex128(2 + 1j), "2", True, math.nan, math.inf, None])
def test_parameters_must_be_finite_real_numbers(value) -> None:
    with pytest.raises(bg.ParameterError, match=r"parameter 'R': .* is not a"):
        simulator(CIRCUIT, GOOD | {"R": value})


@pytest.mark.parametrize(
    ("t", "x", "u", "message"),
    [
        (math.nan, [0.0, 0.0], [1.0], "the time must be a finite number, not nan"),
        (1j, [0.0, 0.0], [1.0], "the time must be a finite number, not 1j"),
        (0.0, [0.0, math.inf], [1.0], r"states must be finite, not \[0.0, inf\]: \('i', 'v'\)"),
        (0.0, np.array([0.0, 1j]), [1.0], "x must be numbers: these are complex128"),
        (0.0, [0.0, 0.0], [math.nan], r"inputs must be finite, not \[nan\]"),
        (0.0, [0.0, 0.0], [np.complex128(1j)], "u must be numbers: these are complex128"),
    ],
)
def test_rates_are_asked_at_finite_real_numbers(t, x, u, message: str) -> None:
    with pytest.raises(bg.SignalError, match=message):
        RUN.rhs(t, x, u)


@pytest.mark.parametrize("missing", ["R", "L", "C"])
def test_a_missing_parameter_is_named(missing: str) -> None:
    numbers = {name: value for name, value in GOOD.items() if name != missing}
    with pytest.raises(
        bg.ParameterError, match=rf"missing parameter\(s\) {missing}; give each a number"
    ):
        simulator(CIRCUIT, numbers)


@pytest.mark.parametrize("name", ["i", "v", "t"])
def test_a_parameter_that_names_a_signal_is_refused(name: str) -> None:
    with pytest.raises(bg.ParameterError, match=f"parameter {name} names a signal of the model"):
        simulator(CIRCUIT, GOOD | {name: 1.0})


def test_laws_must_be_a_mapping() -> None:
    with pytest.raises(bg.BondGraphError, match="laws"):
        simulator(CIRCUIT, GOOD, laws=["V"])


def test_a_refused_run_leaves_the_simulator_usable() -> None:
    with pytest.raises(bg.SignalError, match="missing input"):
        RUN.run(TIMES)
    result = RUN.run(TIMES, inputs={"V": Step(0.5, 1.0)})
    assert np.isfinite(result["v"]).all()


def test_a_whole_run_is_no_start_but_where_it_ends_is() -> None:
    run = RUN.run(TIMES, {}, {"V": 1.0})
    with pytest.raises(
        bg.SignalError, match=r"not be a whole run; .*\{name: run\[name\]\[-1\] for name"
    ):
        RUN.run(TIMES, run, {"V": 1.0})
    assert (
        RUN.run(TIMES, {name: run[name][-1] for name in run.states}, {"V": 1.0})["i"][0]
        == run["i"][-1]
    )
