"""Fig. 11: the ALSD's run against an independent exact integration, and against what the paper says."""

import numpy as np
import pytest
from references.fig11 import fig11

import codegen
import differentials

STATES = ["omega_1", "omega_2", "tau_k1", "tau_k2", "omega_t1", "omega_t2"]


@pytest.fixture(scope="module")
def run() -> codegen.Result:
    return differentials.simulate("alsd", "fig11")


def test_every_signal_agrees_with_the_independent_integration(run: codegen.Result) -> None:
    reference = fig11()
    expected = dict(zip(STATES, reference.states.T, strict=True))
    expected |= {name: getattr(reference, name) for name in ("tau_f", "tau_e", "tau_h", "omega_f")}
    assert run.time == pytest.approx(reference.time, abs=1e-12)
    for name, values in expected.items():
        assert abs(run[name] - values).max() < 1e-6 * np.ptp(values), name


def test_events_agree_with_the_independent_integration(run: codegen.Result) -> None:
    found = [(event.time, event.kind) for event in run.events]
    assert [kind for _, kind in found] == [kind for _, kind in fig11().events]
    for (time, _), (expected, _) in zip(found, fig11().events, strict=True):
        assert time == pytest.approx(expected, abs=1e-6)


def test_it_locks_and_slips_again_when_the_restored_paper_says(run: codegen.Result) -> None:
    (stick, slip) = run.events
    assert (stick.kind, slip.kind) == ("stick", "slip")
    assert stick.time == pytest.approx(0.50122, abs=5e-6)
    assert slip.time == pytest.approx(0.56843, abs=5e-6)


def test_the_locked_clutch_does_not_slip(run: codegen.Result) -> None:
    locked = (run.time > run.events[0].time) & (run.time < run.events[1].time)
    assert locked.sum() == 67
    assert abs(run["omega_f"][locked]).max() < 1e-9


def test_the_steady_torque_difference_is_the_hydraulic_torque(run: codegen.Result) -> None:
    """In the mean over whole periods of the 165 Hz ripple; the lag is over to 1e-4 of tau_h."""
    last = run.time > 1 - 20 / 165.5
    difference = (run["tau_hs1"] - run["tau_hs2"])[last]
    assert difference.mean() == pytest.approx(1000, abs=0.2)
    assert abs(difference - 1000).max() < 2


def bend(time: np.ndarray, values: np.ndarray) -> float:
    """The largest distance from the fitted straight line, as a fraction of the range."""
    line = np.polyval(np.polyfit(time, values, 1), time)
    return float(abs(values - line).max() / np.ptp(values))


def test_while_locked_the_torque_follows_late_and_more_like_a_ramp(run: codegen.Result) -> None:
    """The paper: "delayed somewhat" and of "a ramp-like form" against tau_h's exponential."""
    locked = (run.time > run.events[0].time) & (run.time < run.events[1].time)
    time, difference = run.time[locked], (run["tau_hs1"] - run["tau_hs2"])[locked]
    demand = run["tau_h"][locked]
    assert (difference < demand).all()
    assert (np.diff(difference) > 0).all()
    assert bend(time, difference) < 0.6 * bend(time, demand)


def test_power_balances_at_every_sample(run: codegen.Result) -> None:
    """Supplied - dissipated - stored power, against the largest flow of power."""
    value = {name: parameter.value for name, parameter in differentials.PARAMETERS.items()}
    full = differentials.equations("alsd", halfshafts=True)
    exact = {symbol: value[symbol.name] for symbol in full.A.free_symbols}
    A = np.array(full.A.subs(exact), dtype=float)
    x = np.column_stack([run[name] for name in STATES])
    supplied = run["tau_e"] * run["omega_e"]
    dissipated = run["tau_f"] * run["omega_f"]
    dissipated = dissipated + sum(run[f"tau_t{j}"] * run[f"omega_t{j}"] for j in (1, 2))
    stored = np.einsum("ti,ij,tj->t", x, A, rates(run, value))
    largest = max(abs(supplied).max(), abs(dissipated).max(), abs(stored).max())
    assert abs(supplied - dissipated - stored).max() < 1e-9 * largest


def rates(run: codegen.Result, value: dict[str, float]) -> np.ndarray:
    """x' from the simulated torques and the paper's equations (13), (15), (16), b = 0."""
    i, I_w, k = value["i"], value["I_w"], value["k"]
    a = i**2 * value["I_i"] / 4
    inertia = np.array([[value["I_1"] + a, a], [a, value["I_2"] + a]])
    drive = i / 2 * run["tau_e"]
    torques = [drive - run["tau_f"] / 2 - run["tau_k1"], drive + run["tau_f"] / 2 - run["tau_k2"]]
    outputs = np.linalg.solve(inertia, np.array(torques))
    wheels = [(run[f"tau_k{j}"] - run[f"tau_t{j}"]) / I_w for j in (1, 2)]
    shafts = [k * (run[f"omega_{j}"] - run[f"omega_t{j}"]) for j in (1, 2)]
    return np.column_stack([*outputs, *shafts, *wheels])


@pytest.mark.parametrize(
    "changed",
    [{"k": 4300.0}, {"k": 43000.0, "I_1": 0.02}, {"I_w": 1.1, "I_2": 0.004}, {"i": 3.5, "r": 0.28}],
)
def test_other_parameters_agree_with_the_independent_integration(changed: dict[str, float]) -> None:
    found = differentials.simulate("alsd", "fig11", changed)
    expected = fig11(**changed)
    assert [event.kind for event in found.events] == [kind for _, kind in expected.events]
    for event, (time, _) in zip(found.events, expected.events, strict=True):
        assert event.time == pytest.approx(time, abs=1e-6)
    for name, values in zip(STATES, expected.states.T, strict=True):
        assert abs(found[name] - values).max() < 1e-6 * np.ptp(values), name
