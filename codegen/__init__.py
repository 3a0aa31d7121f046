"""From state equations to simulators: signals, programs, and the event-driven hybrid loop."""

from codegen.events import Event
from codegen.program import Block, Program, lower
from codegen.signals import Constant, Lag, Ramp, Sampled, Signal, Sine, Step
from codegen.simulate import Result, Simulator, simulator

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
    "lower",
    "simulator",
]
