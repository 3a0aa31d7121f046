"""Linear models in numbers and transfer functions: closed forms, hand-written matrices, scipy.signal."""

import sys

import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph
from references.matrices import differences
from references.random_graphs import chain
from scipy import signal

import bondgraph as bg
from codegen import Ramp, simulator

C, L, R, b, c1, c2, k, m, n, p, r, s = sp.symbols("C L R b c1 c2 k m n p r s")
PAIR = {"m": 2.0, "n": 0.5, "k": 80.0, "b": 1.5}
DIVIDER = {"c1": 0.2, "c2": 0.3, "r": 4.0}


def _oscillator() -> bg.LinearModel:
    nodes = [bg.Se("s", "u"), bg.One("j"), bg.I("m", "m", flow="v"), bg.R("b", "b")]
    graph = bond_graph([*nodes, bg.C("k", "1/k", effort="F")], "s>j j>m j>k j>b")
    return bg.linearize(bg.derive(graph), outputs=["v", "F"])


def _pair() -> bg.StateEquations:
    """m v' = u - f, n w' = f + z, f = (k/s + b)(v - w)."""
    nodes = [bg.Se("s", "u"), bg.One("j"), bg.I("m", "m", flow="v"), bg.Zero("y"), bg.One("x")]
    nodes += [bg.C("k", "1/k", effort="F"), bg.R("b", "b"), bg.One("l"), bg.I("n", "n", flow="w")]
    nodes += [bg.Se("t", "z")]
    return bg.derive(bond_graph(nodes, "s>j>m j>y>x x>k x>b y>l>n t>l"), outputs=["j", "b", "n"])


def _divider() -> bg.StateEquations:
    """(c1 + c2) e1' = c2 v' + (v - e1)/r: the source drives a dependent capacitor, r beside it."""
    nodes = [bg.Se("v", "v"), bg.One("j"), bg.C("c1", "c1"), bg.Zero("z"), bg.C("c2", "c2")]
    graph = bond_graph([*nodes, bg.R("r", "r")], "v>j>c1 j>z>c2 z>r")
    return bg.derive(graph, outputs=["j", "z"])


def test_transfer_function_of_a_circuit() -> None:
    """A coil before a capacitor and a resistance side by side."""
    nodes = [bg.Se("s", "u"), bg.One("j"), bg.I("l", "L", flow="i"), bg.C("c", "C"), bg.R("r", "R")]
    equations = bg.derive(bond_graph([*nodes, bg.Zero("z")], "s>j j>l j>z z>c z>r"))
    model = bg.linearize(equations, outputs=["e_c", "i"])
    expected = sp.Matrix([R, 1 + R * C * s]) / (R * L * C * s**2 + L * s + R)
    assert differences(model.transfer_function(), expected) == {}
    assert differences(model.transfer_function("p"), expected.subs(s, p)) == {}


def test_transfer_functions_of_two_masses() -> None:
    found = bg.linearize(_pair(), outputs=["v", "w"]).transfer_function()
    both = s * (m * n * s**2 + (m + n) * (b * s + k))
    v, w, across = (n * s**2 + b * s + k), (m * s**2 + b * s + k), b * s + k
    assert differences(found, sp.Matrix([[v, across], [across, w]]) / both) == {}


def test_transfer_function_may_be_improper_and_may_be_too_long() -> None:
    found = bg.linearize(_divider(), outputs=["f_v"]).transfer_function()
    assert differences(found, [[s * c1 * (1 + s * r * c2) / (1 + s * r * (c1 + c2))]]) == {}
    with pytest.raises(bg.StructureError, match=r"of 10 states .*up to 8 states"):
        bg.linearize(bg.derive(chain(5))).transfer_function()


@pytest.mark.parametrize("damper", [0.0, 3.0, 19.0])
def test_oscillator_has_its_natural_frequency_and_damping(damper: float) -> None:
    model = _oscillator().numeric({"m": 2, "k": 50, "b": damper})
    root = np.sqrt(25 - (damper / 4) ** 2)
    assert model.poles() == pytest.approx([-damper / 4 - 1j * root, -damper / 4 + 1j * root])
    (mode,) = model.modes()
    assert mode.frequency == pytest.approx(5 / (2 * np.pi))
    assert mode.damped_frequency == pytest.approx(root / (2 * np.pi))
    assert mode.damping == pytest.approx(damper / (2 * np.sqrt(2 * 50)))
    # F' = k v, so pole F = k v; F is the larger one.
    assert dict(mode.shape) == pytest.approx({"v": mode.pole / 50, "F": 1})
    assert model.mode({"v": 1}) == mode
    assert model.dc_gain() == pytest.approx(np.array([[0], [1]]), abs=1e-15)


def test_poles_without_oscillation_come_slowest_first() -> None:
    model = _oscillator().numeric({"m": 1, "k": 6, "b": 5})
    assert model.poles() == pytest.approx([-2, -3])
    assert [mode.pole * mode.damping for mode in model.modes()] == pytest.approx([-2, -3])
    with pytest.raises(bg.SignalError, match="nothing oscillates: all poles are real"):
        model.mode({"v": 1, "F": 0})
    with pytest.raises(bg.SignalError, match="'x' is not a state; there are v, F"):
        model.mode({"x": 1})


@pytest.mark.parametrize(
    ("squares", "shapes"),
    [([1, 3], [[1, 1], [1, -1]]),
     ([2 - 2**0.5, 2, 2 + 2**0.5], [[1, 2**0.5, 1], [1, 0, -1], [1, -(2**0.5), 1]])],
)  # fmt: skip
def test_modes_of_equal_masses_between_walls(squares: list[float], shapes: list[object]) -> None:
    """Squares of the natural frequencies in k/m; the walls' distance adds a pole at 0."""
    count = len(squares)
    names = [f"v{i}" for i in range(count)]
    nodes = [node for i in range(count) for node in (bg.One(f"j{i}"), bg.I(f"m{i}", 2, f"v{i}"))]
    nodes += [bg.C(f"k{i}", "1/50") for i in range(count + 1)]
    nodes += [bg.Zero(f"z{i}") for i in range(1, count)]
    bonds = [f"j{i}>m{i}" for i in range(count)] + ["j0>k0", f"j{count - 1}>k{count}"]
    bonds += [f"j{i - 1}>z{i}>k{i} z{i}>j{i}" for i in range(1, count)]
    model = bg.linearize(bg.derive(bond_graph(nodes, " ".join(bonds)))).numeric({})
    modes = [mode for mode in model.modes() if mode.frequency > 1e-6]
    assert np.array([mode.pole for mode in modes]) == pytest.approx(5j * np.sqrt(squares))
    for at, (mode, shape) in enumerate(zip(modes, shapes, strict=True)):
        found = np.array([mode.shape[name] for name in names])
        assert found / found[0] == pytest.approx(np.array(shape), abs=1e-9)
        line = dict(zip(names, shape, strict=True))
        assert model.mode(line).pole == pytest.approx(mode.pole)
        assert [m.share(line) for m in modes] == pytest.approx(np.eye(count)[at], abs=1e-9)


@pytest.mark.filterwarnings("ignore::scipy.signal.BadCoefficients")
def test_responses_are_those_of_hand_written_matrices() -> None:
    """States v, F, w; outputs v, v - w, n w'."""
    m, n, k, b = PAIR.values()
    A = [[-b / m, -1 / m, b / m], [k, 0, -k], [b / n, 1 / n, -b / n]]
    B, C = np.array([[1 / m, 0], [0, 0], [0, 1 / n]]), np.array([[1, 0, 0], [1, 0, -1], [b, 1, -b]])
    D = np.array([[0, 0], [0, 0], [0, 1]])
    model = bg.linearize(_pair()).numeric(PAIR)
    assert (*model.states, *model.inputs) == ("v", "F", "w", "u", "z")
    found = model.frequency_response(hertz := np.geomspace(0.05, 50, 13))
    assert found.shape == (13, 3, 2)
    for i, j in np.ndindex(3, 2):
        system = signal.StateSpace(A, B[:, [j]], C[[i]], D[[i], j : j + 1])
        expected = signal.freqresp(system, 2 * np.pi * hertz)[1]
        assert found[:, i, j] == pytest.approx(expected, rel=1e-9)
    with pytest.raises(bg.ParameterError, match="a pole at 0, so a constant input has no steady"):
        model.dc_gain()


def test_scipy_and_the_simulator_run_alike() -> None:
    """A force that steps at 0 on one mass of two."""
    equations, times = _pair(), np.linspace(0, 2, 401)
    system = bg.linearize(equations).numeric(PAIR).to_scipy()
    found = signal.lsim(system, np.tile([3.0, -1.0], (401, 1)), times)[1].T
    run = simulator(equations, PAIR).run(times, inputs={"u": 3, "z": -1})
    assert found == pytest.approx(np.array([run[y] for y in run.outputs]), rel=1e-7, abs=1e-8)


def test_source_that_enters_by_its_rate_becomes_proper() -> None:
    """xi = e1 - c2/(c1 + c2) v, of the divider (1 + s r c2)/(1 + s r (c1 + c2)) of voltages."""
    equations = _divider()
    model = bg.linearize(equations, outputs=["e_c1", "e_z"]).numeric(DIVIDER)
    assert pytest.approx(np.array([[0.6]])) == model.R
    A, B, C, D = model.proper()
    assert np.hstack([A, B]) == pytest.approx(np.array([[-0.5, 0.2]]))
    assert np.hstack([C, D]) == pytest.approx(np.array([[1, 0.6], [-1, 0.4]]))
    assert model.transfer(1j)[0, 0] == pytest.approx((1 + 1.2j) / (1 + 2j))
    run = simulator(equations, DIVIDER).run(np.linspace(0, 3, 61), inputs={"v": Ramp(0, 2)})
    found = signal.lsim(model.to_scipy(), run["v"], run.time)[1]
    assert found == pytest.approx(np.array([run["e_c1"], run["e_z"]]).T, rel=1e-7, abs=1e-8)
    improper = bg.linearize(equations, outputs=["f_v"]).numeric(DIVIDER)
    with pytest.raises(bg.ParameterError, match="f_v shows the rate of v: no proper state"):
        improper.to_scipy()


def test_control_is_an_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "control", None)
    with pytest.raises(bg.MissingExtraError, match=r"pip install bondgraph-toolkit\[control\]"):
        _oscillator().numeric({"m": 2, "k": 50, "b": 3}).to_control()


def test_control_gets_the_names() -> None:
    system = _oscillator().numeric({"m": 2, "k": 50, "b": 3}).to_control()
    assert system.state_labels == system.output_labels == ["v", "F"]
    assert np.asarray(system.A) == pytest.approx(np.array([[-1.5, -0.5], [50, 0]]))


@pytest.mark.parametrize(
    ("values", "message"),
    [({"m": 1}, r"missing parameter\(s\) b, k; give each a number"),
     ({"m": 1, "b": float("inf"), "k": 1}, "parameter 'b': inf is not a finite number"),
     ({"m": 1, "b": 1, "k": 0}, "1/k has no finite real value"),
     ({"m": 0, "b": 1, "k": 1}, "A is singular at these parameters"),
     ([1], r"parameters must map names to numbers, not be \[1\]")],
)  # fmt: skip
def test_parameters_that_give_no_model_are_refused(values: object, message: str) -> None:
    with pytest.raises(bg.ParameterError, match=message):
        _oscillator().numeric(values)


def test_arrays_are_read_only_and_storages_may_differ_by_twelve_powers_of_ten() -> None:
    """Two inertias joined by the third through a summing gear: its speed is v - w."""
    nodes = [bg.Se("s", "u"), bg.One("x"), bg.I("m", "m", flow="v"), bg.Zero("z"), bg.One("y")]
    nodes += [bg.I("n", "n", flow="w"), bg.One("o"), bg.I("k", "k", priority=-1)]
    graph = bond_graph([*nodes, bg.R("b", "b")], "s>x>m x>z z>y>n z>o>k o>b")
    values = {"m": 1e-6, "n": 1e6, "k": 0.125, "b": 0.5}
    model = bg.linearize(bg.derive(graph)).numeric(values)
    exact = sp.Matrix([[m + k, -k], [-k, n + k]]).inv() * sp.Matrix([[-b, b, 1], [b, -b, 0]])
    exact = exact.subs({name: sp.Rational(str(value)) for name, value in values.items()})
    assert np.hstack([model.P, model.Q]) == pytest.approx(np.array(exact, dtype=float), rel=1e-12)
    for name in "PQRFDG":
        with pytest.raises(ValueError, match="read-only"):
            getattr(model, name).fill(1)
