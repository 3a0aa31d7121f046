"""From state equations to simulators: signals, programs, the event-driven hybrid loop, and sweeps."""

from codegen.c import to_c
from codegen.events import Event
from codegen.family import Family
from codegen.fmu import write_fmu
from codegen.measures import (
    event_count,
    final,
    first_event,
    integral,
    largest,
    peak,
    samples,
    smallest,
    work,
)
from codegen.program import Block, Program, lower
from codegen.python import to_python
from codegen.result import Result
from codegen.signals import Constant, Lag, Ramp, Sampled, Signal, Sine, Step
from codegen.simulate import Simulator, simulator
from codegen.sparse import SparseModel, sparse_model
from codegen.sparse_run import run_sparse
from codegen.sweep import sweep
from codegen.sweep_design import Grid, Samples, Table
from codegen.sweep_result import Failure, Sweep, SweepInterrupted
from codegen.switched import SwitchedSimulator, switched_simulator
from codegen.trim import trim

__all__ = [
    "Block",
    "Constant",
    "Event",
    "Failure",
    "Family",
    "Grid",
    "Lag",
    "Program",
    "Ramp",
    "Result",
    "Sampled",
    "Samples",
    "Signal",
    "Simulator",
    "Sine",
    "SparseModel",
    "Step",
    "Sweep",
    "SweepInterrupted",
    "SwitchedSimulator",
    "Table",
    "event_count",
    "final",
    "first_event",
    "integral",
    "largest",
    "lower",
    "peak",
    "run_sparse",
    "samples",
    "simulator",
    "smallest",
    "sparse_model",
    "sweep",
    "switched_simulator",
    "to_c",
    "to_python",
    "trim",
    "work",
    "write_fmu",
]
