from bondgraph.algebra.expressions import expression
from bondgraph.algebra.lookup_table import LookupTable
from bondgraph.analyse.linear_model import LinearModel
from bondgraph.analyse.linearize import linearize
from bondgraph.analyse.loops import Loop, loops
from bondgraph.analyse.sampled import SampledModel
from bondgraph.analyse.sticking import holding_efforts
from bondgraph.blocks.linear import Integrator, StateSpace, TransferFunction
from bondgraph.blocks.pid import PID
from bondgraph.blocks.static import DeadZone, Gain, Limiter, LookUp, Sum
from bondgraph.causality.assign import assign_causality
from bondgraph.causality.assignments import Assignment, assignments
from bondgraph.causality.causal_graph import CausalGraph
from bondgraph.checking.check import check
from bondgraph.checking.merging import merged
from bondgraph.checking.paths import CausalPath, CausalPaths, causal_paths
from bondgraph.checking.records import Check, Finding, StrokeVerdict
from bondgraph.declare.composition import assemble, prefixed
from bondgraph.declare.drawn import BondGraph
from bondgraph.declare.paths import graph
from bondgraph.declare.switching import in_mode, switches
from bondgraph.declare.validate import validate
from bondgraph.derive import derive, state_equations
from bondgraph.drawing.picture import Drawing, drawing
from bondgraph.equations import StateEquations
from bondgraph.errors import (
    AlgebraicLoopError,
    BondGraphError,
    CausalityError,
    DependentSourceError,
    ExpressionError,
    FileFormatError,
    MissingExtraError,
    ModelWarning,
    ParameterError,
    SignalError,
    SimulationError,
    SingularStorageError,
    StoreError,
    StructureError,
    TableError,
    UnitError,
    WriteError,
)
from bondgraph.explaining.explanation import Explanation, explain
from bondgraph.explaining.latex import latex
from bondgraph.explaining.records import Equation, Factor, Formula, Step
from bondgraph.files.disk import read_graphml, read_json, write_graphml, write_json
from bondgraph.files.graphml import from_graphml, to_graphml
from bondgraph.files.nodelink import from_json, to_json
from bondgraph.nodes.controllers import Controller
from bondgraph.nodes.delays import Delay
from bondgraph.nodes.elements import GY, TF, C, De, Df, I, One, R, Se, Sf, Sw, Switch, Zero
from bondgraph.nodes.hysteresis import Hysteresis
from bondgraph.nodes.kinds import Kind
from bondgraph.nodes.laws import DryFriction, ExpressionLaw
from bondgraph.nodes.machines import StateMachine
from bondgraph.nodes.one_way import CheckValve, Diode, Freewheel
from bondgraph.nodes.rate_limiter import RateLimiter
from bondgraph.nodes.signals import Function, State
from bondgraph.nodes.stops import Stop
from bondgraph.rates.explicit import explicit
from bondgraph.rates.record import ExplicitRates
from bondgraph.reduce.junction import junction_structure
from bondgraph.reduce.structure import JunctionStructure
from bondgraph.reduce.switch_port import SwitchPort
from bondgraph.sampling.space import SampledSpace

__all__ = [
    "GY",
    "PID",
    "TF",
    "AlgebraicLoopError",
    "Assignment",
    "BondGraph",
    "BondGraphError",
    "C",
    "CausalGraph",
    "CausalPath",
    "CausalPaths",
    "CausalityError",
    "Check",
    "CheckValve",
    "Controller",
    "De",
    "DeadZone",
    "Delay",
    "DependentSourceError",
    "Df",
    "Diode",
    "Drawing",
    "DryFriction",
    "Equation",
    "Explanation",
    "ExplicitRates",
    "ExpressionError",
    "ExpressionLaw",
    "Factor",
    "FileFormatError",
    "Finding",
    "Formula",
    "Freewheel",
    "Function",
    "Gain",
    "Hysteresis",
    "I",
    "Integrator",
    "JunctionStructure",
    "Kind",
    "Limiter",
    "LinearModel",
    "LookUp",
    "LookupTable",
    "Loop",
    "MissingExtraError",
    "ModelWarning",
    "One",
    "ParameterError",
    "R",
    "RateLimiter",
    "SampledModel",
    "SampledSpace",
    "Se",
    "Sf",
    "SignalError",
    "SimulationError",
    "SingularStorageError",
    "State",
    "StateEquations",
    "StateMachine",
    "StateSpace",
    "Step",
    "Stop",
    "StoreError",
    "StrokeVerdict",
    "StructureError",
    "Sum",
    "Sw",
    "Switch",
    "SwitchPort",
    "TableError",
    "TransferFunction",
    "UnitError",
    "WriteError",
    "Zero",
    "assemble",
    "assign_causality",
    "assignments",
    "causal_paths",
    "check",
    "derive",
    "drawing",
    "explain",
    "explicit",
    "expression",
    "from_graphml",
    "from_json",
    "graph",
    "holding_efforts",
    "in_mode",
    "junction_structure",
    "latex",
    "linearize",
    "loops",
    "merged",
    "prefixed",
    "read_graphml",
    "read_json",
    "state_equations",
    "switches",
    "to_graphml",
    "to_json",
    "validate",
    "write_graphml",
    "write_json",
]
