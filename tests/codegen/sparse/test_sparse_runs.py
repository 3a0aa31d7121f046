"""Runs of sparse models: against `simulator`, closed forms and matrix exponentials."""

from collections.abc import Callable
from functools import cache
from typing import TYPE_CHECKING, Any

import networkx as nx
import numpy as np
import pytest
import scipy.linalg
from references.build import bond_graph

import bondgraph as bg
from codegen import (
    Constant,
    Lag,
    Ramp,
    Sampled,
    Signal,
    Simulator,
    Sine,
    Step,
    run_sparse,
    simulator,
)
from codegen import sparse_model as sparse
from codegen.sparse.model import SparseModel
from codegen.sparse.steps import STIFF

if TYPE_CHECKING:
    Graph = nx.DiGraph[Any]
else:
    Graph = nx.DiGraph

METHODS = ["auto", "DOP853", "Radau"]
TIMES = np.linspace(0.0, 2.0, 41)
SIGNALS: dict[str, Signal] = {
    "constant": Constant(3.0),
    "step": Step(0.33, 5.0, -1.0),
    "step on a sample": Step(0.5, 5.0),
    "two steps": Step(0.25, 2.0) + Step(1.2, -7.0),
    "lag of a step": Lag(Step(0.4, 6.0), 0.1),
    "ramp": Ramp(0.3, 4.0, end=0.9),
    "sine": Sine(2.0, 0.7, 0.3, 1.0),
    "samples": Sampled([0.1, 0.6, 1.4], [0.0, 3.0, -2.0]),
}


def _mass_chain() -> Graph:
    """A force on a geared pair, a spring, a damped mass; the second wheel is dependent."""
    nodes = [bg.Se("force", "u"), bg.One("a"), bg.I("m1", "m1", flow="v1"), bg.TF("gear", "n"),
             bg.One("b"), bg.I("m2", "m2", priority=-1), bg.Zero("z"), bg.C("spring", "c", effort="F"),
             bg.One("d"), bg.I("m3", "m3", flow="v3"), bg.R("damper", "b")]  # fmt: skip
    return bond_graph(nodes, "force>a>m1 a>gear>b>m2 b>z>spring z>d>m3 d>damper")


CHAIN = {"m1": 0.7, "m2": 0.4, "n": 1.5, "c": 0.05, "m3": 1.3, "b": 0.9}
SEEN = ["m1", "m2", "m3", "spring", "b", "force", "damper"]


def _driven() -> Graph:
    """A speed drives a mass, which is dependent, by a gear another and by a damper a third."""
    nodes = [bg.Sf("speed", "s"), bg.One("a"), bg.I("m1", "m1"), bg.Zero("z"), bg.I("m2", "m2", flow="v"),
             bg.C("coupling", "c", effort="F"), bg.Zero("y"), bg.Sf("other", "r"), bg.One("w"),
             bg.I("m3", "m3", flow="w3")]  # fmt: skip
    return bond_graph(nodes, "speed>a>m1 a>z>coupling z>w>m2 w>y>m3 other>y")


DRIVEN = {"m1": 0.6, "m2": 0.8, "m3": 0.5, "c": 0.1}
"""m3 turns at v + r: A couples v with r', so E is not zero."""


@cache
def _made(graph: Callable[[], Graph], outputs: tuple[str, ...]) -> tuple[Simulator, SparseModel]:
    """A model either way, for all runs of it."""
    values = {_mass_chain: CHAIN, _driven: DRIVEN, _balanced: {}}[graph]
    exact = simulator(bg.derive(graph(), outputs=outputs), values)
    return exact, sparse(graph(), values, outputs)


def _compare(
    graph: Callable[[], Graph], inputs: dict[str, object], outputs: list[str],
    initial: dict[str, float], method: str = "auto",
) -> None:  # fmt: skip
    exact, model = _made(graph, tuple(outputs))
    run = exact.run(TIMES, initial, inputs)
    result = run_sparse(model, TIMES, initial, inputs, method, 1e-10, 1e-12)
    assert result.states == run.states
    assert result.inputs == run.inputs
    assert result.outputs == run.outputs
    for name in (*result.states, *result.inputs, *result.outputs):
        scale = max(1.0, np.abs(run[name]).max())
        assert result[name] == pytest.approx(run[name], abs=2e-8 * scale), name


@pytest.mark.parametrize("signal", SIGNALS)
def test_a_run_with_a_dependent_wheel_is_that_of_simulator(signal: str) -> None:
    """Outputs m1 and m3 are forces, which hold accelerations."""
    _compare(_mass_chain, {"u": SIGNALS[signal]}, SEEN, {"v1": 0.3, "F": -2.0, "v3": 1.0})


@pytest.mark.parametrize("method", METHODS)
def test_every_method_gives_the_run_of_simulator(method: str) -> None:
    _compare(_mass_chain, {"u": Lag(Step(0.2, 4), 0.05)}, SEEN, {"F": 1.0}, method)


@pytest.mark.parametrize("signal", SIGNALS)
def test_a_run_whose_rates_hold_rates_of_inputs(signal: str) -> None:
    """``E u'``: the state steps with an input that steps, as in simulator."""
    assert bg.derive(_driven()).E.todok()
    inputs: dict[str, object] = {"s": 1.5, "r": SIGNALS[signal]}
    _compare(_driven, inputs, ["coupling", "w"], {"F": 0.5})


@pytest.mark.parametrize("signal", ["constant", "lag of a step", "ramp", "sine", "samples"])
def test_outputs_that_show_rates_of_inputs(signal: str) -> None:
    inputs: dict[str, object] = {"s": SIGNALS[signal], "r": SIGNALS[signal]}
    _compare(_driven, inputs, ["speed", "other", "m2", "m1"], {"F": 0.5})


def test_a_state_steps_with_its_input_by_hand() -> None:
    """m3 turns at v + r or v - r: with r a step and nothing else, (m2 + m3) v stays minus m3 r."""
    nodes = [bg.Sf("r", "r"), bg.Zero("y"), bg.One("x"), bg.I("m2", 3, flow="v"),
             bg.I("m3", 1, priority=-1)]  # fmt: skip
    model = sparse(bond_graph(nodes, "r>y>m3 x>m2 x>y"), {})
    result = run_sparse(model, [0, 1, 2], inputs={"r": Step(0.5, 8.0)})
    assert result["v"].tolist() == pytest.approx([0.0, -2.0, -2.0], abs=1e-12)


def test_known_sources_are_run() -> None:
    """A weight falls: v = g t - v_0."""
    nodes = [bg.Se("weight", "m*g"), bg.One("n"), bg.I("mass", "m", flow="v")]
    model = sparse(bond_graph(nodes, "weight>n>mass"), {"m": 2, "g": 9.81}, ["mass"])
    result = run_sparse(model, [1, 2, 4], {"v": -3.0})
    assert result.inputs == ()
    assert result["v"].tolist() == pytest.approx([-3, 6.81, 26.43], rel=1e-9)
    assert result["e_mass"].tolist() == pytest.approx([19.62] * 3)


@pytest.mark.parametrize("method", METHODS)
def test_a_model_without_states_is_run(method: str) -> None:
    """i = V/R + C V'."""
    nodes = [bg.Se("V", "V"), bg.Zero("n"), bg.C("c", "C"), bg.R("r", "R")]
    model = sparse(bond_graph(nodes, "V>n>c n>r"), {"C": 3, "R": 4}, ["V"])
    result = run_sparse(model, [0.0, 1.0, 2.0], inputs={"V": Ramp(0.5, 8.0)}, method=method)
    assert result[model.outputs[0]].tolist() == pytest.approx([0.0, 25.0, 27.0])


def _line(masses: int) -> Graph:
    """Masses of 1 kg in a row, springs of compliance 1 between them and to a wall at either end."""
    graph: Graph = nx.DiGraph()
    for k in range(masses + 1):
        graph.add_nodes_from([bg.Zero(f"z{k}"), bg.C(f"c{k}", 1, effort=f"F{k}")])
        graph.add_edge(f"z{k}", f"c{k}")
    for k in range(masses):
        graph.add_nodes_from([bg.One(f"x{k}"), bg.I(f"m{k}", 1, flow=f"v{k}")])
        graph.add_edges_from([(f"z{k}", f"x{k}"), (f"x{k}", f"m{k}"), (f"x{k}", f"z{k + 1}")])
    return graph


@pytest.mark.parametrize("method", ["DOP853", "Radau"])
@pytest.mark.parametrize("mode", [1, 3, 12])
def test_a_uniform_chain_swings_in_its_modes(mode: int, method: str) -> None:
    """v_k = sin(p k pi/(N + 1)) cos(w t), w = 2 sin(p pi/(2 (N + 1)))."""
    N = 12
    model = sparse(_line(N), {})
    shape = np.sin(mode * np.pi * np.arange(1, N + 1) / (N + 1))
    w = 2 * np.sin(mode * np.pi / (2 * (N + 1)))
    start = {f"v{k}": float(shape[k]) for k in range(N)}
    times = np.linspace(0.0, 10.0, 21)
    result = run_sparse(model, times, start, method=method)
    got = np.array([result[f"v{k}"] for k in range(N)]).T
    assert got == pytest.approx(np.outer(np.cos(w * times), shape), abs=2e-7)


def test_ten_thousand_states_run_as_their_modes() -> None:
    """A mode of 5,000 masses, with wavelengths of twenty of them."""
    N, mode = 5000, 500
    model = sparse(_line(N), {}, ["x7"])
    assert len(model.states) == 2 * N + 1
    shape = np.sin(mode * np.pi * np.arange(1, N + 1) / (N + 1))
    w = 2 * np.sin(mode * np.pi / (2 * (N + 1)))
    start = {f"v{k}": float(shape[k]) for k in range(N)}
    times = np.array([0.0, 1.5, 4.0])
    result = run_sparse(model, times, start)
    got = np.array([result[f"v{k}"] for k in range(N)]).T
    assert got == pytest.approx(np.outer(np.cos(w * times), shape), abs=2e-7)
    assert result["f_x7"] == pytest.approx(result["v7"], abs=1e-12)


def _ladder(cells: int, ends: float) -> Graph:
    """An RC line fed by a voltage; the capacities fall from 1 to ``ends``."""
    graph: Graph = nx.DiGraph()
    graph.add_nodes_from([bg.Se("V", "V")])
    last = "V"
    for k in range(cells):
        c = float(f"{ends ** (k / (cells - 1)):.3g}")
        graph.add_nodes_from([bg.One(f"i{k}"), bg.R(f"r{k}", 0.5), bg.Zero(f"n{k}")])
        graph.add_nodes_from([bg.C(f"c{k}", c, effort=f"u{k}")])
        nx.add_path(graph, [last, f"i{k}", f"n{k}", f"c{k}"])
        graph.add_edge(f"i{k}", f"r{k}")
        last = f"n{k}"
    return graph


@pytest.mark.parametrize("method", ["Radau", "auto"])
def test_a_stiff_line_is_charged_as_its_matrix_exponential_says(method: str) -> None:
    """x = (1 - exp(P t)) V with every voltage starting at zero, or at the initial ones given."""
    model = sparse(_ladder(30, 1e-7), {}, ["V"])
    P = np.linalg.solve(model.A.toarray(), model.J.toarray())
    assert np.abs(np.linalg.eigvals(P)).max() * 40 > STIFF
    times = np.array([0.0, 0.5, 4.0, 40.0])
    start = {"u0": 2.0, "u29": -1.0}
    result = run_sparse(model, times, start, {"V": 6.0}, method, 1e-9, 1e-11)
    x0 = np.array([start.get(name, 0.0) for name in model.states])
    expected = [6.0 + scipy.linalg.expm(P * t) @ (x0 - 6.0) for t in times]
    got = np.array([result[name] for name in model.states]).T
    assert got == pytest.approx(np.array(expected), abs=1e-6)
    assert result[model.outputs[0]] == pytest.approx((6.0 - got[:, 0]) / 0.5, abs=1e-5)


def test_initial_values_are_the_first_sample() -> None:
    model = sparse(_mass_chain(), CHAIN)
    result = run_sparse(model, TIMES, {"v1": 1.0, "F": -2.5}, {"u": 3.0})
    assert [result[name][0] for name in ("v1", "F", "v3")] == [1.0, -2.5, 0.0]
    assert result.time.tolist() == TIMES.tolist()


@pytest.mark.parametrize(
    ("initial", "match"),
    [({"F_2": 1.0}, "'F_2' is not a state"), ({"F": "1"}, "F"), ({"F": float("nan")}, "F"), ([], "map")],
)  # fmt: skip
def test_unusable_initial_values_are_refused(initial: dict[str, float], match: str) -> None:
    with pytest.raises(bg.SignalError, match=match):
        run_sparse(sparse(_mass_chain(), CHAIN), TIMES, initial, {"u": 0})


@pytest.mark.parametrize(
    ("inputs", "match"),
    [({}, "missing input.*u"), ({"u": 1, "x": 2}, "unknown input 'x'"), ({"u": "a"}, "u")],
)
def test_unusable_inputs_are_refused(inputs: dict[str, object], match: str) -> None:
    with pytest.raises(bg.SignalError, match=match):
        run_sparse(sparse(_mass_chain(), CHAIN), TIMES, None, inputs)


@pytest.mark.parametrize("time", [[0.0], [0.0, 0.0], [1.0, 0.0], [0.0, float("inf")], "now"])
def test_unusable_times_are_refused(time: list[float]) -> None:
    with pytest.raises(bg.SignalError, match="time"):
        run_sparse(sparse(_mass_chain(), CHAIN), time, None, {"u": 0})


@pytest.mark.parametrize(
    "settings", [{"method": "Euler"}, {"rtol": 0}, {"atol": -1.0}, {"rtol": "x"}]
)
def test_unusable_settings_are_refused(settings: dict[str, object]) -> None:
    with pytest.raises(bg.SignalError):
        run_sparse(sparse(_mass_chain(), CHAIN), TIMES, None, {"u": 0}, **settings)  # type: ignore[arg-type]


def test_what_was_not_recorded_is_refused() -> None:
    result = run_sparse(sparse(_mass_chain(), CHAIN, ["m2"]), TIMES, None, {"u": 1})
    assert set(result) == {"v1", "F", "v3", "u", "f_m2"}
    for ask in (
        lambda: result["e_m1"], lambda: result.bond("a", "m1"), lambda: result.power("m1"),
        lambda: result.energy("m1"),
    ):  # fmt: skip
        with pytest.raises(KeyError, match="not recorded"):
            ask()
    for ask in (lambda: result.work("m1"), lambda: result.integral("v1"), result.audit):
        with pytest.raises(bg.SignalError, match="not recorded: a sparse run knows no powers"):
            ask()


@pytest.mark.parametrize(
    ("output", "stepping"), [("speed", "s"), ("other", "r"), ("m2", "r"), ("m1", None), ("w", None)]
)
def test_steps_that_an_output_shows_as_impulses_are_refused(
    output: str, stepping: str | None
) -> None:
    """The force at a driven mass holds the rate of its speed; a jump of that is an impulse."""
    model = sparse(_driven(), DRIVEN, [output])
    for name in ("s", "r"):
        inputs: dict[str, object] = {"s": 1.0, "r": 1.0, name: Step(0.5, 2.0)}
        if name == stepping:
            with pytest.raises(bg.SimulationError, match=rf"input '{name}' steps at t = 0\.5"):
                run_sparse(model, TIMES, None, inputs)
            run_sparse(model, TIMES, None, inputs | {name: Lag(Step(0.5, 2.0), 0.1)})
        else:
            run_sparse(model, TIMES, None, inputs)


@pytest.mark.parametrize("at", [0.0, 2.0, 2.5, -1.0])
def test_steps_outside_of_the_run_are_refused_as_by_simulator(at: float) -> None:
    """A step at the very end shows in the last sample; one at the start or before is no step."""
    inputs: dict[str, object] = {"s": Step(at, 2.0), "r": 0.0}
    exact = simulator(bg.derive(_driven(), outputs=["speed"]), DRIVEN)
    refused = False
    try:
        exact.run(TIMES, None, inputs)
    except (bg.SignalError, bg.SimulationError):
        refused = True
    assert refused == (at == 2.0)
    model = sparse(_driven(), DRIVEN, ["speed"])
    if refused:
        with pytest.raises(bg.SimulationError):
            run_sparse(model, TIMES, None, inputs)
    else:
        run_sparse(model, TIMES, None, inputs)


def test_the_last_sample_after_a_step_at_the_end_is_that_of_simulator() -> None:
    inputs: dict[str, object] = {"s": 1.0, "r": Step(2.0, 4.0)}
    _compare(_driven, inputs, ["w"], {"F": 0.5})


def test_a_run_that_grows_beyond_all_numbers_is_ended() -> None:
    nodes = [bg.C("c", 1, effort="u"), bg.Zero("n"), bg.R("r", -1)]
    model = sparse(bond_graph(nodes, "n>c n>r"), {})
    with pytest.raises(bg.SimulationError):
        run_sparse(model, [0, 2000], {"u": 1.0})


def _balanced() -> Graph:
    """Capacitors at V + x, V + x and V - x: couplings 0.1 + 0.2 - 0.3 of V and x are nothing."""
    nodes = [bg.Se("V", "V"), bg.Zero("n"), bg.C("store", 1, effort="x"), bg.Zero("y"),
             bg.One("last"), bg.C("c_last", 0.5), bg.R("r", 2.0)]  # fmt: skip
    graph = bond_graph(nodes, "V>n y>store y>last>c_last y>r")
    for k, (c, turn) in enumerate([(0.1, 1), (0.2, 1), (0.3, -1)]):
        graph.add_nodes_from([bg.One(f"s{k}"), bg.TF(f"t{k}", turn), bg.C(f"c{k}", c)])
        nx.add_path(graph, ["n", f"s{k}", f"c{k}"])
        nx.add_path(graph, ["y", f"t{k}", f"s{k}"])
    return graph


def test_couplings_that_cancel_in_decimals_make_no_impulse() -> None:
    """x does not feel V at all, so a step of V is none of x' either."""
    assert not bg.derive(_balanced()).E.todok()
    _compare(_balanced, {"V": Step(0.5, 4.0)}, ["last"], {"x": 1.0})


@pytest.mark.parametrize("L", [1e-9, 1e-6, 1e-4])
def test_what_follows_an_input_at_once_is_not_stepped_over(L: float) -> None:
    """L i' = sin(w t) - i: the error estimate of an implicit method does not see i."""
    nodes = [bg.Se("e", "u"), bg.One("j"), bg.R("R", 1), bg.I("L", L, flow="i")]
    model = sparse(bond_graph(nodes, "e>j j>R j>L"), {})
    times = np.linspace(0, 4, 41)
    run = run_sparse(model, times, inputs={"u": Sine(1.0, 1.0)})
    w = 2 * np.pi
    steady = (np.sin(w * times) - w * L * np.cos(w * times)) / (1 + (w * L) ** 2)
    expected = steady - steady[0] * np.exp(-times / L)
    assert np.abs(run["i"] - expected).max() <= 2e-7


def test_exact_steps_are_no_method_of_sparse_models() -> None:
    nodes = [bg.Se("e", "u"), bg.One("j"), bg.R("R", 1), bg.I("L", 1, flow="i")]
    model = sparse(bond_graph(nodes, "e>j j>R j>L"), {})
    with pytest.raises(bg.SignalError, match="sparse models are integrated"):
        run_sparse(model, [0.0, 1.0], inputs={"u": 1.0}, method="exact")
