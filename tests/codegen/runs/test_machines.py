"""State machines in runs, against what is known by hand."""

from collections.abc import Mapping

import numpy as np
import pytest
from oracles.exported import loaded

import bondgraph as bg
import codegen

pytestmark = pytest.mark.usefixtures("compiled_quickly")

BACKENDS = ("numpy", "c")


def _ramp(modes: str, transitions: Mapping[str, object], **more: object) -> bg.StateEquations:
    """A state x that rises by ``slope`` in a second, and a machine m that sees it."""
    machine = bg.StateMachine("m", modes.split(), transitions, **more)
    return bg.derive(bg.graph([bg.State("x", "1*slope"), machine]))


def _ran(
    equations: bg.StateEquations, backend: str, end: float = 2.0, **initial: float
) -> codegen.Result:
    ready = codegen.simulator(equations, {"slope": 1}, backend=backend)
    return ready.run(np.linspace(0, end, 41), initial)


def _told(run: codegen.Result) -> list[tuple[str, float]]:
    return [(event.kind, round(event.time, 9)) for event in run.events]


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("factors", [(1, 3), (3, 1), (1, 1)])
def test_of_transitions_at_one_instant_the_first_is_taken(
    backend: str, factors: tuple[int, int]
) -> None:
    one, other = (f"{factor}*(x - 1)" for factor in factors)
    found = _ran(_ramp("a b c", {"a > b": one, "a > c": other}), backend)
    assert _told(found) == [("a > b", 1.0)]
    found = _ran(_ramp("a b c", {"a > c": other, "a > b": one}), backend)
    assert _told(found) == [("a > c", 1.0)]


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_run_begins_in_the_mode_that_initial_tells(backend: str) -> None:
    equations = _ramp("a b", {"a > b": "x - 1", "b > a": ("x - 3/2", {"x": 0})})
    at_once = [("b > a", 0.0), ("a > b", 1.0), ("b > a", 1.5)]
    assert _told(_ran(equations, backend, m=1, x=1.75)) == at_once
    later = [("b > a", 0.25), ("a > b", 1.25), ("b > a", 1.75)]
    assert _told(_ran(equations, backend, m=1, x=1.25)) == later


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_guard_of_the_time_is_passed_at_its_instant(backend: str) -> None:
    stays = {"x": "x"}
    equations = _ramp("a b c", {"a > b": ("3*t - 1", stays), "b > c": "t**3 - 1"})
    times = [event.time for event in _ran(equations, backend).events]
    assert times == pytest.approx([1 / 3, 1.0], rel=1e-14)


@pytest.mark.parametrize("backend", BACKENDS)
def test_an_input_that_steps_takes_a_transition_at_its_step(backend: str) -> None:
    equations = _ramp("a b", {"a > b": ("throttle - 1/10", {"x": "x"}), "b > a": "1/20 - throttle"})
    ready = codegen.simulator(equations, {"slope": 1}, backend=backend)
    steps = codegen.Step(0.3, 1.0) + codegen.Step(0.7, -1.0)
    run = ready.run(np.linspace(0, 1, 11), inputs={"throttle": steps})
    assert [(event.kind, event.time) for event in run.events] == [("a > b", 0.3), ("b > a", 0.7)]
    assert run["m_b"].tolist() == [0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0]


@pytest.mark.parametrize("backend", BACKENDS)
def test_at_one_instant_a_controller_comes_after_and_leads_on(backend: str) -> None:
    """At t = 1 the machine goes to b by x; the controller then sees b, and by what it gives c follows."""
    nodes = [
        bg.State("x", "1*slope"), bg.Controller("sees", every=1, gives={"seen": "m_b"}),
        bg.StateMachine("m", ["a", "b", "c"], {"a > b": "x - 1 + m_a*0", "b > c": "seen - 1/2"}),
    ]  # fmt: skip
    found = _ran(bg.derive(bg.graph(nodes)), backend, end=3.0, x=0.5)
    assert _told(found) == [("a > b", 0.5), ("b > c", 1.0)]


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_storage_is_set_and_energy_accounts_for_it(backend: str) -> None:
    """A mass at speed 2 is brought to half that as it has come to 1 m: 3/4 of its energy is taken."""
    machine = bg.StateMachine("m", ["fast", "slow"], {"fast > slow": ("s - 1", {"v": "v/2"})})
    graph = bg.graph(
        [bg.Se("none", "0*t"), bg.One("n"), bg.I("mass", 3, flow="v"), bg.Df("way", integrate="s"),
         machine], "none > n > mass, n > way"
    )  # fmt: skip
    run = codegen.simulator(bg.derive(graph), {}, backend=backend).run([0, 0.25, 1.0], {"v": 2})
    assert run["v"].tolist() == [2, 2, 1]
    assert run["s"].tolist() == pytest.approx([0, 0.5, 1.5], abs=1e-12)
    assert run.audit().resets == pytest.approx(3 / 2 * (4 - 1))
    assert abs(run.audit().residual) < 1e-9


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_transition_to_itself_is_taken_each_time(backend: str) -> None:
    """sin(2 pi t) rises through 1/2 once a second; one that is above zero at the start counts, too."""
    machine = bg.StateMachine(
        "m", ["on"], {"on > on": ("sin(2*pi*(t + ahead)) - 1/2", {"n": "n + 1"})}, states={"n": 0}
    )
    equations = bg.derive(bg.graph([machine]))
    for ahead, first in ((0.0, 1 / 12), (0.25, 0.0)):
        ready = codegen.simulator(equations, {"ahead": ahead}, backend=backend)
        run = ready.run(np.linspace(0, 2.5, 26))
        times = [event.time for event in run.events]
        assert times[0] == pytest.approx(first, abs=1e-9)
        assert np.diff(times[1:]) == pytest.approx([1.0] * (len(times) - 2), abs=1e-9)
        assert run["n"][-1] == len(times) == 3


def test_what_leads_round_without_end_is_refused_by_its_names() -> None:
    equations = _ramp("a b", {"a > b": "x - 1", "b > a": "x - 1/2"})
    for backend in BACKENDS:
        with pytest.raises(
            bg.SimulationError, match=r"'m' \(a > b\), 'm' \(b > a\) lead to one another"
        ):
            _ran(equations, backend)
    module = loaded(codegen.to_python(equations, {"slope": 1}, None, "ramp"))
    with pytest.raises(ArithmeticError, match="without end"):
        module.simulate(np.linspace(0, 2, 5), {}, {}, step=0.01)


def test_measures_count_transitions_and_refuse_others() -> None:
    equations = _ramp("a b", {"a > b": ("x - 1", {"x": 0}), "b > a": "x - 1/2"})
    measures = {
        "n": codegen.event_count("m", "a > b"), "first": codegen.first_event("m", "b > a")
    }  # fmt: skip
    for backend in BACKENDS:
        family = codegen.Family(equations, {"slope": 1}, backend=backend)
        found = codegen.sweep(
            family, codegen.Table(slope=[1.0, 2.0]), np.linspace(0, 2.9, 30), measures, workers=0,
            progress=False,
        )  # fmt: skip
        assert found["n"].tolist() == [2, 5]
        assert found["first"] == pytest.approx([1.5, 0.75])
        wrong = {"n": codegen.event_count("m", "a > c")}
        with pytest.raises(bg.SignalError, match="'m' has no transition 'a > c'"):
            codegen.sweep(
                family, codegen.Table(slope=[1.0]), [0, 1], wrong, workers=0, progress=False
            )


@pytest.mark.parametrize("backend", BACKENDS)
def test_steps_from_outside_tell_what_happened_at_the_begin(backend: str) -> None:
    ready = codegen.simulator(_ramp("a b", {"a > b": "u - x"}), {"slope": 1}, backend=backend)
    one = ready.stepper(inputs={"u": 1})
    assert [(event.kind, event.time) for event in one.events] == [("a > b", 0.0)]
    assert one.advance(0.5)["m"] == 1
    assert one.events == ()
    # Under another input from the begin on it is not taken there.
    other = ready.stepper(inputs={"u": 0})
    assert other.events == ()
    assert other.advance(0.5, u=1)["m"] == 1
    assert [(event.kind, event.time) for event in other.events] == [("a > b", 0.0)]


def test_rest_and_slopes_are_of_the_mode_that_is_told() -> None:
    """v' = 2 u - v in low, u - v in high: at u = 3 it rests at 6 or 3."""
    machine = bg.StateMachine("gear", ["low", "high"], {"low > high": "v - up", "high > low": "-v"})
    graph = bg.graph(
        [bg.Se("drive", "u*(2*gear_low + gear_high)"), bg.One("n"), bg.I("m", 1, flow="v"),
         bg.R("b", 1), machine], "drive > n > m, n > b"
    )  # fmt: skip
    equations = bg.derive(graph)
    ready = codegen.simulator(equations, {"up": 8})
    for mode, speed, gain in (("low", 6, 2), ("high", 3, 1)):
        point = codegen.trim(ready, {"u": 3}, {"v": 1}, mode={"gear": mode})
        assert (point["v"], point["gear"]) == pytest.approx((speed, 2 - gain))
        model = bg.linearize(equations, at={"u": 3}, mode={"gear": mode}, inputs=["u"])
        assert list(model.B[0, :]) == [gain]
    with pytest.raises(bg.SimulationError, match="'gear' would not stay, low > high is taken"):
        codegen.trim(
            codegen.simulator(equations, {"up": 5}), {"u": 3}, {"v": 1}, mode={"gear": "low"}
        )
    with pytest.raises(bg.StructureError, match=r"'gear' is never in 'hig'.*did you mean 'high'"):
        bg.linearize(equations, mode={"gear": "hig"})
    with pytest.raises(
        bg.StructureError, match="'gear' is in 'high', number 1, but gear is told as 0"
    ):
        bg.linearize(equations, at={"gear": 0}, mode={"gear": "high"})
