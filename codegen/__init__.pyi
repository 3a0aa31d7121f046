from codegen.analysis.comparison import Comparison, compare
from codegen.analysis.spectrum import Spectrum, spectrum
from codegen.c.export import to_c
from codegen.called.function import TimeFunction
from codegen.cosimulation.cosimulate import cosimulate
from codegen.cosimulation.record import CoSimulation
from codegen.energy.audit import Audit
from codegen.engine.fallback import BackendWarning
from codegen.family import Family
from codegen.fmu.export import write_fmu
from codegen.inputs.held import Pulse, ZeroOrderHold
from codegen.inputs.periodic import PWM, Sawtooth, Square
from codegen.inputs.sampled import Sampled
from codegen.inputs.signal import Signal
from codegen.inputs.signals import Constant, Lag, Ramp, Sine, Step
from codegen.inputs.swept import Swept
from codegen.plots.bode import bode
from codegen.plots.panels import panels
from codegen.plots.poles import pole_map
from codegen.plots.shapes import mode_shapes
from codegen.program.lower import lower
from codegen.program.records import Block, Program
from codegen.python.export import to_python
from codegen.record.measures import (
    balance,
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
from codegen.record.result import Result
from codegen.runs.track import Event
from codegen.simulate import simulator
from codegen.simulator import Simulator
from codegen.sparse.model import SparseModel, sparse_model
from codegen.sparse.run import run_sparse
from codegen.stepping.state import StepperState
from codegen.stepping.stepper import Stepper
from codegen.streaming.streamed import Streamed
from codegen.sweeps.design import Grid, Samples, Table
from codegen.sweeps.result import Failure, Sweep, SweepInterrupted
from codegen.sweeps.sweep import sweep
from codegen.switched.simulator import SwitchedSimulator, switched_simulator
from codegen.trim import trim

__all__ = [
    "PWM",
    "Audit",
    "BackendWarning",
    "Block",
    "CoSimulation",
    "Comparison",
    "Constant",
    "Event",
    "Failure",
    "Family",
    "Grid",
    "Lag",
    "Program",
    "Pulse",
    "Ramp",
    "Result",
    "Sampled",
    "Samples",
    "Sawtooth",
    "Signal",
    "Simulator",
    "Sine",
    "SparseModel",
    "Spectrum",
    "Square",
    "Step",
    "Stepper",
    "StepperState",
    "Streamed",
    "Sweep",
    "SweepInterrupted",
    "Swept",
    "SwitchedSimulator",
    "Table",
    "TimeFunction",
    "ZeroOrderHold",
    "balance",
    "bode",
    "compare",
    "cosimulate",
    "event_count",
    "final",
    "first_event",
    "integral",
    "largest",
    "lower",
    "mode_shapes",
    "panels",
    "peak",
    "pole_map",
    "run_sparse",
    "samples",
    "simulator",
    "smallest",
    "sparse_model",
    "spectrum",
    "sweep",
    "switched_simulator",
    "to_c",
    "to_python",
    "trim",
    "work",
    "write_fmu",
]
