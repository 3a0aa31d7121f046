"""Delays against solutions by hand: polynomials of the method of steps, shifted inputs, held segments."""

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


def test_what_has_no_past_refuses_delays_by_name() -> None:
    graph = bg.graph([bg.State("x", "-past", start=1), bg.Delay("past", "x", time="T", start=1)])
    equations = bg.derive(graph)
    ready = codegen.simulator(equations, {"T": 1})
    with pytest.raises(bg.SignalError, match="delay past: a delay has no finite number of states"):
        bg.linearize(equations)
    for ask in (
        lambda: codegen.to_c(equations, {"T": 1}), lambda: codegen.to_python(equations, {"T": 1}),
        lambda: codegen.trim(ready), lambda: ready.stepper(), lambda: ready.rhs(0.0, [1.0]),
    ):  # fmt: skip
        with pytest.raises(
            bg.StructureError, match="delay past: what it gives is told by the past"
        ):
            ask()
    with pytest.raises(bg.ParameterError, match="delay past: its time is 0"):
        codegen.simulator(equations, {"T": 0}).run([0, 1])
    with pytest.raises(bg.ParameterError, match=r"delay past: missing parameter\(s\) T"):
        codegen.simulator(equations, {}).run([0, 1], inputs={"T": 1})
    with pytest.raises(bg.StructureError, match="its time is -1"):
        bg.derive(bg.graph([bg.State("x", "y"), bg.Delay("y", "x", time=-1)]))
    assert "past: x as it was T s ago; 1 before a run has gone so far" in " ".join(
        str(equations).split()
    )
