"""Differentials of Deur, Hancock and Assadian (2008), and parts to build others from."""

from differentials.identification import identified_inertia, linear_model
from differentials.laws import coulomb_clutch, linear_tire, magic_formula_tire, stribeck_clutch
from differentials.parameters import OWN, PARAMETERS, Parameter
from differentials.scenarios import Scenario, scenarios, simulate
from differentials.speeds import zero_slip_ratios
from differentials.topologies import Differential, catalog, equations, graph

__all__ = [
    "OWN",
    "PARAMETERS",
    "Differential",
    "Parameter",
    "Scenario",
    "catalog",
    "coulomb_clutch",
    "equations",
    "graph",
    "identified_inertia",
    "linear_model",
    "linear_tire",
    "magic_formula_tire",
    "scenarios",
    "simulate",
    "stribeck_clutch",
    "zero_slip_ratios",
]


def __dir__() -> list[str]:
    """What is public, and the parts; other modules are found by their own imports."""
    return [*__all__, "parts"]
