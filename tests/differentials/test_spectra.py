"""The frequencies that runs of Fig. 11 show are those of the paper's modes."""

import pytest

import codegen
import differentials

#: [Hz]: the shuffle mode of the ALSD at the printed parameters, and the clutch mode as printed.
SHUFFLE, CLUTCH = 18.6, 165.0


@pytest.fixture(scope="module")
def run() -> codegen.Result:
    return differentials.simulate("alsd", "fig11")


@pytest.mark.parametrize("name", ["omega_1", "omega_2", "omega_c", "tau_hs1", "tau_hs2"])
def test_the_engine_step_excites_the_shuffle_mode(run: codegen.Result, name: str) -> None:
    (peak,) = codegen.spectrum(run, name, 0.1, 0.5).peaks()
    assert peak.frequency == pytest.approx(SHUFFLE, abs=0.2)


@pytest.mark.parametrize("name", ["omega_1", "omega_2", "omega_f"])
def test_the_clutch_step_excites_the_clutch_mode(run: codegen.Result, name: str) -> None:
    peak = codegen.spectrum(run, name, run.events[-1].time).peaks()[0]
    assert peak.frequency == pytest.approx(CLUTCH, abs=1.0)
