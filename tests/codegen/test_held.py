"""What storages hold, asked of runs and given as their starts, on every route."""

import networkx as nx
import numpy as np
import pytest
from references.build import bond_graph

import bondgraph as bg
from codegen import (
    Family,
    Grid,
    final,
    integral,
    run_sparse,
    samples,
    simulator,
    sparse_model,
    sweep,
    to_c,
    to_python,
    trim,
)

NUMBERS = {"m": 2.0, "k": 8.0, "b": 0.1, "m2": 1.0}
HELD, STATES = {"p_m": 3.0, "q_k": 0.5}, {"v": 1.5, "e_k": 4.0}
TIMES = np.linspace(0.0, 1.0, 5)


def _graph() -> nx.DiGraph:
    """A mass on a spring that drives another one by a lever."""
    nodes = [bg.Se("F", "F"), bg.One("j"), bg.I("m", "m", flow="v"), bg.C("k", "1/k"), bg.R("b", "b"),
             bg.TF("lever", "2"), bg.One("o"), bg.I("m2", "m2")]  # fmt: skip
    return bond_graph(nodes, "F>j>m j>k j>b j>lever>o>m2")


def _coils() -> nx.DiGraph:
    nodes = [bg.One("a"), bg.One("b"), bg.R("R_1", "1"), bg.R("R_2", "1"),
             bg.I("L", [["3", "1"], ["1", "2"]], ports=["a", "b"])]  # fmt: skip
    graph = bond_graph(nodes, "a>R_1 b>R_2")
    graph.add_edge("a", "L", port="a")
    graph.add_edge("b", "L", port="b")
    return graph


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_runs_begin_with_what_storages_hold_and_tell_it(backend: str) -> None:
    ready = simulator(bg.derive(_graph()), NUMBERS, backend=backend)
    run, other = (ready.run(TIMES, start, {"F": 1.0}) for start in (HELD, STATES))
    for name in ("v", "e_k"):
        assert (run[name] == other[name]).all()
    assert run["p_m"] == pytest.approx(2 * run["v"])
    assert run["q_k"] == pytest.approx(run["e_k"] / 8)
    # Of a dependent inertia, too: the lever halves the speed.
    assert run["p_m2"] == pytest.approx(run["f_m2"])


def test_exports_begin_with_what_storages_hold() -> None:
    equations = bg.derive(_graph())
    one, other = (
        to_c(equations, NUMBERS, initial=start, inputs={"F": 1.0}, main=True)
        for start in (HELD, STATES)
    )
    assert one == other
    assert to_python(equations, NUMBERS, initial=HELD) == to_python(
        equations, NUMBERS, initial=STATES
    )


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_sweeps_begin_with_what_storages_hold_at_each_runs_numbers(backend: str) -> None:
    family = Family(bg.derive(_graph()), NUMBERS, backend=backend)
    found = sweep(family, {"m": [1.0, 2.0, 4.0]}, TIMES, {"v": final("v"), "begin": _first},
                  initial=HELD, inputs={"F": 1.0}, workers=0, progress=False)  # fmt: skip
    assert found["begin"] == pytest.approx([3.0, 1.5, 0.75])


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_what_storages_hold_is_swept(backend: str) -> None:
    """v = p/m at the start, whatever m is; of a field the state beside it rules, too: 3 a + b = p."""
    family = Family(bg.derive(_graph()), NUMBERS, backend=backend)
    found = sweep(family, Grid(p_m=[2.0, 3.0], m=[1.0, 4.0]), TIMES,
                  {"begin": _first, "p": samples("p_m"), "sum": integral("p_m"), "way": integral("v")},
                  initial={"q_k": 0.5}, inputs={"F": 1.0}, workers=0, progress=False)  # fmt: skip
    assert not found.failed
    assert found["begin"] == pytest.approx([2.0, 0.5, 3.0, 0.75])
    assert found["p"][:, 0] == pytest.approx([2.0, 2.0, 3.0, 3.0])
    assert found["sum"] == pytest.approx(np.array([1.0, 4.0, 1.0, 4.0]) * found["way"])
    family = Family(bg.derive(_coils()), {}, backend=backend)
    found = sweep(family, {"p_L_a": [5.0, 8.0], "f_L_b": [2.0]}, TIMES, {"begin": _first_flow},
                  workers=0, progress=False)  # fmt: skip
    assert found["begin"] == pytest.approx([1.0, 2.0])


def test_a_sweep_tells_of_each_run_whose_starts_states_cannot_hold() -> None:
    family = Family(bg.derive(_coils()), {})
    found = sweep(
        family, {"p_L_a": [5.0]}, TIMES, {"begin": _first_flow}, workers=0, progress=False
    )
    assert "tell all that is held" in found.failed[0].message
    family = Family(bg.derive(_graph()), NUMBERS)
    found = sweep(family, {"p_m": [5.0], "v": [1.0]}, TIMES, {"begin": _first},
                  inputs={"F": 1.0}, workers=0, progress=False)  # fmt: skip
    assert "p_m: it is m*v, which other states rule, or are told" in found.failed[0].message


def test_sparse_runs_begin_with_what_storages_hold_and_tell_it() -> None:
    model = sparse_model(_graph(), NUMBERS)
    run, other = (run_sparse(model, TIMES, start, {"F": 1.0}) for start in (HELD, STATES))
    assert (run["v"] == other["v"]).all()
    assert run["p_m"] == pytest.approx(2 * run["v"])
    assert run["q_k"] == pytest.approx(run["e_k"] / 8)
    for start, says in (
        ({"p_m": 1.0, "v": 2.0}, "p_m: it is 2\\*v, which is told, too"),
        ({"p_m2": 1.0}, "'p_m2' is not a state"),
    ):
        with pytest.raises(bg.SignalError, match=says):
            run_sparse(model, TIMES, start, {"F": 1.0})


def test_what_storages_hold_is_integrated() -> None:
    """Of a mass without force p stays: its integral is p t."""
    ready = simulator(
        bg.derive(bond_graph([bg.One("j"), bg.I("m", "m", flow="v")], "j>m")), {"m": 2.0}
    )
    run = ready.run(TIMES, {"p_m": 3.0})
    assert run.integral("p_m") == pytest.approx(3 * TIMES)


def test_a_trim_begins_with_what_storages_hold() -> None:
    """``p**3 - p = F`` rests at several momenta: the start says at which."""
    nodes = [bg.Se("F", 0), bg.One("j"), bg.I("m", "m", flow="v"), bg.R("b", law="v**3 - v")]
    ready = simulator(bg.derive(bond_graph(nodes, "F>j>m j>b")), {"m": 2.0})
    for momentum, speed in ((1.9, 1.0), (-1.9, -1.0)):
        assert trim(ready, initial={"p_m": momentum})["v"] == pytest.approx(speed)


@pytest.mark.parametrize("value", ["3", None, 1j, float("nan"), True])
def test_what_is_no_number_is_not_held(value: object) -> None:
    with pytest.raises(bg.SignalError, match=r"initial p_m: .* is not a finite number"):
        simulator(bg.derive(_graph()), NUMBERS).run(TIMES, {"p_m": value}, {"F": 1.0})  # type: ignore[dict-item]


def _first_flow(run: object) -> float:
    return float(run["f_L_a"][0])  # type: ignore[index]


def _first(run: object) -> float:
    return float(run["v"][0])  # type: ignore[index]


def test_a_fields_flows_follow_from_all_that_it_holds() -> None:
    """3 f_a + f_b = 5, f_a + 2 f_b = 5: f_a = 1, f_b = 2."""
    ready = simulator(bg.derive(_coils()), {})
    run = ready.run([0.0, 1.0], {"p_L_a": 5.0, "p_L_b": 5.0})
    assert [run["f_L_a"][0], run["f_L_b"][0]] == pytest.approx([1.0, 2.0])
    assert ready.run([0.0, 1.0], {"p_L_a": 5.0, "f_L_b": 2.0})["f_L_a"][0] == pytest.approx(1.0)
    with pytest.raises(bg.SignalError, match="tell all that is held"):
        ready.run([0.0, 1.0], {"p_L_a": 5.0})


@pytest.mark.parametrize(
    ("start", "says"),
    [
        ({"p_m2": 1.0}, "p_m2: it is f_m2\\*m2, which other states rule"),
        ({"p_m": 1.0, "v": 2.0}, "p_m: it is m\\*v, which other states rule, or are told"),
        ({"p_x": 1.0}, "'p_x' is not a state"),
    ],
)
def test_what_states_rule_is_no_start(start: dict[str, float], says: str) -> None:
    with pytest.raises(bg.SignalError, match=says):
        simulator(bg.derive(_graph()), NUMBERS).run(TIMES, start, {"F": 1.0})


def test_a_storage_by_its_inverse_begins_by_its_law() -> None:
    """``f = p + p**3`` rubbing: its flow is the state, and p = 2 is f = 10."""
    nodes = [
        bg.One("j"),
        bg.I("m", law="p_m + p_m**3", flow="v"),
        bg.R("rub", law=bg.DryFriction("1")),
    ]
    ready = simulator(bg.derive(bond_graph(nodes, "j>m j>rub")), {})
    run = ready.run([0.0, 1.0, 3.0], {"p_m": 2.0})
    assert run["v"][0] == pytest.approx(10.0)
    # Friction takes p at one newton: 2, 1, and held at 0.
    assert run["p_m"] == pytest.approx([2.0, 1.0, 0.0], abs=1e-9)
