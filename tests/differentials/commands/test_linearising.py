"""Poles, modes and matrices of catalog and file."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from click.testing import Result

Call = Callable[..., Result]

Data = Callable[..., Any]
NUMBERS = ("--set", "m=2", "--set", "k=800", "--set", "b=4")


def test_the_alsds_modes_are_the_papers(data: Data) -> None:
    """18.6 Hz with the printed parameters (18.9 as printed), and 165 Hz, from which I_1 is found."""
    found = [mode["damped_frequency"] for mode in data("modes", "alsd")]
    assert found[0] == pytest.approx(18.6, abs=0.05)
    assert found[-1] == pytest.approx(165, abs=0.5)


def test_a_stiffer_shaft_raises_the_clutch_mode_by_the_root(data: Data) -> None:
    """The wheels stand still at 165 Hz, so the clutch mode goes with the root of the stiffness."""
    soft, stiff = (data("modes", "alsd", "--set", f"k={k}")[-1] for k in (8600, 34400))
    assert stiff["frequency"] / soft["frequency"] == pytest.approx(2, rel=0.01)


def test_a_clutch_that_sticks_takes_a_state(data: Data) -> None:
    assert len(data("linear", "alsd")["states"]) == 6
    assert len(data("linear", "alsd", "--stuck", "clutch")["states"]) == 5


def test_a_mode_is_told_in_the_words_of_events(data: Data, call: Call) -> None:
    """The rectifier conducts through R_s = 1 beside R_l = 100, or its capacitor of 1 mF discharges by R_l."""
    told = (
        "linear",
        "examples/rectifier.json",
        "--set",
        "R_s=1",
        "--set",
        "C=1e-3",
        "--set",
        "R_l=100",
    )
    conducting, blocking = ([[-1010.0]], [[-10.0]])
    for way in (("--on", "d"), ("--mode", "d=on")):
        assert np.array(data(*told, *way)["P"]) == pytest.approx(np.array(conducting))
    for way in ((), ("--mode", "d=off")):
        assert np.array(data(*told, *way)["P"]) == pytest.approx(np.array(blocking))
    assert data("linear", "alsd", "--mode", "clutch=stick") == data(
        "linear", "alsd", "--stuck", "clutch"
    )


def test_an_oscillators_mode_is_the_textbooks(data: Data) -> None:
    (mode,) = data("modes", "examples/oscillator.json", *NUMBERS)
    omega, damping = math.sqrt(800 / 2), 4 / (2 * math.sqrt(800 * 2))
    assert mode["frequency"] == pytest.approx(omega / (2 * math.pi))
    assert mode["damping"] == pytest.approx(damping)
    assert mode["pole"]["real"] == pytest.approx(-damping * omega)
    assert mode["pole"]["imag"] == pytest.approx(omega * math.sqrt(1 - damping**2))


def test_linear_gives_matrices_in_numbers(data: Data, call: Call) -> None:
    found = data("linear", "examples/oscillator.json", *NUMBERS)
    assert found["states"] == ["v", "F_k"]
    assert np.array(found["P"]) == pytest.approx(np.array([[-2, -0.5], [800, 0]]))
    assert found["Q"] == [[0.5], [0.0]]
    assert sum(pole["real"] for pole in found["poles"]) == pytest.approx(-2)
    text = call("linear", "examples/oscillator.json", *NUMBERS).stdout
    assert "F_k  800" in text
    assert "poles [1/s]: -1" in text


def test_the_tires_are_linearised_at_the_speed_asked_for(data: Data) -> None:
    """eq. (18), (19): the tire's damping is r^2 k_t / v with v = r w, so it goes with 1 / w."""
    slow, fast = (data("linear", "passive", "--speed", str(speed)) for speed in (20, 80))
    at = slow["states"].index("omega_t1")
    assert slow["P"][at][at] / fast["P"][at][at] == pytest.approx(4)


def test_modes_as_a_table(call: Call) -> None:
    text = call("modes", "alsd").stdout
    assert "18.59" in text
    assert "+omega_1 -omega_2" in text
