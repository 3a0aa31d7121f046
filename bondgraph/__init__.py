"""Symbolic bond graphs: declared with networkx, derived into ``A x' = J x + B u``, slip ``= F x``."""

from bondgraph.assignments import Assignment, assignments
from bondgraph.causality import CausalGraph, assign_causality
from bondgraph.composition import assemble, prefixed
from bondgraph.drawing.picture import Drawing, drawing
from bondgraph.elements import GY, TF, C, De, Df, I, Kind, One, R, Se, Sf, Sw, Switch, Zero
from bondgraph.equations import StateEquations, derive, state_equations
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
    WriteError,
)
from bondgraph.explaining.explanation import Explanation, explain
from bondgraph.explaining.records import Equation, Factor, Formula, Step
from bondgraph.explicit import explicit
from bondgraph.expressions import expression
from bondgraph.files import read_graphml, read_json, write_graphml, write_json
from bondgraph.graph import validate
from bondgraph.graphml import from_graphml, to_graphml
from bondgraph.holding import holding_efforts
from bondgraph.junction import JunctionStructure, junction_structure
from bondgraph.latex import latex
from bondgraph.laws import DryFriction, ExpressionLaw
from bondgraph.linear import LinearModel, linearize
from bondgraph.loop_gains import Loop, loops
from bondgraph.nodelink import from_json, to_json
from bondgraph.switching import in_mode, switches

__all__ = [
    "GY",
    "TF",
    "AlgebraicLoopError",
    "Assignment",
    "BondGraphError",
    "C",
    "CausalGraph",
    "CausalityError",
    "De",
    "DependentSourceError",
    "Df",
    "Drawing",
    "DryFriction",
    "Equation",
    "Explanation",
    "ExpressionError",
    "ExpressionLaw",
    "Factor",
    "FileFormatError",
    "Formula",
    "I",
    "JunctionStructure",
    "Kind",
    "LinearModel",
    "Loop",
    "MissingExtraError",
    "ModelWarning",
    "One",
    "ParameterError",
    "R",
    "Se",
    "Sf",
    "SignalError",
    "SimulationError",
    "SingularStorageError",
    "StateEquations",
    "Step",
    "StoreError",
    "StructureError",
    "Sw",
    "Switch",
    "WriteError",
    "Zero",
    "assemble",
    "assign_causality",
    "assignments",
    "derive",
    "drawing",
    "explain",
    "explicit",
    "expression",
    "from_graphml",
    "from_json",
    "holding_efforts",
    "in_mode",
    "junction_structure",
    "latex",
    "linearize",
    "loops",
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
