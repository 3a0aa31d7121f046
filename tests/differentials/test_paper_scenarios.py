"""The paper's scenarios, every signal and event, against an independent exact integration."""

from typing import NamedTuple

import numpy as np
import pytest
from references.paper_runs import Reference
from references.paper_runs import run as exact_run

import codegen
import differentials

PRECISION = 1e-6  # of a signal's range
AT_REST = {"omega": 1e-9, "tau": 1e-7}  # rad/s, N m: rounding in a signal that has no range

ASSUMED = dict.fromkeys(("I_1", "I_2", "I_3", "I_4"), 0.008)
ASSUMED |= {"I_c1": 0.026, "I_c2": 0.026, "I_s1": 0.0094, "I_s2": 0.0094}

DIFFERENTIAL = {
    "fig11": "alsd",
    **{f"fig12_{speed}_{k}": "alsd" for speed in (20, 80) for k in ("0.5", "1", "2", "5")},
    "fig13": "stationary_tvd",
    "fig13_superposition": "superposition_tvd",
    "fig14": "four_wheel_drive_tvd",
    "engine_step": "passive",
}
"""Named scenario to the differential it is for. "input_clutch" is for one without a full model."""


class Runs(NamedTuple):
    found: codegen.Result
    expected: Reference

    @property
    def clutches(self) -> list[str]:
        """What ends the names of each clutch's signals."""
        return {0: [], 1: [""], 2: ["1", "2"]}[self.expected.tau_f.shape[1]]

    @property
    def states(self) -> list[str]:
        """The states' names in the reference's order."""
        wheels = range(1, self.expected.states.shape[1] // 3 + 1)
        return [f"{state}{j}" for state in ("omega_", "tau_k", "omega_t") for j in wheels]

    def check(self, names: list[str], expected: np.ndarray) -> None:
        for name, values in zip(names, expected.T, strict=True):
            allowed = max(PRECISION * np.ptp(values), AT_REST[name.split("_")[0]])
            assert abs(self.found[name] - values).max() < allowed, name


@pytest.fixture(scope="module", params=DIFFERENTIAL)
def runs(request: pytest.FixtureRequest) -> Runs:
    """Both runs of a scenario; pytest runs all tests of one before it goes on to the next."""
    name, case = DIFFERENTIAL[request.param], differentials.scenarios[request.param]
    expected = exact_run(
        name, {**ASSUMED, **case.parameters}, case.wheel_speed, case.speed_difference,
        case.engine_torque, case.clutch_torques, case.engine_step, case.clutch_step,
        case.duration, case.lag,
    )  # fmt: skip
    return Runs(differentials.simulate(name, request.param), expected)


def test_every_named_scenario_is_here() -> None:
    assert {*DIFFERENTIAL, "input_clutch"} == {*differentials.scenarios}


def test_what_the_paper_does_not_print_is_the_default() -> None:
    for name in set(DIFFERENTIAL.values()):
        known = {**differentials.PARAMETERS, **differentials.OWN.get(name, {})}
        for symbol in ASSUMED.keys() & known.keys():
            assert known[symbol].value == ASSUMED[symbol]


def test_it_is_sampled_every_millisecond(runs: Runs) -> None:
    assert runs.found.time == pytest.approx(runs.expected.time, abs=1e-12)


def test_states_agree(runs: Runs) -> None:
    assert {*runs.found.states} == {*runs.states}
    runs.check(runs.states, runs.expected.states)


def test_torques_of_engine_and_hydraulics_agree(runs: Runs) -> None:
    runs.check(["tau_e"], runs.expected.tau_e[:, None])
    runs.check([f"tau_h{end}" for end in runs.clutches], runs.expected.tau_h)


def test_clutch_torques_agree(runs: Runs) -> None:
    runs.check([f"tau_f{end}" for end in runs.clutches], runs.expected.tau_f)


def test_slips_agree(runs: Runs) -> None:
    runs.check([f"omega_f{end}" for end in runs.clutches], runs.expected.omega_f)


def test_events_agree(runs: Runs) -> None:
    ports = {f"clutch{'_' if end else ''}{end}": j for j, end in enumerate(runs.clutches, start=1)}
    found = [(ports[str(event.port)], event.kind) for event in runs.found.events]
    assert found == [(port, kind) for _, port, kind in runs.expected.events]
    times = [time for time, *_ in runs.expected.events]
    assert [event.time for event in runs.found.events] == pytest.approx(times, rel=0, abs=1e-6)


def test_the_power_balance_closes(runs: Runs) -> None:
    audit = runs.found.audit()
    assert abs(audit.residual) < 1e-9 * audit.turned_over
    for clutch in [node for node in audit.lost if str(node).startswith("clutch")]:
        assert audit.lost[clutch] >= -1e-9 * audit.turned_over
