"""`Simulator.rhs` against exact arithmetic, and what it must not do: alias, guess, or mutate."""

import numpy as np
import pytest
from oracles.models import block, exact_rate, oscillator, series_circuit
from references.build import bond_graph

import bondgraph as bg
from codegen import simulator

CIRCUIT = bg.derive(series_circuit())


def _chain(n: int) -> bg.StateEquations:
    """Masses, springs and dampers in a row, one gear in the middle: some of everything."""
    nodes, bonds = [bg.Se("s", "P"), bg.Sf("wall", "V")], ["s>n0"]
    for i in range(n):
        nodes += [bg.One(f"n{i}"), bg.I(f"m{i}", f"m{i}"), bg.R(f"b{i}", f"b{i}"),
                  bg.Zero(f"z{i}"), bg.C(f"c{i}", f"1/k{i}")]  # fmt: skip
        bonds += [f"n{i}>m{i} n{i}>b{i} n{i}>z{i}>c{i}", f"z{i}>n{i + 1}" if i < n - 1 else ""]
    nodes += [bg.TF("gear", "r"), bg.One("g"), bg.I("dependent", "m_d")]
    return bg.derive(bond_graph(nodes, " ".join([*bonds, "n0>gear>g>dependent", f"z{n - 1}>wall"])))


@pytest.mark.parametrize("seed", range(8))
def test_rate_is_the_exact_one_at_random_points(seed: int) -> None:
    rng = np.random.default_rng(seed)
    equations = _chain(1 + seed % 3)
    values = {str(name): round(float(rng.uniform(0.2, 8)), 3) for name in equations.parameters}
    x, u = rng.normal(size=len(equations.states)), rng.normal(size=len(equations.inputs))
    found = simulator(equations, values).rhs(0.3, x, u)
    assert found == pytest.approx(exact_rate(equations, values, x, u), rel=1e-11, abs=1e-12)


def test_every_call_returns_a_fresh_array_and_leaves_its_arguments() -> None:
    run = simulator(CIRCUIT, {"R": 5.0, "L": 0.3, "C": 0.02})
    x, u = np.array([1.0, 2.0]), np.array([3.0])
    first = run.rhs(0.0, x, u)
    kept = first.copy()
    second = run.rhs(0.0, -x, 2 * u)
    assert not np.shares_memory(first, second)
    assert not np.shares_memory(first, x)
    first[:] = np.nan
    assert run.rhs(0.0, x, u) == pytest.approx(kept, rel=1e-15)
    assert (x == [1.0, 2.0]).all()
    assert (u == [3.0]).all()


def test_states_of_laws_come_last() -> None:
    nodes = [bg.One("n"), bg.C("s", law="k*q_s"), bg.I("m", "m", flow="v"), bg.Se("p", "P")]
    run = simulator(bg.derive(bond_graph(nodes, "n>s n>m p>n")), {"k": 8.0, "m": 2.0})
    assert run.states == ("v", "q_s")
    assert run.rhs(0.0, [0.5, 0.25], [10.0]) == pytest.approx([4.0, 0.5], rel=1e-15)


def test_known_sources_see_the_time() -> None:
    nodes = [bg.Se("s", "P_0*sin(t) + w"), bg.One("n"), bg.I("m", "m")]
    run = simulator(bg.derive(bond_graph(nodes, "s>n>m")), {"P_0": 3.0, "m": 2.0})
    assert run.inputs == ("w",)
    assert run.rhs(0.4, [0.0], [1.0]) == pytest.approx([(3 * np.sin(0.4) + 1) / 2], rel=1e-15)


@pytest.mark.parametrize(
    ("v", "push", "rate"),
    [(1.0, 3.0, 0.5), (-1.0, 3.0, 2.5), (0.0, 1.5, 0.0), (0.0, -1.5, 0.0), (0.0, 3.0, 0.5),
     (0.0, -3.0, -0.5), (0.0, 2.0, 0.0)],
)  # fmt: skip
def test_friction_opposes_slip_holds_at_rest_and_lets_go(
    v: float, push: float, rate: float
) -> None:
    run = simulator(bg.derive(block()), {"m": 2.0, "F_c": 2.0})
    assert run.rhs(0.0, [v], [push]) == pytest.approx([rate], abs=1e-15)


@pytest.mark.parametrize(("push", "rate"), [(2.5, 0.0), (-2.9, 0.0), (3.1, 0.55), (-3.1, -0.55)])
def test_at_rest_friction_holds_up_to_breakaway(push: float, rate: float) -> None:
    run = simulator(bg.derive(block(bg.DryFriction("F_c", 1, 1.5))), {"m": 2.0, "F_c": 2.0})
    assert run.rhs(0.0, [0.0], [push]) == pytest.approx([rate], abs=1e-15)


def test_a_held_mass_on_a_spring_has_no_acceleration() -> None:
    run = simulator(bg.derive(oscillator()), {"m": 2.0, "F_c": 2.0, "k": 10.0})
    assert run.rhs(0.0, [0.0, 1.9]) == pytest.approx([0.0, 0.0], abs=1e-15)
    assert run.rhs(0.0, [0.0, -2.4]) == pytest.approx([0.2, 0.0], abs=1e-15)


@pytest.mark.parametrize(
    ("x", "u", "message"),
    [
        ([1.0], [3.0], r"states must have shape \(2,\), not \(1,\)"),
        ([[1.0, 2.0]], [3.0], r"states must have shape \(2,\), not \(1, 2\)"),
        ([1.0, 2.0], [], r"inputs must have shape \(1,\), not \(0,\)"),
        ([1.0, 2.0], [1.0, 2.0], r"inputs must have shape \(1,\), not \(2,\)"),
        ([1.0, 2.0], 3.0, r"inputs must have shape \(1,\), not \(\)"),
    ],
)
def test_wrong_shapes_are_refused(x, u, message: str) -> None:
    run = simulator(CIRCUIT, {"R": 5.0, "L": 0.3, "C": 0.02})
    with pytest.raises(bg.SignalError, match=message):
        run.rhs(0.0, x, u)


@pytest.mark.parametrize(("x", "u"), [([1.0, "a"], [1.0]), ([1.0, 2.0], [1j]), ([[1.0], 2.0], [1])])
def test_what_is_not_a_number_is_refused(x, u) -> None:
    run = simulator(CIRCUIT, {"R": 5.0, "L": 0.3, "C": 0.02})
    with pytest.raises(bg.SignalError, match="must be numbers"):
        run.rhs(0.0, x, u)


@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize(
    "law", ["Piecewise((f, f < b), (b, True))", "Piecewise((7, a > b), (f, f < b), (b, a < b), (f, True))"]
)  # fmt: skip
def test_pieces_end_in_bare_parameters(law: str, backend: str) -> None:
    """A damper that saturates at b: ``f' = 3 - f`` up to b, then ``f' = 3 - b``."""
    nodes = [bg.Se("s", 3), bg.One("n"), bg.I("m", 1, flow="f"), bg.R("d", law=law)]
    equations = bg.derive(bond_graph(nodes, "s>n>m n>d"))
    values = {"b": 1.0, "a": 0.5} if "a" in law else {"b": 1.0}
    at = np.log(1.5)
    found = simulator(equations, values, backend=backend).run([0.0, 0.3, at, 1.0])["f"]
    expected = [0.0, 3 * (1 - np.exp(-0.3)), 1.0, 1 + 2 * (1 - at)]
    assert found == pytest.approx(expected, abs=1e-8)
