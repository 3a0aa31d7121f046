"""Symbolic bond graphs: declared with networkx, derived into ``A x' = J x + B u``, slip ``= F x``."""

from bondgraph.causality import CausalGraph, assign_causality
from bondgraph.elements import GY, TF, C, De, Df, I, Kind, One, R, Se, Sf, Zero
from bondgraph.equations import StateEquations, derive, state_equations
from bondgraph.errors import (
    AlgebraicLoopError,
    BondGraphError,
    CausalityError,
    DependentSourceError,
    ExpressionError,
    MissingExtraError,
    ParameterError,
    SignalError,
    SimulationError,
    SingularStorageError,
    StructureError,
)
from bondgraph.expressions import expression
from bondgraph.graph import validate
from bondgraph.holding import holding_efforts
from bondgraph.junction import JunctionStructure, junction_structure
from bondgraph.laws import DryFriction, ExpressionLaw
from bondgraph.linear import LinearModel, linearize

__all__ = [
    "GY",
    "TF",
    "AlgebraicLoopError",
    "BondGraphError",
    "C",
    "CausalGraph",
    "CausalityError",
    "De",
    "DependentSourceError",
    "Df",
    "DryFriction",
    "ExpressionError",
    "ExpressionLaw",
    "I",
    "JunctionStructure",
    "Kind",
    "LinearModel",
    "MissingExtraError",
    "One",
    "ParameterError",
    "R",
    "Se",
    "Sf",
    "SignalError",
    "SimulationError",
    "SingularStorageError",
    "StateEquations",
    "StructureError",
    "Zero",
    "assign_causality",
    "derive",
    "expression",
    "holding_efforts",
    "junction_structure",
    "linearize",
    "state_equations",
    "validate",
]
