"""Amplitude spectra: sines have peaks as high as they are."""

from dataclasses import replace

import numpy as np
import pytest
from oracles.slides import slide, swing

import bondgraph as bg
from codegen import Result, spectrum


def _made(values: np.ndarray, time: np.ndarray) -> Result:
    return replace(swing(), time=time, columns={"P": values, "v": values}, events=())


@pytest.mark.parametrize(("amplitude", "frequency"), [(2.5, 5.0), (0.3, 61.3), (40.0, 237.9)])
def test_a_sine_is_one_peak_of_its_frequency_and_amplitude(
    amplitude: float, frequency: float
) -> None:
    (peak,) = spectrum(swing(amplitude, frequency), "P").peaks()
    assert peak.frequency == pytest.approx(frequency, abs=0.02)
    assert peak.amplitude == pytest.approx(amplitude, rel=0.01)


def test_peaks_come_highest_first_and_small_ones_on_request() -> None:
    time = np.linspace(0, 1, 1001)
    values = sum(a * np.sin(2 * np.pi * f * time) for a, f in ((1, 20), (3, 90), (0.16, 200)))
    found = spectrum(_made(values, time), "P")
    assert [round(peak.frequency) for peak in found.peaks()] == [90, 20, 200]
    assert [round(peak.frequency) for peak in found.peaks(least=0.1)] == [90, 20]


def test_rest_and_drift_are_no_oscillations() -> None:
    time = np.linspace(0, 1, 1001)
    found = spectrum(_made(50 + 300 * time + np.sin(2 * np.pi * 40 * time), time), "P")
    (peak,) = found.peaks()
    assert peak.frequency == pytest.approx(40, abs=0.05)
    assert found.amplitude[0] < 0.01
    assert spectrum(_made(50 + 0 * time, time), "P").amplitude.max() < 1e-9


def test_only_the_stretch_counts() -> None:
    time = np.linspace(0, 2, 2001)
    values = np.where(time < 1, np.sin(2 * np.pi * 30 * time), np.sin(2 * np.pi * 80 * time))
    run = _made(values, time)
    assert round(spectrum(run, "P", end=0.99).peaks()[0].frequency) == 30
    late = spectrum(run, "P", begin=1.0)
    assert [round(peak.frequency) for peak in late.peaks()] == [80]
    assert (late.begin, late.end) == (1.0, 2.0)


def test_the_axis_ends_at_half_the_rate_of_samples() -> None:
    for samples in (1001, 1000):
        found = spectrum(_made(np.ones(samples), np.arange(samples) / 1000), "P")
        assert found.frequency[0] == 0
        assert found.frequency[-1] == pytest.approx(500)


def test_what_has_no_spectrum_is_refused() -> None:
    run = swing()
    with pytest.raises(bg.SignalError, match="no signal 'x'; there are v, P"):
        spectrum(run, "x")
    with pytest.raises(bg.SignalError, match=r"6 samples from 0 to 0\.005 s"):
        spectrum(run, "P", end=0.005)
    uneven = np.concatenate([np.linspace(0, 1, 50), np.linspace(1.1, 3, 50)])
    with pytest.raises(bg.SignalError, match="evenly spaced"):
        spectrum(_made(np.sin(uneven), uneven), "P")


def test_the_picture_names_the_peaks() -> None:
    pytest.importorskip("matplotlib")
    found = spectrum(swing(), "P")
    (axis,) = found.plot().axes
    curve = axis.lines[0]
    assert (curve.get_xdata() == found.frequency).all()
    assert (curve.get_ydata() == found.amplitude).all()
    assert [text.get_text() for text in axis.texts] == ["5 Hz"]
    assert axis.get_ylabel() == "Amplitude of $P$ [N]"
    assert axis.get_xlabel() == "Frequency [Hz]"
    flat = spectrum(slide(), "w", begin=2.5).plot(title="at rest").axes[0]
    assert list(flat.texts) == []
