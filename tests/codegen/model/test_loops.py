"""Laws that determine one another through the structure (D not zero) or by name."""

from contextlib import nullcontext

import numpy as np
import pytest
from references.build import bond_graph
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import lambertw

import bondgraph as bg
from codegen import Ramp, Sine, simulator

TIMES = np.linspace(0.0, 1.0, 41)
SHOCKLEY = "I_s*(exp(e_diode/V_T) - 1)"
DIODE = {"R": 50.0, "I_s": 1e-3, "V_T": 0.5}
SILICON = {"R": 50.0, "I_s": 1e-12, "V_T": 0.02585}


def _diode_and_resistance(law: str = SHOCKLEY) -> bg.StateEquations:
    nodes = [bg.Se("s", "V"), bg.One("n"), bg.R("r", "R"), bg.R("diode", law=law, gives="flow")]
    return bg.derive(bond_graph(nodes, "s>n>r n>diode"), outputs=["diode", "s"])


def _current(V: float, R: float, I_s: float, V_T: float) -> float:
    """The root of i = I_s (exp((V - R i)/V_T) - 1), in the diode's voltage."""

    def excess(v: float) -> float:
        return R * I_s * np.expm1(v / V_T) + v - V

    v = brentq(excess, min(V, 0.0) - 1e-9, max(V, 0.0) + 1e-9, xtol=1e-15, rtol=1e-14)
    return (V - v) / R


@pytest.mark.parametrize("values", [DIODE, SILICON], ids=["soft", "silicon"])
@pytest.mark.parametrize("amplitude", [0.1, 1.0, 12.0])
def test_diode_in_series_with_a_resistance(values, amplitude: float) -> None:
    result = simulator(_diode_and_resistance(), values).run(
        TIMES, inputs={"V": Sine(amplitude, 2.0)}
    )
    expected = [_current(V, **values) for V in result["V"].tolist()]
    assert result["f_s"] == pytest.approx(expected, rel=1e-8, abs=1e-12)
    assert result["e_diode"] == pytest.approx(result["V"] - 50 * result["f_s"], abs=1e-9)


@pytest.mark.usefixtures("closely")
def test_rectifier_charges_a_capacitor_through_the_loop() -> None:
    """C v' = i(V - v) - v/R_l with i by Lambert's W, integrated tightly."""
    nodes = [bg.Se("s", "V"), bg.One("n"), bg.R("r", "R"), bg.R("diode", law=SHOCKLEY, gives="flow"),
             bg.Zero("load"), bg.C("c", "C", effort="v"), bg.R("bleed", "R_l")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "s>n>r n>diode n>load>c load>bleed"))
    R, I_s, V_T, C, R_l = 50.0, 1e-3, 0.5, 1e-3, 400.0
    run = simulator(equations, DIODE | {"C": C, "R_l": R_l})
    # It charges, holds, and charges again.
    times = TIMES[TIMES <= 0.5]
    result = run.run(times, inputs={"V": Sine(10.0, 3.0)})

    def rate(t: float, y: np.ndarray) -> list[float]:
        drive = 10 * np.sin(6 * np.pi * t) - y[0]
        w = lambertw(I_s * R / V_T * np.exp((drive + I_s * R) / V_T)).real
        return [(V_T / R * w - I_s - y[0] / R_l) / C]

    expected = solve_ivp(
        rate, (0, 0.5), [0.0], "DOP853", times, rtol=1e-11, atol=1e-13, max_step=0.005
    )
    assert result["v"] == pytest.approx(expected.y[0], abs=1e-7)


def test_laws_that_name_each_other_are_solved_together() -> None:
    """a = v - b/2, b = tanh(a): one root, since a + tanh(a)/2 rises."""
    nodes = [
        bg.One("n"),
        bg.I("m", 2, flow="v"),
        bg.R("a", law="v - e_b/2"),
        bg.R("b", law="tanh(e_a)"),
    ]
    run = simulator(bg.derive(bond_graph(nodes, "n>m n>a n>b")), {})
    for v in (-3.0, -0.2, 0.0, 0.7, 5.0):
        a = brentq(lambda a, v=v: a + np.tanh(a) / 2 - v, -10, 10, xtol=1e-15)
        assert run.rhs(0.0, [v]) == pytest.approx([-(a + np.tanh(a)) / 2], abs=1e-10)


def test_a_linear_law_loop_is_the_linear_solution() -> None:
    """Two controlled sources about two resistances; D couples them both ways."""
    nodes = [bg.Se("s", "V"), bg.One("n"), bg.R("r", 2), bg.Zero("z"), bg.R("g", 5),
             bg.R("x", law="e_x/3 + 1", gives="flow"),
             bg.R("y", law="e_x/7 - f_x/2", gives="flow")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "s>n>r n>z>g z>x z>y"), outputs=["x"])
    result = simulator(equations, {}).run(TIMES, inputs={"V": Ramp(0.0, 4.0)})
    # (V - e)/2 = e/5 + f_x + f_y, f_x = e/3 + 1, f_y = e/7 - f_x/2.
    conductance = 1 / 2 + 1 / 5 + 1 / 3 / 2 + 1 / 7
    assert result["e_x"] == pytest.approx((4 * TIMES / 2 - 0.5) / conductance, abs=1e-9)


@pytest.mark.parametrize("law", ["e_diode**2 + V_0", "exp(e_diode) + V_0", "abs(e_diode) + V_0"])
def test_a_loop_without_a_solution_names_the_port(law: str) -> None:
    """f = e^2 + 1 with e = V - f has no real solution below V = 3/4; others likewise at V = 0.

    At V = 1 that has two, and f = |f + V| + 1 a stretch of them at V = -1.
    """
    # e = V - R f with R = -1: e = exp(e) + 1 has no root, nor has e = |e| + 1.
    numbers = {"R": 1.0 if "**" in law else -1.0, "V_0": 1.0}
    told = {"e": "2 real solutions where V = 1", "a": "more than one .* where V = -1"}
    with nullcontext() if "exp" in law else pytest.warns(bg.ModelWarning, match=told[law[0]]):
        run = simulator(_diode_and_resistance(law), numbers)
    with pytest.raises(
        bg.SimulationError, match=r"at t = 0 the laws at 'diode' depend on one another"
    ):
        run.run(TIMES, inputs={"V": 0.0})


def test_a_loop_that_loses_its_solution_says_when() -> None:
    """f = e^2 + 1, e = V - f: the roots meet at V = 3/4 + ... e^2 + e + 1 - V = 0 at V = 3/4."""
    with pytest.warns(bg.ModelWarning, match="2 real solutions where V = 1, f_diode = 1, 2;"):
        run = simulator(_diode_and_resistance("e_diode**2 + 1"), {"R": 1.0})
    result = run.run(TIMES, inputs={"V": Ramp(0.0, 1.0, 2.0)})
    e = result["e_diode"]
    assert e**2 + e + 1 - result["V"] == pytest.approx(np.zeros_like(e), abs=1e-8)
    with pytest.raises(bg.SimulationError, match=r"at t = 0\.[67]\d* the laws at 'diode'"):
        run.run(TIMES, inputs={"V": Ramp(0.0, -2.0, 2.0)})
