"""Functions as polynomials: at told ends, at samples, and where no polynomial keeps to them."""

import numpy as np
import pytest

import bondgraph as bg
from codegen.called.fitting import Fits, fits
from codegen.numbers.arrays import Array


def _value(found: Fits, times: Array) -> Array:
    """What segments say, worked out apart from them."""
    which = np.searchsorted(found.begins, times, side="right") - 1
    tau = (times - found.centres[which]) / found.halves[which]
    return np.array(
        [
            np.polynomial.polynomial.polyval(x, found.powers[k])
            for x, k in zip(tau, which, strict=True)
        ]
    )


def test_a_polynomial_is_met_by_the_coarsest_segments() -> None:
    found = fits(lambda t: 2 + t - 3 * t**5, [0.0, 8.0], np.array([0.0, 8.0]), 1e-12)
    assert found.begins.tolist() == np.arange(0.0, 8.0, 0.5).tolist()
    assert found.smooth.tolist() == [False, *[True] * 15]
    times = np.linspace(0.01, 7.99, 333)
    assert _value(found, times) == pytest.approx(2 + times - 3 * times**5, rel=1e-11)


def test_no_segment_goes_over_a_told_end() -> None:
    ends = [0.0, 0.1, 0.7, 2.0]
    found = fits(
        lambda t: np.where(t < 0.1, 0.0, np.where(t < 0.7, 1.0, 2.0)),
        ends,
        np.array([0.0, 2.0]),
        1e-12,
    )
    assert set(ends[:-1]) <= set(found.begins.tolist())
    told = dict(zip(found.begins.tolist(), found.smooth.tolist(), strict=True))
    assert not any(told[end] for end in ends[:-1])
    assert len(found.begins) < 25
    assert _value(found, np.array([0.05, 0.1, 0.69, 0.7, 1.9])).tolist() == pytest.approx(
        [0, 1, 1, 2, 2]
    )


def test_what_only_samples_show_is_followed() -> None:
    """A pulse of a thousandth of a segment, which no point but the sample meets."""
    at = 3.4071

    def pulse(t: Array) -> Array:
        return np.where(abs(t - at) < 1e-4, 1.0, 0.0)

    unseen = fits(pulse, [0.0, 8.0], np.array([0.0, 8.0]), 1e-12)
    assert len(unseen.begins) == 16
    seen = fits(pulse, [0.0, 8.0], np.array([0.0, at, 8.0]), 1e-12)
    assert _value(
        seen, np.array([at - 2e-4, at - 9e-5, at, at + 9e-5, at + 2e-4])
    ) == pytest.approx([0, 1, 1, 1, 0], abs=1e-9)


def test_a_sample_at_a_jump_shows_what_the_function_gives_there() -> None:
    for inside in (True, False):
        at = 2.0 / 3

        def jump(t: Array, inside: bool = inside, at: float = at) -> Array:
            return np.where((t >= at) if inside else (t > at), 5.0, 1.0)

        found = fits(jump, [0.0, 2.0], np.array([0.0, at, 2.0]), 1e-12)
        assert _value(found, np.array([at])).tolist() == pytest.approx([5.0 if inside else 1.0])


def test_noise_is_refused_near_where_it_begins() -> None:
    noise = np.random.default_rng(0)

    def noisy(t: Array) -> Array:
        return np.where(t > 5.0, noise.normal(size=t.shape), 0.0)

    with pytest.raises(
        bg.SignalError, match=r"more than 100000 polynomials .* first near t = 5\.0"
    ):
        fits(noisy, [0.0, 8.0], np.array([0.0, 8.0]), 1e-12)
