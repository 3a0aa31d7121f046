"""Differentials of Deur, Hancock and Assadian (2008), and parts to build others from."""

from differentials.parameters import PARAMETERS, Parameter
from differentials.scenarios import Scenario, scenarios, simulate
from differentials.topologies import Differential, catalog, equations, graph

__all__ = [
    "PARAMETERS",
    "Differential",
    "Parameter",
    "Scenario",
    "catalog",
    "equations",
    "graph",
    "scenarios",
    "simulate",
]
