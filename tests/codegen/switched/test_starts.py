"""What switches hold at a start completes the states that were not named, and a run tells so."""

import warnings

import numpy as np
import pytest
from references.build import bond_graph

import bondgraph as bg
from codegen import Constant, Family, Simulator, simulator, sweep, switched_simulator
from codegen.record.measures import final

NODES = [bg.One("a"), bg.I("m_1", "m_1", flow="v_1"), bg.Zero("gap"), bg.Sw("dog", on="gate"),
         bg.One("b"), bg.I("m_2", "m_2", flow="v_2"), bg.R("air", "d")]  # fmt: skip
EQUATIONS = bg.derive(bond_graph(NODES, "a>m_1 a>gap>dog gap>b>m_2 b>air"))
NUMBERS = {"m_1": 1.0, "m_2": 3.0, "d": 2.0}
SHUT = {"gate": -1.0}
"""The dog is off: it holds."""

T = np.linspace(0, 1, 5)


@pytest.fixture(scope="module", params=["numpy", "c"])
def ready(request: pytest.FixtureRequest) -> Simulator:
    return simulator(EQUATIONS, NUMBERS, backend=request.param)


@pytest.mark.parametrize(("named", "other"), [("v_1", "v_2"), ("v_2", "v_1")])
def test_what_is_not_named_follows_and_is_told(ready: Simulator, named: str, other: str) -> None:
    """Both slow down together: v = 4 exp(-d t/(m_1 + m_2))."""
    with pytest.warns(
        bg.ModelWarning, match=f"follow what switches hold at the start: {other} = 4; name them"
    ) as told:
        result = ready.run(T, {named: 4.0}, SHUT)
    assert len(told) == 1
    assert told[0].filename == __file__
    assert dict(result.completed) == pytest.approx({other: 4.0})
    for name in ("v_1", "v_2"):
        assert result[name] == pytest.approx(4 * np.exp(-T / 2), abs=1e-9)


@pytest.mark.parametrize(
    ("initial", "speed"),
    [({"v_1": 4.0, "v_2": 0.0}, 1.0), ({"v_1": 4.0, "v_2": 4.0}, 4.0), ({}, 0.0)],
    ids=["shares its momentum", "fits", "rests"],
)
def test_a_start_that_is_named_or_fits_is_not_told(
    ready: Simulator, initial: dict[str, float], speed: float
) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        result = ready.run(T, initial, SHUT)
    assert not result.completed
    assert result["v_2"] == pytest.approx(speed * np.exp(-T / 2), abs=1e-9)


def test_rounding_completes_nothing(ready: Simulator) -> None:
    """0.1 + 0.2 is not 0.3, and none of the states was meant to move."""
    nodes = [bg.Se("s_1", "u_1"), bg.Se("s_2", "u_2"), bg.One("w"), bg.Sw("k", on="1"),
             bg.C("c", 2, effort="u"), bg.C("d", 2, effort="v")]  # fmt: skip
    run = simulator(bg.derive(bond_graph(nodes, "s_1>w s_2>w w>k w>c w>d")), {})
    result = run.run([0.0, 1.0], {"u": 0.3}, {"u_1": 0.1, "u_2": 0.2})
    assert not result.completed


def test_a_switch_that_is_let_go_completes_nothing(ready: Simulator) -> None:
    """A gate of zero leaves the dog as it is told: on."""
    with pytest.warns(bg.ModelWarning, match="'dog' stays on while its command gate rests at zero"):
        result = ready.run(T, {"v_1": 4.0}, {"gate": 0.0}, initially_on=["dog"])
    assert not result.completed
    assert result["v_1"] == pytest.approx(np.full(5, 4.0))
    assert result["v_2"] == pytest.approx(np.zeros(5))


def test_a_source_completes_what_it_is_switched_onto() -> None:
    nodes = [bg.Se("s", "E"), bg.One("w"), bg.Sw("k", on="1 - t"), bg.C("c", 2, effort="u")]
    run = switched_simulator(bond_graph(nodes, "s>w>k w>c"), {})
    with pytest.warns(bg.ModelWarning, match="at the start: u = 5;") as told:
        result = run.run([0.0, 2.0], inputs={"E": Constant(5.0)}, initially_on=["k"])
    assert told[0].filename == __file__
    assert result["u"] == pytest.approx([5.0, 5.0])


def test_friction_completes_nothing() -> None:
    """A brake that could hold lets the start be what it is."""
    nodes = [bg.One("a"), bg.I("m_1", 1, flow="v_1"), bg.Zero("gap"), bg.R("rub", law=bg.DryFriction(8)),
             bg.One("b"), bg.I("m_2", 3, flow="v_2")]  # fmt: skip
    run = simulator(bg.derive(bond_graph(nodes, "a>m_1 a>gap>rub gap>b>m_2")), {})
    result = run.run([0.0, 1.0], {"v_1": 4.0})
    assert not result.completed
    assert result["v_2"] == pytest.approx([0.0, 1.0])


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_sweeps_complete_as_runs_do(backend: str) -> None:
    family = Family(EQUATIONS, NUMBERS, backend=backend)
    grid = {"d": [1.0, 2.0], "m_2": [1.0, 3.0]}
    with pytest.warns(bg.ModelWarning, match="in 4 of 4 runs states that initial does not name"):
        found = sweep(family, grid, T, {"one": final("v_1"), "two": final("v_2")}, {"v_1": 4.0},
                      SHUT, workers=0, progress=False)  # fmt: skip
    assert not found.failed
    for d, m, one, two in zip(*(found.table()[k] for k in ("d", "m_2", "one", "two")), strict=True):
        assert one == pytest.approx(4 * np.exp(-d / (1 + m)), abs=1e-9)
        assert two == pytest.approx(one, abs=1e-12)
