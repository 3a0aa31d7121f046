"""From state equations to simulators: signals, programs, and the event-driven hybrid loop."""

from codegen.events import Event
from codegen.program import Block, Program, lower
from codegen.result import Result
from codegen.signals import Constant, Lag, Ramp, Sampled, Signal, Sine, Step
from codegen.simulate import Simulator, simulator
from codegen.switched import SwitchedSimulator, switched_simulator
from codegen.trim import trim

__all__ = [
    "Block",
    "Constant",
    "Event",
    "Lag",
    "Program",
    "Ramp",
    "Result",
    "Sampled",
    "Signal",
    "Simulator",
    "Sine",
    "Step",
    "SwitchedSimulator",
    "lower",
    "simulator",
    "switched_simulator",
    "trim",
]
