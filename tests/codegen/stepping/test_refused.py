"""What steppers refuse, by name, and that what fails leaves them where they were."""

import math
import warnings

import pytest
from references.build import bond_graph

import bondgraph as bg
from codegen import PWM, BackendWarning, Lag, Sine, Step, Stepper, simulator, switched_simulator
from codegen.inputs.signals import Constant

BACKENDS = pytest.mark.parametrize("backend", ["numpy", "c"])

MASS = bg.graph([bg.Se("force", "F"), bg.One("mass"), bg.I("m", "m", flow="v")], "force > mass > m")


def mass(backend: str = "numpy") -> Stepper:
    return simulator(bg.derive(MASS), {"m": 2}, backend=backend).stepper(inputs={"F": 1})


@pytest.mark.parametrize("step", [0, -1.0, math.nan, math.inf, "1", True, 1j])
def test_a_step_is_a_positive_time(step: object) -> None:
    with pytest.raises(bg.errors.SignalError, match="a step must be a positive number of seconds"):
        mass().advance(step)  # type: ignore[arg-type]


def test_a_step_leads_on() -> None:
    one = mass()
    one.advance(1e9)
    with pytest.raises(bg.errors.SignalError, match="leads to no later time"):
        one.advance(1e-9)
    assert one.time == 1e9


def test_inputs_are_those_of_the_model() -> None:
    with pytest.raises(bg.errors.SignalError, match=r"unknown input 'G'.*the model's inputs are F"):
        mass().advance(0.1, G=1.0)
    with pytest.raises(bg.errors.SignalError, match="input 'F': nan is not a finite number"):
        mass().advance(0.1, F=math.nan)
    with pytest.raises(
        bg.errors.SignalError, match="input 'F': 'a' is neither a signal nor a number"
    ):
        mass().advance(0.1, F="a")
    with pytest.raises(bg.errors.SignalError, match="missing input"):
        simulator(bg.derive(MASS), {"m": 2}).stepper()
    with pytest.raises(bg.errors.SignalError, match="the time must be a finite number"):
        simulator(bg.derive(MASS), {"m": 2}).stepper(inputs={"F": 1}, time=math.inf)


def test_a_state_is_of_the_same_model() -> None:
    other = bg.graph(
        [bg.Se("force", "F"), bg.One("mass"), bg.I("m", "m", flow="w")], "force > mass > m"
    )
    there = simulator(bg.derive(other), {"m": 2}).stepper(inputs={"F": 1})
    with pytest.raises(bg.errors.SignalError, match="the state of another model: its states"):
        mass().restore(there.state)
    with pytest.raises(bg.errors.SignalError, match="goes back to what its state was, not to 3"):
        mass().restore(3)  # type: ignore[arg-type]


def gear() -> bg.StateEquations:
    """A friction level that an input tells, which falls below zero."""
    nodes = [
        bg.Se("force", "F"),
        bg.One("j"),
        bg.I("m", 1, flow="v"),
        bg.R("rub", law=bg.DryFriction("L")),
    ]
    return bg.derive(bond_graph(nodes, "force>j>m j>rub"))


@BACKENDS
@pytest.mark.parametrize("level", [-1.0, Step(0.55, -1.0, initial=2.0)])
def test_what_fails_leaves_it_where_it_was(backend: str, level: object) -> None:
    """At once, or within the step; and inputs are what they were."""
    one = simulator(gear(), {}, backend=backend).stepper({"v": 4.0}, {"F": 0.0, "L": 2.0})
    one.advance(0.25)
    before = one.state, dict(one.signals), one.events
    with pytest.raises(bg.errors.SimulationError):
        one.advance(0.5, F=3.0, L=level)
    assert (one.state, dict(one.signals), one.events) == before
    assert one.advance(0.25)["v"] == pytest.approx(3.0, abs=1e-9)


@BACKENDS
def test_the_first_step_may_fail_too(backend: str) -> None:
    one = simulator(gear(), {}, backend=backend).stepper({"v": 4.0}, {"F": 0.0, "L": 2.0})
    with pytest.raises(bg.errors.SimulationError):
        one.advance(0.5, L=-1.0)
    assert one.time == 0.0
    assert one.advance(0.25)["v"] == pytest.approx(3.5, abs=1e-9)


def wheels() -> bg.StateEquations:
    """A speed source that drives an inertia, whose torque is its rate."""
    nodes = [bg.Sf("drive", "w"), bg.One("j"), bg.I("wheel", 2)]
    return bg.derive(bond_graph(nodes, "drive>j>wheel"), outputs=["drive"])


@BACKENDS
def test_steps_that_would_be_impulses_are_refused_as_in_a_run(backend: str) -> None:
    one = simulator(wheels(), {}, backend=backend).stepper(inputs={"w": 1.0})
    one.advance(0.5)
    with pytest.raises(bg.errors.SimulationError, match=r"input 'w' steps at t = 0\.5, where"):
        one.advance(0.5, w=2.0)
    with pytest.raises(bg.errors.SimulationError, match=r"input 'w' steps at t = 0\.75, where"):
        one.advance(0.5, w=Step(0.75, 2.0, initial=1.0))
    smooth = Lag(Step(0.5, 2.0, initial=1.0), 0.5)
    assert one.advance(0.5, w=smooth)["w"] == pytest.approx(2 - math.exp(-1))


def test_what_c_cannot_step_numpy_does_with_a_word() -> None:
    """A lag of a pulse wave whose width is a signal, which is in no table, before a law that is no line."""
    nodes = [
        bg.Se("force", "F"),
        bg.One("j"),
        bg.I("m", 1, flow="v"),
        bg.R("drag", law="v**3", flow="v_d"),
    ]
    ready = simulator(bg.derive(bond_graph(nodes, "force>j>m j>drag")), {}, backend="c")
    one = ready.stepper({"v": 1.0}, {"F": 0.0})
    one.advance(0.5)
    # v' = -v^3
    assert (one.backend, one.signals["v"]) == ("c", pytest.approx(2**-0.5, abs=1e-7))
    lagged = Lag(PWM(10.0, Sine(0.2, 1.0, offset=0.5)), 0.1)
    with pytest.warns(
        BackendWarning, match="numpy steps what backend 'c' was asked to: a lag of a PWM"
    ):
        one.advance(0.01, F=lagged)
    assert one.backend == "numpy"
    before = one.time
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        one.advance(0.5, F=0.0)
    assert one.time == pytest.approx(before + 0.5)


def test_methods_that_c_has_not_are_numpys() -> None:
    ready = simulator(bg.derive(MASS), {"m": 2}, backend="c")
    with pytest.raises(bg.errors.SignalError, match="unknown method 'euler'"):
        ready.stepper(inputs={"F": 1}, method="euler")
    with pytest.warns(BackendWarning, match="C has no method 'CVODE'"):
        assert ready.stepper(inputs={"F": Constant(1)}, method="CVODE").backend == "numpy"


def test_graphs_with_switches_step_as_well_and_tell_of_completed_starts() -> None:
    """A dog that is in joins 1 kg at 4 m/s to 3 kg that nobody named."""
    nodes = [bg.One("first"), bg.I("m_1", 1, flow="v_1"), bg.Zero("gap"), bg.Sw("slack", on="t - 1"),
             bg.One("second"), bg.I("m_2", 3, flow="v_2")]  # fmt: skip
    graph = bond_graph(nodes, "first>m_1 first>gap>slack gap>second>m_2")
    ready = switched_simulator(graph, {})
    with pytest.warns(bg.errors.ModelWarning, match="v_2 = 4"):
        one = ready.stepper({"v_1": 4.0})
    assert one.signals["v_2"] == pytest.approx(4.0)
    assert one.advance(1.5)["slack"] == 1.0
    assert [(e.time, e.kind) for e in one.events] == [(1.0, "on")]
