"""`spectrum`: the amplitudes of a signal's oscillations over their frequencies."""

from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from bondgraph.errors import SignalError
from codegen.numbers.arrays import Array, read_only
from codegen.pictures.canvas import rule, stack
from codegen.pictures.labels import measured
from codegen.pictures.style import QUIET, SMALL, TEXT, curve
from codegen.record.result import Result, values_of
from codegen.tuning import TUNING

FEWEST = 8
"""Samples; fewer have no spectrum worth the name."""

FINER = 4
"""How much closer frequencies lie than the samples alone tell them apart, so that peaks are seen."""


class Peak(NamedTuple):
    """An oscillation: its frequency [Hz], and its amplitude in the signal's unit."""

    frequency: float
    amplitude: float


@dataclass(frozen=True)
class Spectrum:
    """Amplitudes over frequencies [Hz]: a sine has a peak as high as its amplitude.

    ``begin``, ``end``: the stretch [s]. An oscillation that decays shows what it has in the mean over it.
    """

    name: str
    unit: str
    begin: float
    end: float
    frequency: Array = field(repr=False)
    amplitude: Array = field(repr=False)

    def peaks(self, least: float = 0.05) -> tuple[Peak, ...]:
        """The peaks that stand out by ``least`` of the highest, highest first.

        Below ``least = 0.03`` the window's own side lobes come up.
        What has less than two periods in the stretch is left out: it can't be told from a drift.
        Each lies where the parabola through the logarithms of three amplitudes has its top, which is
        a fraction of the resolution ``1 / (end - begin)``.
        """
        # Here, for it takes as long to import as all else.
        from scipy.signal import find_peaks

        tops, told = find_peaks(self.amplitude, prominence=np.finfo(float).tiny)
        slowest = 2 / (self.end - self.begin)
        steady = self.frequency[tops] >= slowest
        tops, apart = tops[steady], told["prominences"][steady]
        size = self.amplitude[tops].max(initial=0.0)
        found = [self._top(int(at)) for at in tops[apart >= least * size]]
        return tuple(sorted(found, key=lambda peak: -peak.amplitude))

    def _top(self, at: int) -> Peak:
        tiny = np.finfo(float).tiny
        before, here, after = np.log(self.amplitude[at - 1 : at + 2] + tiny)
        shift = 0.5 * (before - after) / (before - 2 * here + after)
        width = self.frequency[1] - self.frequency[0]
        height = np.exp(here - 0.25 * (before - after) * shift)
        return Peak(float(self.frequency[at] + shift * width), float(height))

    def plot(self, title: str | None = None, most: int = 4) -> Any:
        """A `matplotlib.figure.Figure` with the frequencies of up to ``most`` peaks beside them.

        Raises `MissingExtraError` without matplotlib.
        """
        figure, (axis,) = stack(1, 3.0)
        axis.plot(self.frequency, self.amplitude, linewidth=1.2, **curve(0))
        peaks = self.peaks()[:most]
        for peak in peaks:
            axis.plot(*peak, marker=".", color=QUIET, gid="peak")
            axis.annotate(
                f"{peak.frequency:.4g} Hz", peak, xytext=(5, 3), textcoords="offset points",
                fontsize=SMALL + 0.5, color=QUIET,
            )  # fmt: skip
        axis.set_xlabel("Frequency [Hz]", fontsize=TEXT)
        axis.set_ylabel(f"Amplitude of {measured(self.name, self.unit)}", fontsize=TEXT)
        highest = max(float(self.amplitude.max()), *(peak.amplitude for peak in peaks), 0.0)
        axis.set_ylim(0, 1.12 * highest or 1.0)
        axis.margins(x=0)
        rule(axis)
        span = f"{self.begin:g} to {self.end:g} s"
        figure.suptitle(span if title is None else title, fontsize=TEXT + 1)
        return figure


def spectrum(
    result: Result, name: str, begin: float | None = None, end: float | None = None
) -> Spectrum:
    """The spectrum of a signal between two times [s], both included, through a Hann window.

    A straight line is taken off first, so that a rest and a drift are no oscillations.

    Raises `SignalError` for an unknown name, samples that are not evenly spaced or fewer than 8.
    """
    from scipy.signal import detrend, periodogram

    values = values_of(result, name)
    first = float(result.time[0]) if begin is None else begin
    last = float(result.time[-1]) if end is None else end
    inside = (result.time >= first) & (result.time <= last)
    time = result.time[inside]
    if len(time) < FEWEST:
        raise SignalError(
            f"{len(time)} samples from {first:g} to {last:g} s; a spectrum needs {FEWEST} or more"
        )
    steps = np.diff(time)
    step = float(time[-1] - time[0]) / len(steps)
    if abs(steps - step).max() > TUNING.even * step:
        raise SignalError(
            "a spectrum needs evenly spaced samples; run with np.linspace, or choose another stretch"
        )
    frequency, power = periodogram(
        detrend(values[inside]), fs=1 / step, window="hann", nfft=FINER * len(time), detrend=False,
        scaling="spectrum",
    )  # fmt: skip
    # The power of a sine is half the square of its amplitude; at the ends of the axis there is no half.
    halves = np.full(len(power), 2.0)
    halves[[0, -1]] = 1.0
    return Spectrum(
        name, result.units.get(name, ""), float(time[0]), float(time[-1]),
        read_only(frequency), read_only(np.sqrt(halves * power)),
    )  # fmt: skip
