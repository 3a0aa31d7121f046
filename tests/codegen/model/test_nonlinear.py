"""Nonlinear springs, inertias and resistances against closed forms and tight integration."""

import numpy as np
import pytest
from references.build import bond_graph
from scipy.integrate import solve_ivp
from scipy.special import ellipj, ellipk

import bondgraph as bg
from codegen import simulator

TIMES = np.linspace(0.0, 6.0, 121)


def _tight(rate, start, times: np.ndarray) -> np.ndarray:
    found = solve_ivp(
        rate, (times[0], times[-1]), start, method="DOP853", t_eval=times, rtol=1e-12, atol=1e-14
    )
    return found.y


def _mass_with(*ports: tuple, mass: object = "m") -> bg.StateEquations:
    nodes = [bg.One("n"), bg.I("m", mass, flow="v"), *ports]
    bonds = " ".join(f"n>{name}" for name, _ in ports)
    return bg.derive(bond_graph(nodes, f"n>m {bonds}"))


@pytest.mark.usefixtures("closely")
def test_hardening_spring_vibrates_and_keeps_its_energy() -> None:
    """Duffing: m x'' + k x + c x^3 = 0."""
    m, k, c = 1.3, 4.0, 9.0
    run = simulator(_mass_with(bg.C("s", law="k*q_s + c*q_s**3")), {"m": m, "k": k, "c": c})
    assert run.states == ("v", "q_s")
    result = run.run(TIMES, {"q_s": 1.1, "v": -0.4})
    expected = _tight(lambda t, y: [-(k * y[1] + c * y[1] ** 3) / m, y[0]], [-0.4, 1.1], TIMES)
    assert result["v"] == pytest.approx(expected[0], abs=2e-8)
    assert result["q_s"] == pytest.approx(expected[1], abs=2e-8)
    q, v = result["q_s"], result["v"]
    energy = m * v**2 / 2 + k * q**2 / 2 + c * q**4 / 4
    assert energy == pytest.approx(np.full_like(energy, energy[0]), rel=1e-8)
    assert result["e_s"] == pytest.approx(k * q + c * q**3, rel=1e-13)


def test_pendulum_swings_in_the_period_of_the_elliptic_integral() -> None:
    """theta'' = -g/l sin(theta) from rest at theta_0: sin(theta/2) = k sn(K - w t; k)."""
    w, start = 3.0, 2.5
    result = simulator(_mass_with(bg.C("s", law="w**2*sin(q_s)"), mass=1), {"w": w}).run(
        TIMES, {"q_s": start}
    )
    k = np.sin(start / 2)
    sn = ellipj(ellipk(k**2) - w * TIMES, k**2)[0]
    assert result["q_s"] == pytest.approx(2 * np.arcsin(k * sn), abs=5e-8)


def test_momentum_is_the_state_of_a_nonlinear_inertia() -> None:
    """A constant force F on a relativistic mass: p = F t, v = p/sqrt(m^2 + (p/c)^2)."""
    nodes = [bg.Se("force", "F"), bg.One("n"), bg.I("m", law="p_m/sqrt(m_0**2 + (p_m/c)**2)")]
    run = simulator(
        bg.derive(bond_graph(nodes, "force>n>m"), outputs=["force"]), {"m_0": 2.0, "c": 5.0}
    )
    assert run.states == ("p_m",)
    result = run.run(TIMES, inputs={"F": 4.0})
    p = 4.0 * TIMES
    assert result["p_m"] == pytest.approx(p, abs=1e-9)
    assert result["f_force"] == pytest.approx(p / np.sqrt(4 + (p / 5) ** 2), abs=1e-9)


def test_drag_with_the_square_of_speed_gives_an_effort() -> None:
    """m v' = -c v |v|: v = v_0/(1 + c v_0 t/m), either way."""
    for start in (7.0, -7.0):
        result = simulator(_mass_with(bg.R("drag", law="c*v*abs(v)")), {"m": 2.0, "c": 0.5}).run(
            TIMES, {"v": start}
        )
        expected = start / (1 + 0.25 * 7.0 * TIMES)
        assert result["v"] == pytest.approx(expected, abs=1e-9)
        assert result["e_drag"] == pytest.approx(0.5 * expected * np.abs(expected), abs=1e-8)


@pytest.mark.usefixtures("closely")
def test_a_leak_with_the_cube_of_voltage_gives_a_flow() -> None:
    """C v' = -g v^3: v = v_0/sqrt(1 + 2 g v_0^2 t/C)."""
    nodes = [bg.Zero("n"), bg.C("c", "C", effort="v"), bg.R("leak", law="g*v**3", gives="flow")]
    result = simulator(bg.derive(bond_graph(nodes, "n>c n>leak")), {"C": 0.5, "g": 0.3}).run(
        TIMES, {"v": 4.0}
    )
    assert result["v"] == pytest.approx(4 / np.sqrt(1 + 2 * 0.3 * 16 / 0.5 * TIMES), abs=1e-9)


def test_the_same_law_on_received_variable_or_state_is_the_same() -> None:
    """The law may name what its port receives, or the state equal to it."""
    one, other = (
        simulator(_mass_with(bg.R("d", law=law, flow="w")), {"m": 2.0}).run(TIMES, {"v": 3.0})
        for law in ("tanh(v)", "tanh(w)")
    )
    assert one["v"] == pytest.approx(other["v"], rel=1e-12)
    # m v' = -tanh(v): sinh(v) = sinh(v_0) exp(-t/m).
    assert np.sinh(one["v"]) == pytest.approx(np.sinh(3.0) * np.exp(-TIMES / 2), rel=1e-8)


def test_van_der_pol_circuit_agrees_with_tight_integration() -> None:
    """Laws of a state and of another law's input: L i' = v, C v' = -i - g(v)."""
    nodes = [bg.Zero("n"), bg.C("c", "C", effort="v"), bg.I("l", "L", flow="i"),
             bg.R("tube", law="mu*(v**3/3 - v)", gives="flow"),
             bg.R("copy", law="f_tube/10", gives="flow")]  # fmt: skip
    run = simulator(
        bg.derive(bond_graph(nodes, "n>c n>l n>tube n>copy")), {"C": 1.0, "L": 0.8, "mu": 2.0}
    )
    result = run.run(TIMES * 4, {"v": 0.5})

    def rate(t: float, y: np.ndarray) -> list[float]:
        return [-y[1] - 1.1 * 2.0 * (y[0] ** 3 / 3 - y[0]), y[0] / 0.8]

    expected = _tight(rate, [0.5, 0.0], TIMES * 4)
    assert result["v"] == pytest.approx(expected[0], abs=1e-7)
    assert result["i"] == pytest.approx(expected[1], abs=1e-7)


def test_a_law_without_a_real_value_ends_the_run_with_its_time() -> None:
    run = simulator(_mass_with(bg.R("d", law="sqrt(v - 1)")), {"m": 1.0})
    with pytest.raises(bg.SimulationError, match=r"at t = 0"):
        run.run(TIMES, {"v": 0.5})


def test_a_run_that_escapes_to_infinity_is_refused() -> None:
    """v' = v^2 from 1 reaches infinity at t = 1."""
    run = simulator(_mass_with(bg.R("d", law="-v**2")), {"m": 1.0})
    with pytest.raises(bg.SimulationError, match=r"at t = (0\.99|1)"):
        run.run(TIMES, {"v": 1.0})
