"""Runs on pulses of any frequency: so many switchings, at those instants, and the exact periodic solution."""

import tracemalloc
from collections.abc import Mapping

import numpy as np
import pytest
from oracles.pulsed import coil, half_bridge
from references.pulsed import current, switchings
from soak.families import seeds

from codegen import (
    PWM,
    Family,
    Lag,
    Simulator,
    Sine,
    Square,
    Step,
    Swept,
    ZeroOrderHold,
    event_count,
    final,
    simulator,
    sweep,
)

V, R = 24.0, 1.5


def _drawn(seed: int) -> tuple[float, float, float, float]:
    """Frequency [Hz], phase, duty, inductance: a period is 0.01 to 100 time constants."""
    rng = np.random.default_rng(seed)
    f = float(10 ** rng.uniform(1, 6))
    L = R / f / 10 ** rng.uniform(-2, 2)
    return f, float(rng.uniform(-1, 1)), float(rng.uniform(0.03, 0.97)), float(L)


def _check(backend: str, seed: int, periods: int) -> None:
    """Both models from the periodic state on, at times that have nothing to do with the period."""
    f, phase, duty, L = _drawn(seed)
    times = np.linspace(0.0, periods / f * 1.000123, 41)
    told = (V, R, L, f, duty, phase)
    start = {"i": current(0.0, *told)}
    expected = [current(t, *told) for t in times.tolist()]
    size = 1e-9 * V / R
    plain = simulator(coil(), {"L": L, "R": R}, backend=backend)
    run = plain.run(times, start, {"u": PWM(f, duty, 0.0, V, phase)})
    assert run["i"] == pytest.approx(expected, abs=size)
    switched = simulator(half_bridge(), {"L": L, "R": R}, backend=backend)
    gate = PWM(f, duty, phase=phase)
    before = ("high",) if gate(0.0) else ("low",)
    run = switched.run(times, start, {"V": V, "gate": gate}, initially_on=before)
    assert run["i"] == pytest.approx(expected, abs=size)
    end = float(times[-1])
    assert len(run.events) == 2 * switchings(0.0, end, f, duty, phase)
    instants = list(gate.within(0.0, end))
    for port in ("high", "low"):
        assert [one.time for one in run.events if one.port == port] == instants


@pytest.mark.parametrize("seed", seeds("pulsed"))
def test_any_frequency(seed: int) -> None:
    _check("numpy", seed, 40)


@pytest.mark.parametrize("seed", seeds("pulsed-in-c"))
def test_any_frequency_in_c(seed: int) -> None:
    _check("c", seed, 3000)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_pulses_of_two_frequencies_superpose(backend: str) -> None:
    """Segments follow one another in no order that repeats; in C many times what is written at once."""
    f, other, L = 12_345.0, 7_777.7, 1e-3
    times = np.linspace(0.0, (40 if backend == "numpy" else 5000) / f, 23)
    one, two = (V, R, L, f, 0.3, 0.2), (2 * V, R, L, other, 0.6, -0.1)
    drive = PWM(f, 0.3, 0.0, V, 0.2) + 2 * PWM(other, 0.6, 0.0, V, -0.1)
    ready = simulator(coil(), {"L": L, "R": R}, backend=backend)
    start = {"i": current(0.0, *one) + current(0.0, *two)}
    run = ready.run(times, start, {"u": drive}, events=False)
    expected = [current(t, *one) + current(t, *two) for t in times.tolist()]
    assert run["i"] == pytest.approx(expected, abs=1e-9)


def test_what_is_kept_of_a_segment_is_not_of_later_ones_of_its_number() -> None:
    """A mode that comes once in 1024 segments, at another voltage each time; those are written at a time."""
    h, L = 1e-5, 1e-3
    levels = np.random.default_rng(0).uniform(1.0, 50.0, 5 * 1022)
    gate = PWM(1 / (1022 * h), 0.5 / 1022, phase=500.25 / 1022)
    ready = simulator(half_bridge(), {"L": L, "R": R}, backend="c")
    inputs = {"V": ZeroOrderHold(values=levels, period=h), "gate": gate}
    run = ready.run([0.0, 4000.5 * h], {}, inputs, initially_on=("low",))
    i = 0.0
    for k in range(4):
        full = levels[1022 * k + 500] / R
        i = full + (i - full) * np.exp(-0.5 * h * R / L)
        i *= np.exp(-(1021.5 * h if k < 3 else (4000.5 - 3 * 1022 - 500.75) * h) * R / L)
    assert len(run.events) == 16
    assert run["i"][-1] == pytest.approx(i, rel=1e-9)


def test_a_second_at_a_megahertz() -> None:
    """Two million pieces in C, 400,000 events."""
    f, duty, L = 1e6, 0.37, 1e-4
    told = (V, R, L, f, duty, 0.0)
    times = np.linspace(0.0, 1.0, 11)
    plain = simulator(coil(), {"L": L, "R": R}, backend="c")
    run = plain.run(times, {"i": current(0.0, *told)}, {"u": PWM(f, duty, 0.0, V)}, events=False)
    expected = [current(t, *told) for t in times.tolist()]
    assert (run["i"], run.backend) == (pytest.approx(expected, abs=1e-9), "c")
    switched = simulator(half_bridge(), {"L": L, "R": R}, backend="c")
    inputs = {"V": V, "gate": PWM(f, duty)}
    run = switched.run([0.0, 0.1], {}, inputs, initially_on=("high",))
    assert len(run.events) == 2 * switchings(0.0, 0.1, f, duty, 0.0)
    assert run.events[-1].time == PWM(f, duty).preceding(0.1)


def _peak(ready: Simulator, end: float, drive: object) -> int:
    """Bytes that Python has asked for at most during a run."""
    tracemalloc.start()
    try:
        ready.run(np.linspace(0.0, end, 11), {}, {"u": drive}, events=False)
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


DRIVES = {
    "plain": PWM(1e6, 0.3),
    "sum": PWM(1e6, 0.3, phase=0.1) + PWM(0.9e6, 0.7),
    "lag": Lag(PWM(1e6, 0.3), 1e-4),
    "moving": PWM(1e6, Sine(0.4, 50.0, offset=0.5)),
}


@pytest.mark.parametrize("name", DRIVES)
def test_memory_is_that_of_a_short_run(name: str) -> None:
    """A million switchings in C take no more than ten thousand do, a hundred thousand of others."""
    ready, drive = simulator(coil(), {"L": 1e-4, "R": R}, backend="c"), DRIVES[name]
    _peak(ready, 1e-4, drive)
    peak = _peak(ready, 0.5 if name == "plain" else 0.05, drive)
    assert peak < min(_peak(ready, 0.005, drive) + 250_000, 1_000_000)


@pytest.mark.parametrize("name", DRIVES)
def test_memory_in_numpy_is_that_of_a_short_run(name: str) -> None:
    ready, drive = simulator(coil(), {"L": 1e-4, "R": R}), DRIVES[name]
    _peak(ready, 1e-4, drive)
    assert _peak(ready, 6e-4, drive) < _peak(ready, 2e-4, drive) + 250_000


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_the_audit_closes(backend: str) -> None:
    """Of the coil on pulses, on a lag of them and on held data, and of switches."""
    plain = simulator(coil(), {"L": 1e-3, "R": R}, backend=backend)
    held = ZeroOrderHold(values=[3.0, -1.0, 4.0, 0.5] * 5, period=1e-3)
    for drive in (PWM(3e3, 0.4, 0.0, V, 0.3), Lag(Square(2e3, -1.0, V), 1e-3), held):
        audit = plain.run(np.linspace(0, 0.02, 101), {"i": 2.0}, {"u": drive}).audit()
        assert abs(audit.residual) <= 1e-9 * audit.turned_over
    switched = simulator(half_bridge(), {"L": 1e-3, "R": R}, backend=backend)
    inputs = {"V": V, "gate": PWM(3e3, 0.4, phase=0.3)}
    audit = switched.run(np.linspace(0, 0.02, 101), {}, inputs, initially_on=("high",)).audit()
    assert abs(audit.residual) <= 1e-9 * audit.turned_over
    assert audit.impacts == 0


@pytest.mark.parametrize("method", ["DOP853", "Radau"])
def test_integrators_pass_every_instant(method: str) -> None:
    """The methods that step with a tolerance, in numpy and in C; a sawtooth and a moving duty as well."""
    times = np.linspace(0.0, 0.01, 53)
    for drive in (
        PWM(5e3, Sine(0.4, 100.0, offset=0.5), 0.0, V, 0.2),
        Lag(Square(2e3, 0, V), 2e-4),
    ):
        exact = simulator(coil(), {"L": 1e-3, "R": R}).run(times, {}, {"u": drive})
        for backend in ("numpy", "c"):
            ready = simulator(coil(), {"L": 1e-3, "R": R}, backend=backend)
            run = ready.run(times, {}, {"u": drive}, method=method)
            assert run["i"] == pytest.approx(exact["i"], abs=1e-7)
            assert run["u"] == pytest.approx(exact["u"], rel=1e-14, abs=1e-14)


def _gate(values: Mapping[str, float]) -> dict[str, object]:
    return {"V": V, "gate": PWM(values["f"], values["d"])}


def _begun(values: Mapping[str, float]) -> dict[str, float]:
    return {"i": current(0.0, V, R, 1e-3, values["f"], values["d"], 0.0)}


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_sweeps_over_frequency_and_duty(backend: str) -> None:
    """Each run has pulses of its own; in C their number exceeds what is written at a time."""
    family = Family(half_bridge(), {"L": 1e-3, "R": R}, backend=backend)
    end = 3.21e-3 if backend == "numpy" else 0.20123
    measures = {"i": final("i"), "on": event_count("high", "on"), "off": event_count("high", "off")}
    found = sweep(
        family, {"f": [1e3, 12_345.0], "d": [0.2, 0.71]}, np.linspace(0.0, end, 9), measures,
        _begun, _gate, initially_on=("high",), workers=0,
    )  # fmt: skip
    rows = [(1e3, 0.2), (1e3, 0.71), (12_345.0, 0.2), (12_345.0, 0.71)]
    on, off, i = (found[name].ravel().tolist() for name in ("on", "off", "i"))
    counts = [switchings(0.0, end, f, d, 0.0) for f, d in rows]
    assert [one + other for one, other in zip(on, off, strict=True)] == counts
    assert i == pytest.approx([current(end, V, R, 1e-3, f, d, 0.0) for f, d in rows], abs=1e-9)


def test_sizes_of_pulses_are_swept() -> None:
    """One input for all runs, times a number of each."""
    family = Family(coil(), {"L": 1e-3, "R": R}, backend="c")
    for end in (0.01, 0.3):
        found = sweep(
            family, {"size": [1.0, 2.0, -3.0]}, [0.0, end],
            inputs={"u": Swept("size", PWM(2e3, 0.3) + Step(1e-3, 1.0))}, measures={"i": final("i")},
        )  # fmt: skip
        one = found["i"][0]
        assert found["i"] == pytest.approx(np.array([1.0, 2.0, -3.0]) * one, rel=1e-9)
        run = simulator(coil(), {"L": 1e-3, "R": R}, backend="c").run(
            [0.0, end], {}, {"u": PWM(2e3, 0.3) + Step(1e-3, 1.0)}
        )
        assert one == pytest.approx(run["i"][-1], rel=1e-11)
