"""Delays against solutions by hand: polynomials of the method of steps, shifted inputs, held segments."""

import pickle
from math import exp, factorial

import numpy as np
import pytest

import bondgraph as bg
import codegen

BACKENDS = ("numpy", "c")


def _hayes(times: np.ndarray) -> np.ndarray:
    """x' = -x(t - 1), x = 1 up to 0: sum of (-1)^k (t - k + 1)^k / k!, each from t = k - 1 on."""
    found = np.ones_like(times)
    for k in range(1, 14):
        since = np.maximum(times - (k - 1), 0.0)
        found += (-1) ** k * since**k / factorial(k)
    return found


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_state_that_follows_its_own_past(backend: str) -> None:
    graph = bg.graph([bg.State("x", "-past", start=1), bg.Delay("past", "x", time="T", start=1)])
    times = np.linspace(0, 10, 101)
    run = codegen.simulator(bg.derive(graph), {"T": 1}, backend=backend).run(times)
    assert run.backend == backend
    np.testing.assert_allclose(run["x"], _hayes(times), atol=1e-12)
    np.testing.assert_allclose(run["past"][10:], _hayes(times[:-10]), atol=1e-12)
    assert (run["past"][:10] == 1).all()


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_jump_comes_later_as_a_jump(backend: str) -> None:
    """x' = u(t - T), u a step at 0.3 and a ramp's corner at 0.7: x has them at 0.3 + T and 0.7 + T."""
    graph = bg.graph([bg.State("x", "late"), bg.Delay("late", "u", time=0.25)])
    u = codegen.Step(0.3, 2.0) + codegen.Ramp(0.7, 5 / 0.3, end=1.0)
    times = np.linspace(0, 1.5, 61)
    run = codegen.simulator(bg.derive(graph), {}, backend=backend).run(times, inputs={"u": u})
    first, ramp = np.maximum(times - 0.55, 0), np.clip(times - 0.95, 0, 0.3)
    rise = 0.5 * ramp**2 * 5 / 0.3 + 5 * np.maximum(times - 1.25, 0)
    np.testing.assert_allclose(run["x"], 2 * first + rise, atol=1e-12)
    at = int(np.searchsorted(times, 0.55))
    assert run["late"][at - 1] == 0.0
    assert run["late"][at] == pytest.approx(2.0, abs=1e-12)


def test_a_sampled_controller_over_a_late_line() -> None:
    """A torque that is held and comes 2.5 periods later: between its changes the shaft relaxes to it."""
    J, b, K, every, late = 0.5, 0.2, 1.5, 0.04, 0.1
    graph = bg.graph(
        [bg.Se("motor", "1*line"), bg.One("shaft"), bg.I("J", J, flow="omega"), bg.R("b", b),
         bg.Controller("p", every=every, gives={"u": "K*(1 - omega)"}), bg.Delay("line", "u", time="T")],
        "motor > shaft > J, shaft > b")  # fmt: skip
    times = np.linspace(0, 1, 51)
    run = codegen.simulator(bg.derive(graph), {"K": K, "T": late}).run(times)

    def relaxed(w: float, tau: float, time: float) -> float:
        return tau / b + (w - tau / b) * exp(-b / J * time)

    w, t, torque, sent, found = 0.0, 0.0, 0.0, list[tuple[float, float]](), []
    instants = [(k * every, "tick") for k in range(27)]
    arrivals = [(k * every + late, "line") for k in range(27)]
    samples = [(float(time), "sample") for time in times]
    order = {"line": 0, "tick": 1, "sample": 2}
    for time, what in sorted(
        instants + arrivals + samples, key=lambda one: (round(one[0], 12), order[one[1]])
    ):
        w, t = relaxed(w, torque, time - t), time
        if what == "tick":
            sent.append((time + late, K * (1 - w)))
        elif what == "line":
            torque = sent.pop(0)[1]
        else:
            found.append(w)
    np.testing.assert_allclose(run["omega"], found, atol=1e-11)


def test_sweeps_and_records_of_runs_with_delays() -> None:
    graph = bg.graph([bg.State("x", "-past", start=1), bg.Delay("past", "x", time="T", start=1)])
    family = codegen.Family(bg.derive(graph), {"T": 1})
    times = np.linspace(0, 2, 21)
    found = codegen.sweep(family, {"T": [0.5, 1.0]}, times, {"end": codegen.final("x")}, workers=0,
                          progress=False)  # fmt: skip
    # x(2) for a delay of 1/2: 4 terms of the same sum, in units of the delay.
    half = 1 - 2 + 1.5**2 / 2 - 1 / 6 + 0.5**4 / 24
    np.testing.assert_allclose(found["end"], [half, _hayes(times)[-1]], atol=1e-12)
    run = family.simulator().run(times)
    assert run.integral("past")[-1] == pytest.approx(1 - run["x"][-1], abs=1e-9)


@pytest.mark.parametrize("backend", BACKENDS)
def test_breaks_that_no_step_sees_are_none(backend: str) -> None:
    """Instants and two delays without a common measure: jumps wear off, so parts do not grow in number."""
    graph = bg.graph(
        [bg.Se("motor", "1*line"), bg.One("shaft"), bg.I("J", "J", flow="omega"), bg.R("b", "b"),
         bg.Controller("p", every=0.05, gives={"u": "K*(1 - seen)"}),
         bg.Delay("line", "u", time=0.0323), bg.Delay("seen", "omega", time=0.0113)],
        "motor > shaft > J, shaft > b")  # fmt: skip
    J, b, K, end = 0.1, 0.2, 0.5, 0.4
    model = codegen.simulator(bg.derive(graph), {"J": J, "b": b, "K": K}, backend=backend)
    w, torque, at, sent = 0.0, 0.0, 0.0, list[tuple[float, float]]()
    ticks = [(0.05 * k, 1, 0.0) for k in range(8)]
    # What is seen at an instant was omega so much earlier: before that instant it is noted.
    notes = [(0.05 * k - 0.0113, 0, 0.0) for k in range(1, 8)]
    arrivals = [(0.05 * k + 0.0323, 2, 0.0) for k in range(8)]
    seen = [0.0]
    for time, what, _ in sorted([*ticks, *notes, *arrivals, (end, 3, 0.0)]):
        w = torque / b + (w - torque / b) * exp(-b / J * (time - at))
        at = time
        if what == 0:
            seen.append(w)
        elif what == 1:
            sent.append((time, K * (1 - seen.pop(0))))
        elif what == 2:
            torque = sent.pop(0)[1]
    run = model.run([0.0, end])
    assert run["omega"][-1] == pytest.approx(w, abs=1e-11)


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_stepper_remembers(backend: str) -> None:
    graph = bg.graph(
        [bg.State("x", "-past + u", start=1), bg.Delay("past", "x", time="T", start=1)]
    )
    ready = codegen.simulator(bg.derive(graph), {"T": 1}, backend=backend)
    stepper = ready.stepper(inputs={"u": 0})
    assert stepper.backend == backend
    times = np.arange(1, 41) * 0.125
    found = [stepper.advance(0.125)["x"] for _ in times]
    np.testing.assert_allclose(found, _hayes(times), atol=1e-12)
    assert stepper.signals["past"] == pytest.approx(float(_hayes(np.array([4.0]))[0]), abs=1e-12)
    kept = pickle.loads(pickle.dumps(stepper.state))
    there = stepper.advance(1.5, u=2.0)["x"]
    stepper.restore(kept)
    assert (stepper.time, stepper.signals["x"]) == (5.0, found[-1])
    assert stepper.advance(1.5, u=2.0)["x"] == pytest.approx(there, abs=1e-14)
    one = ready.run([0.0, 6.5], inputs={"u": codegen.Step(5.0, 2.0)})
    assert there == pytest.approx(one["x"][-1], abs=1e-12)
    with pytest.raises(bg.SignalError, match="unknown input 'past'; the model's inputs are u"):
        stepper.advance(0.1, past=1.0)
    with pytest.raises(bg.SignalError, match="unknown input 'past'"):
        stepper.give(past=1.0)
    with pytest.raises(bg.SignalError, match="goes back to what its state was"):
        stepper.restore("before")
    assert stepper.advance(0.0625)["x"] != there


def test_at_rest_a_delay_gives_what_it_reads() -> None:
    graph = bg.graph([bg.State("x", "u - 2*past"), bg.Delay("past", "x + x**3", time="T", start=5)])
    point = codegen.trim(codegen.simulator(bg.derive(graph), {"T": 1}), {"u": 4.0}, {"x": 0.5})
    assert point["x"] == pytest.approx(1.0, abs=1e-9)
    assert point["past"] == pytest.approx(2.0, abs=1e-9)


def test_what_has_no_past_refuses_delays_by_name() -> None:
    graph = bg.graph([bg.State("x", "-past", start=1), bg.Delay("past", "x", time="T", start=1)])
    equations = bg.derive(graph)
    ready = codegen.simulator(equations, {"T": 1})
    with pytest.raises(bg.SignalError, match="delay past: a delay has no finite number of states"):
        bg.linearize(equations)
    with pytest.raises(bg.StructureError, match="delay past: what it gives is told by the past"):
        ready.rhs(0.0, [1.0])
    for ask in (
        lambda: codegen.simulator(equations, {"T": 0}).run([0, 1]),
        lambda: codegen.simulator(equations, {"T": 0}).stepper(),
        lambda: codegen.to_c(equations, {"T": 0}), lambda: codegen.to_python(equations, {"T": 0}),
    ):  # fmt: skip
        with pytest.raises(bg.ParameterError, match="delay past: its time is 0"):
            ask()
    with pytest.raises(bg.ParameterError, match=r"delay past: missing parameter\(s\) T"):
        codegen.simulator(equations, {}).run([0, 1], inputs={"T": 1})
    with pytest.raises(bg.StructureError, match="its time is -1"):
        bg.derive(bg.graph([bg.State("x", "y"), bg.Delay("y", "x", time=-1)]))
    assert "past: x as it was T s ago; 1 before a run has gone so far" in " ".join(
        str(equations).split()
    )
