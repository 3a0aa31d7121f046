from differentials.control.loop import closed_loop, loop_graph
from differentials.control.manoeuvres import Manoeuvre, manoeuvres
from differentials.control.margins import open_loop, sampled_loop
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
    "Manoeuvre",
    "Parameter",
    "Scenario",
    "catalog",
    "closed_loop",
    "coulomb_clutch",
    "equations",
    "graph",
    "identified_inertia",
    "linear_model",
    "linear_tire",
    "loop_graph",
    "magic_formula_tire",
    "manoeuvres",
    "open_loop",
    "sampled_loop",
    "scenarios",
    "simulate",
    "stribeck_clutch",
    "zero_slip_ratios",
]
