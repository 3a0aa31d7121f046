"""Random scenarios of the active differentials: against exact integration, and against Coulomb's law."""

from itertools import product

import numpy as np
import pytest
from references.paper_runs import Reference, run
from soak.families import seeds

import differentials
from codegen import Result
from differentials import Scenario

ASSUMED = dict.fromkeys(("I_1", "I_2", "I_3", "I_4"), 0.008)
ASSUMED |= {"I_c1": 0.026, "I_c2": 0.026, "I_s1": 0.0094, "I_s2": 0.0094}

ALIKE = 1e-6  # of a signal's range; s for events
SPEED, TORQUE = 1e-9, 1e-7  # rad/s, N m: rounding in a signal that has no range
UNDECIDED = 1e-7  # s
MOST_EVENTS = 150  # in 0.3 s: the stiffest shafts' mode of 370 Hz could make 220 per clutch


def random_case(seed: int) -> tuple[str, Scenario]:
    """A differential and a scenario; often without slip, in symmetry, or with steps that coincide."""
    rng = np.random.default_rng(seed)
    name = ("alsd", "superposition_tvd", "stationary_tvd", "four_wheel_drive_tvd")[rng.integers(4)]
    speed = rng.uniform(10, 120)
    difference = 0.0 if rng.random() < 0.25 else min(rng.uniform(-10, 10), speed - 1.5)
    engine = 0.0 if rng.random() < 0.1 else rng.uniform(-400, 600)
    most = (0.0, 300.0, 3000.0, 1e5)
    torques = [rng.uniform(0, rng.choice(most)) for _ in range(1 if name == "alsd" else 2)]
    if rng.random() < 0.3:
        torques = [torques[0]] * len(torques)
    steps = [0.0 if rng.random() < 0.25 else rng.uniform(0, 0.25) for _ in range(2)]
    if rng.random() < 0.3:
        steps[1] = steps[0]
    other = {"b": rng.uniform(0, 30)} if rng.random() < 0.3 else {}
    if rng.random() < 0.2:
        other["k"] = 8600 * rng.uniform(0.5, 5)
    if name == "four_wheel_drive_tvd" and rng.random() < 0.5:
        other["g"] = float(rng.choice((0.95, 1.0)))  # 1: no slip where the wheels turn alike
    return name, Scenario(speed, difference, engine, tuple(torques), *steps, 0.3, parameters=other)


def of_clutch(found: Result, clutch: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Slip, torque and hydraulic torque of a clutch, counted from 1."""
    end = "" if "tau_h" in found.inputs else str(clutch)
    return found[f"omega_f{end}"], found[f"tau_f{end}"], found[f"tau_h{end}"]


def switches(found: Result, clutch: int) -> list[tuple[float, str]]:
    return [(e.time, e.kind) for e in found.events if (e.port == "clutch_2") == (clutch == 2)]


def modes(found: Result, clutch: int) -> np.ndarray:
    """At each sample the mode according to the events: 0 sticking, otherwise the slip's sign."""
    slip, events = of_clutch(found, clutch)[0], switches(found, clutch)
    stuck = np.full(len(slip), events[0][1] == "slip" if events else abs(slip).max() < SPEED)
    for time, kind in events:
        stuck[found.time >= time] = kind == "stick"
    return np.where(stuck, 0, np.where(slip < 0, -1, 1))


def check_signals(found: Result, exact: Reference) -> None:
    """A slip is a difference of speeds, so its error is theirs, and their range the measure."""
    n = exact.states.shape[1] // 3
    names = [f"{state}{j}" for state in ("omega_", "tau_k", "omega_t") for j in range(1, n + 1)]
    for name, values in zip(names, exact.states.T, strict=True):
        allowed = max(ALIKE * np.ptp(values), SPEED if name.startswith("omega") else TORQUE)
        assert abs(found[name] - values).max() < allowed, name
    floors = max(SPEED, ALIKE * np.ptp(exact.states[:, :n], axis=0).max()), TORQUE, TORQUE
    for c, expected in enumerate(zip(exact.omega_f.T, exact.tau_f.T, exact.tau_h.T, strict=True)):
        for one, wanted, floor in zip(of_clutch(found, c + 1), expected, floors, strict=True):
            assert abs(one - wanted).max() < max(ALIKE * np.ptp(wanted), floor), c + 1


def check_events(found: Result, exact: Reference, s: Scenario) -> None:
    """Clutch by clutch: in which order things happen to both in one instant is free.

    Without slip and torque, sticking and slipping are the same. A clutch that starts so may have any
    events until its torque has come, and until a wrong mode has made a slip above rounding, 1e-7 rad/s:
    the torques' rates of hundreds of N m/s, over inertias of 0.01 kg m^2, need a few microseconds.
    """
    for clutch, demand in enumerate(s.clutch_torques, start=1):
        ours, theirs = switches(found, clutch), [e[::2] for e in exact.events if e[1] == clutch]
        if abs(exact.omega_f[0, clutch - 1]) < SPEED:
            begin = s.clutch_step + UNDECIDED if demand else np.inf
            ours, theirs = ([e for e in events if e[0] > begin] for events in (ours, theirs))
        assert [kind for _, kind in ours] == [kind for _, kind in theirs], clutch
        assert [t for t, _ in ours] == pytest.approx([t for t, _ in theirs], rel=0, abs=ALIKE)
    assert len(found.events) < MOST_EVENTS


def check(name: str, s: Scenario) -> Result:
    exact = run(name, {**ASSUMED, **s.parameters}, s.wheel_speed, s.speed_difference, s.engine_torque,
                s.clutch_torques, s.engine_step, s.clutch_step, s.duration, s.lag)  # fmt: skip
    found = differentials.simulate(name, s)
    check_signals(found, exact)
    check_events(found, exact, s)
    for clutch in range(1, len(s.clutch_torques) + 1):
        (slip, tau, tau_h), mode = of_clutch(found, clutch), modes(found, clutch)
        sticks, slips = mode == 0, (mode != 0) & (abs(slip) > SPEED)
        assert abs(slip[sticks]).max(initial=0) < SPEED
        assert (abs(tau) <= tau_h * (1 + 1e-9) + TORQUE)[sticks].all()
        assert (tau == tau_h * mode)[slips].all()
        assert (abs(tau) == tau_h)[mode != 0].all()
    return found


@pytest.mark.parametrize("seed", seeds("scenarios"))
def test_random_scenarios_agree(seed: int) -> None:
    check(*random_case(seed))


MODES = {1.05: {(-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 0), (0, 1)},
         0.95: {(0, -1), (0, 0), (0, 1), (1, -1), (1, 0), (1, 1)}}  # fmt: skip


@pytest.mark.parametrize(("speedup", "difference"), [(1.05, -5), (0.95, 5)])
def test_every_combination_of_modes_of_two_clutches(speedup: float, difference: float) -> None:
    s = Scenario(20, difference, 0, (1000, 100), 0.02, 0.02, 0.3, parameters={"g": speedup})
    found = check("four_wheel_drive_tvd", s)
    pairs = np.column_stack([modes(found, 1), modes(found, 2)])[found.time > s.clutch_step]
    assert set(map(tuple, pairs.tolist())) == MODES[speedup]
    assert set.union(*MODES.values()) == set(product((-1, 0, 1), repeat=2))


@pytest.mark.parametrize("name", ["four_wheel_drive_tvd", "stationary_tvd"])
def test_symmetric_clutches_lock_in_one_instant(name: str) -> None:
    """The paper: "4WD mode is provided by locking both clutches"."""
    found = check(name, Scenario(20, 0, 100, (5e4, 5e4), 0.1, 0.05, 0.3))
    assert [event.kind for event in found.events] == ["stick", "stick"]
    assert found.events[0].time == pytest.approx(found.events[1].time, rel=0, abs=1e-9)
