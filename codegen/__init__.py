"""From state equations to simulators: signals, programs, and the event-driven hybrid loop."""

from codegen.events import Event
from codegen.program import Block, Program, lower
from codegen.result import Result
from codegen.signals import Constant, Lag, Ramp, Sampled, Signal, Sine, Step
from codegen.simulate import Simulator, simulator
from codegen.sparse import SparseModel, sparse_model
from codegen.sparse_run import run_sparse
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
    "SparseModel",
    "Step",
    "SwitchedSimulator",
    "lower",
    "run_sparse",
    "simulator",
    "sparse_model",
    "switched_simulator",
    "trim",
]
