"""Inertias from printed frequencies, and the modes that then come out."""

import numpy as np
import pytest

import bondgraph as bg
import differentials
from differentials.parameters import OWN, PARAMETERS

OPPOSITE = {"omega_1": 1, "omega_2": -1}

CASES = [
    ("alsd", ["I_1", "I_2"], 165.0),
    ("superposition_tvd", ["I_1", "I_2"], 165.0),
    ("stationary_tvd", ["I_c1", "I_c2"], 11.4),
    ("four_wheel_drive_tvd", ["I_s1", "I_s2"], 41.0),
]


@pytest.mark.parametrize(("name", "symbols", "printed"), CASES)
def test_the_defaults_are_the_identified_values_rounded(
    name: str, symbols: list[str], printed: float
) -> None:
    found = differentials.identified_inertia(name, symbols, printed, OPPOSITE)
    for symbol in symbols:
        default = {**PARAMETERS, **OWN.get(name, {})}[symbol]
        assert default.value == pytest.approx(found, rel=0.012)
        assert f"{printed:g} Hz" in default.source
        assert "assumes equal" in default.source


@pytest.mark.parametrize(("name", "symbols", "printed"), CASES)
def test_the_found_inertia_gives_the_frequency_back(
    name: str, symbols: list[str], printed: float
) -> None:
    found = differentials.identified_inertia(name, symbols, printed, OPPOSITE)
    model = differentials.linear_model(name, dict.fromkeys(symbols, found))
    assert model.mode(OPPOSITE).damped_frequency == pytest.approx(printed, rel=1e-9)


def test_the_clutch_mode_of_the_alsd_by_hand() -> None:
    """Outputs against wheels held by stiff tires: (k - i w c) i w/(...) reduces to I_1 w^2 ~ k."""
    model = differentials.linear_model("alsd", {"k_t": 1e12})
    assert model.mode(OPPOSITE).frequency == pytest.approx(
        np.sqrt(8600 / 0.008) / (2 * np.pi), rel=1e-4
    )


@pytest.mark.parametrize(
    ("name", "shuffle"), [("alsd", 18.6), ("stationary_tvd", 18.2), ("four_wheel_drive_tvd", 16.6)]
)
def test_the_shuffle_modes_that_follow(name: str, shuffle: float) -> None:
    """The paper prints 18.9 Hz for the ALSD: the printed parameters don't give it."""
    together = {"omega_1": 1, "omega_2": 1}
    if name == "four_wheel_drive_tvd":
        together = {"omega_3": 1, "omega_4": 1}
    assert differentials.linear_model(name).mode(together).damped_frequency == pytest.approx(
        shuffle, abs=0.05
    )


def test_the_two_rear_modes_of_the_4wd() -> None:
    model = differentials.linear_model("four_wheel_drive_tvd")
    found = [model.mode({"omega_1": 1, "omega_2": sign}).damped_frequency for sign in (-1, 1)]
    assert found == pytest.approx([41.2, 45.7], abs=0.1)


def test_impossible_frequencies_and_unknown_names_are_refused() -> None:
    with pytest.raises(
        bg.ParameterError, match=r"no inertia I_1, I_2 .* gives that mode 1e\+06 Hz"
    ):
        differentials.identified_inertia("alsd", ["I_1", "I_2"], 1e6, OPPOSITE)
    with pytest.raises(bg.ParameterError, match="alsd has no parameter 'I_9'"):
        differentials.identified_inertia("alsd", ["I_9"], 165, OPPOSITE)
    with pytest.raises(bg.SignalError, match="'omega_7' is not a state"):
        differentials.identified_inertia("alsd", ["I_1"], 165, {"omega_7": 1})
