"""Runs of models whose values change: mechanisms, lags of mass, friction beside moving ratios."""

import networkx as nx
import numpy as np
import pytest
from references.build import bond_graph
from scipy.integrate import solve_ivp

import bondgraph as bg
from codegen import Lag, Result, Sine, Step, simulator, trim

NUMBERS = {"J": 0.5, "m": 2.0, "r": 0.3, "c": 0.1}
TIMES = np.linspace(0, 3, 61)


def _crank(*more: tuple, ratio: str = "r*sin(theta)", bonds: str = "") -> nx.DiGraph:
    nodes = [bg.Se("drive", "tau"), bg.One("rot"), bg.I("J", "J", flow="omega"),
             bg.Df("angle", integrate="theta"), bg.TF("crank", ratio), bg.One("slider", flow="v"),
             bg.I("m", "m", priority=-1), bg.R("gas", law="c*f_gas**3"), *more]  # fmt: skip
    return bond_graph(nodes, f"drive>rot>J rot>angle rot>crank>slider>m slider>gas {bonds}")


def _tight(rhs: object, start: list[float], **more: object) -> np.ndarray:
    return solve_ivp(
        rhs, (0, 3), start, method="DOP853", rtol=1e-12, atol=1e-12, t_eval=TIMES, **more
    ).y  # fmt: skip


@pytest.fixture(scope="module")
def crank() -> Result:
    ready = simulator(bg.derive(_crank(), outputs=["slider"]), NUMBERS)
    assert (ready.states, ready.inputs) == (("omega", "theta"), ("tau",))
    return ready.run(TIMES, {"omega": 2.0, "theta": 0.1}, {"tau": Sine(1.0, 0.5)}, rtol=1e-10,
                     atol=1e-11)  # fmt: skip


def test_a_scotch_yoke_runs_as_lagrange_says(crank: Result) -> None:
    def rhs(t: float, y: np.ndarray) -> list[float]:
        omega, theta = y
        s, c = np.sin(theta), np.cos(theta)
        load = 2.0 * 0.09 * s * c * omega**2 + 0.3 * s * 0.1 * (0.3 * s * omega) ** 3
        return [(np.sin(np.pi * t) - load) / (0.5 + 2.0 * 0.09 * s**2), omega]

    omega, theta = _tight(rhs, [2.0, 0.1])
    assert crank["omega"] == pytest.approx(omega, abs=1e-9)
    assert crank["theta"] == pytest.approx(theta, abs=1e-9)
    assert crank["v"] == pytest.approx(0.3 * np.sin(theta) * omega, abs=1e-9)


def test_power_and_energy_balance_through_a_moving_ratio(crank: Result) -> None:
    absorbed = sum(crank.power(node) for node in ("J", "m", "gas"))
    assert crank.power("drive") == pytest.approx(absorbed, abs=1e-12)
    assert crank.energy("m") == pytest.approx(crank["v"] ** 2)
    effort, flow = crank.bond("rot", "crank")
    below, fast = crank.bond("crank", "slider")
    assert effort * flow == pytest.approx(below * fast, abs=1e-12)


def test_rhs_is_the_rate_at_any_instant() -> None:
    ready = simulator(bg.derive(_crank(), outputs=[]), NUMBERS)
    s, c = np.sin(0.7), np.cos(0.7)
    load = 2.0 * 0.09 * s * c * 9 + 0.3 * s * 0.1 * (0.3 * s * 3) ** 3
    expected = (1.5 - load) / (0.5 + 2.0 * 0.09 * s**2)
    assert ready.rhs(0.0, [3.0, 0.7], [1.5]) == pytest.approx([expected, 3.0], rel=1e-12)


def test_a_rocket_gains_what_its_mass_loses() -> None:
    """(m - k t) v' = P + k v, as the mass leaves at rest: v = P t/(m - k t)."""
    nodes = [bg.Se("push", "P"), bg.One("j"), bg.I("rocket", "m - k*t", flow="v")]
    ready = simulator(bg.derive(bond_graph(nodes, "push>j>rocket")), {"m": 5.0, "k": 1.0})
    run = ready.run(TIMES, inputs={"P": 2.0})
    assert run["v"] == pytest.approx(2.0 * TIMES / (5.0 - TIMES), abs=1e-9)


def test_a_ratio_that_an_input_sets() -> None:
    """A steplessly variable gear: v = n w, n from outside; (J + m n^2) w' = tau - m n n' w."""
    nodes = [bg.Se("lever", "n"), bg.R("rest", 1)]
    graph = _crank(*nodes, ratio="n", bonds="lever>rest")
    ready = simulator(bg.derive(graph, outputs=[]), {**NUMBERS, "c": 0.0})
    assert ready.inputs == ("tau", "n")
    moving = Sine(0.5, 0.4, offset=2.0)
    run = ready.run(TIMES, {"omega": 1.0}, {"tau": 1.0, "n": moving})

    def rhs(t: float, y: np.ndarray) -> list[float]:
        n, rate = 2 + 0.5 * np.sin(0.8 * np.pi * t), 0.4 * np.pi * np.cos(0.8 * np.pi * t)
        return [(1.0 - 2.0 * n * rate * y[0]) / (0.5 + 2.0 * n**2)]

    assert run["omega"] == pytest.approx(_tight(rhs, [1.0])[0], abs=1e-9)
    with pytest.raises(bg.SimulationError, match="input 'n' steps"):
        ready.run(TIMES, {"omega": 1.0}, {"tau": 1.0, "n": Step(1.0, 2.0, initial=1.0)})


def test_friction_beside_a_moving_ratio_sticks_and_slips() -> None:
    """A brake on the crank's shaft: it stops it, holds, and lets go as the torque grows."""
    graph = _crank(bg.R("brake", law=bg.DryFriction(3.0)), bonds="rot>brake")
    ready = simulator(bg.derive(graph, outputs=["brake"]), {**NUMBERS, "c": 0.0})
    run = ready.run(TIMES, {"omega": 2.0, "theta": 0.4}, {"tau": Lag(Step(1.5, 8.0), 0.3)})
    assert [event.kind for event in run.events] == ["stick", "slip"]
    stick, slip = (event.time for event in run.events)
    assert slip == pytest.approx(1.5 - 0.3 * np.log(1 - 3.0 / 8.0), abs=1e-7)
    held = (run.time > stick) & (run.time < slip)
    assert abs(run["omega"][held]).max() < 1e-12
    assert run["e_brake"][held] == pytest.approx(run["tau"][held], abs=1e-9)
    # Until it sticks: energy falls by the brake's work alone.
    energy = run.energy("J") + run.energy("m")
    before = run.time < stick
    lost = 3.0 * (run["theta"] - run["theta"][0])
    assert (energy + lost)[before] == pytest.approx(energy[0], abs=1e-8)


RUBBED = {"J": 0.5, "r": 0.3}


def _rubbed_crank() -> nx.DiGraph:
    nodes = [bg.Se("drive", "tau"), bg.One("rot"), bg.I("J", "J", flow="omega"),
             bg.Df("angle", integrate="theta"), bg.TF("crank", "r*sin(theta)"), bg.One("slider"),
             bg.R("brake", effort="F", flow="v", law=bg.DryFriction(3.0))]  # fmt: skip
    return bond_graph(nodes, "drive>rot>J rot>angle rot>crank>slider>brake")


def _stick_slip(level: float, end: float) -> tuple[list[tuple[float, str]], np.ndarray]:
    """J w' = tau - N |q| sign(w), q = r sin(theta), at rest while |tau| <= N |q|; events, and w, theta."""
    t, y, kinds, slipping = 0.0, np.array([0.0, 0.8]), list[tuple[float, str]](), False
    tau = Sine(1.0, 0.5)

    def margin(t: float, y: np.ndarray) -> float:
        return level * abs(0.3 * np.sin(y[1])) - abs(tau(t))

    while t < end:
        way = np.sign(tau(t)) if slipping else 0.0

        def rate(t: float, y: np.ndarray, way: float = way) -> list[float]:
            q = 0.3 * np.sin(y[1])
            return [(tau(t) - level * abs(q) * way) / 0.5, y[0]] if way else [0.0, 0.0]

        def stop(t: float, y: np.ndarray, way: float = way, begin: float = t) -> float:
            return (way * y[0] if t > begin + 1e-3 else 1.0) if way else margin(t, y)

        stop.terminal, stop.direction = True, -1  # type: ignore[attr-defined]
        found = solve_ivp(
            rate, (t, end), y, "DOP853", events=stop, rtol=1e-12, atol=1e-13, max_step=0.02
        )  # fmt: skip
        t, y = float(found.t[-1]), found.y[:, -1].copy()
        if t >= end:
            break
        if slipping:
            y[0] = 0.0
        slipping = margin(t, y) <= 1e-9 if slipping else True
        kinds.append((t, "slip" if slipping else "stick"))
    return kinds, y


def test_friction_across_a_moving_ratio_rubs_and_holds() -> None:
    ready = simulator(bg.derive(_rubbed_crank(), outputs=[]), RUBBED)
    result = ready.run(np.linspace(0, 3, 61), {"theta": 0.8}, {"tau": Sine(1.0, 0.5)})
    kinds, end = _stick_slip(3.0, 3.0)
    assert [event.kind for event in result.events] == [kind for _, kind in kinds]
    assert [e.time for e in result.events] == pytest.approx([t for t, _ in kinds], abs=1e-7)
    assert [result["omega"][-1], result["theta"][-1]] == pytest.approx(end, abs=1e-8)
    held = result["omega"] == 0.0
    arm = 0.3 * np.sin(result["theta"][held])
    assert result["F"][held] * arm == pytest.approx(result["tau"][held], abs=1e-9)
    assert [name for name in result if name.startswith("moving")] == []


def test_steps_that_would_be_impulses_are_refused() -> None:
    """A speed source behind a moving ratio drives the dependent mass by its rate."""
    nodes = [bg.Sf("drive", "w"), bg.One("rot"), bg.Df("angle", integrate="theta"),
             bg.TF("crank", "r*cos(theta)"), bg.One("slider"), bg.I("m", "m"), bg.Zero("y"),
             bg.R("b", "b"), bg.One("z"), bg.I("n", "n", flow="u")]  # fmt: skip
    graph = bond_graph(nodes, "drive>rot rot>angle rot>crank>slider>m slider>y y>b y>z>n")
    ready = simulator(bg.derive(graph, outputs=["drive"]), {"r": 1.0, "m": 1.0, "b": 1.0, "n": 1.0})
    with pytest.raises(bg.SimulationError, match=r"input 'w' steps at t = 0\.5"):
        ready.run(TIMES, inputs={"w": Step(0.5, 1.0)})
    smooth = ready.run(TIMES, inputs={"w": Lag(Step(0.5, 1.0), 0.1)})
    speed = np.cos(smooth["theta"]) * smooth["w"]
    assert smooth.energy("m") == pytest.approx(0.5 * speed**2, abs=1e-9)


def test_a_value_without_a_number_is_an_error_that_says_when() -> None:
    ready = simulator(bg.derive(_crank(ratio="r/theta"), outputs=[]), NUMBERS)
    with pytest.raises(bg.SimulationError, match=r"at t = 0 .*(no value|not finite)"):
        ready.run(TIMES, {"omega": 2.0}, {"tau": 5.0})


def test_a_pendulum_rests_where_its_weight_says_and_swings_as_linearised() -> None:
    nodes = [bg.One("rot"), bg.I("J", "J", flow="omega"), bg.Df("angle", integrate="theta"),
             bg.R("b", "b"), bg.Se("weight", "-m*g*l*sin(theta)"), bg.Se("drive", "tau")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "drive>rot>J rot>angle rot>b weight>rot"), outputs=[])
    numbers = {"J": 2.0, "b": 0.3, "m": 1.0, "g": 9.81, "l": 0.5}
    point = trim(simulator(equations, numbers), {"tau": 2.0}, {"theta": 0.1})
    assert np.sin(point["theta"]) == pytest.approx(2.0 / (9.81 * 0.5))
    model = bg.linearize(equations, at=point).numeric(numbers)
    stiffness = 9.81 * 0.5 * np.cos(point["theta"])
    assert model.modes()[0].frequency == pytest.approx(np.sqrt(stiffness / 2.0) / (2 * np.pi))
