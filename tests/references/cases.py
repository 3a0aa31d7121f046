"""Linear models with printed equations, from other toolkits and textbooks.

Each case has its source. Flows and efforts follow `build.bond_graph`; states are momenta ``p_<node>``
and displacements ``q_<node>``, as the sources have them; ``rates`` are their derivatives. All of them
were derived again by elimination over all bond equations.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import bondgraph as bg

from .build import Node


@dataclass(frozen=True)
class Case:
    """A graph and the rates of its momenta and displacements; ``outputs``: node to what it receives."""

    source: str
    nodes: list[Node]
    bonds: str
    rates: Mapping[str, str]
    outputs: Mapping[str, str] = field(default_factory=dict)


CASES = {
    "force_on_damped_mass": Case(
        "Karlinde/bondgraph tests/test_core.py, i element",
        [bg.Se("F", "F"), bg.One("j"), bg.R("r", "r"), bg.I("i", "m")],
        "F>j j>r j>i",
        {"p_i": "F - r*p_i/m"},
    ),
    "force_on_damped_spring": Case(
        "Karlinde/bondgraph tests/test_core.py, c element",
        [bg.Se("F", "F"), bg.One("j"), bg.R("r", "r"), bg.C("c", "c")],
        "F>j j>r j>c",
        {"q_c": "(F - q_c/c)/r"},
    ),
    "force_and_velocity_source": Case(
        "Karlinde/bondgraph tests/test_core.py, more complex",
        [
            bg.Se("F", "F"), bg.One("a"), bg.I("i", "m"), bg.Zero("z"), bg.One("b"),
            bg.Sf("v", "v"), bg.C("c", "c"), bg.R("r", "r"),
        ],
        "F>a>i a>z>b v>z b>c b>r",
        {"p_i": "F - r*v - r*p_i/m - q_c/c", "q_c": "v + p_i/m"},
    ),
    "mass_and_damper_behind_a_lever": Case(
        "Karlinde/bondgraph tests/test_core.py, transformer 1",
        [
            bg.Se("F", "F"), bg.One("a"), bg.I("i", "m"), bg.TF("lever", "d"), bg.One("b"),
            bg.R("r", "r"),
        ],
        "F>a>i a>lever>b>r",
        {"p_i": "F - r*d**2*p_i/m"},
    ),
    "parallel_oscillator": Case(
        "BondGraphs.jl test/equation_tests.jl, RLC",
        [bg.Zero("z"), bg.R("R", "R_0"), bg.I("L", "L_0"), bg.C("C", "C_0")],
        "z>R z>L z>C",
        {"q_C": "-q_C/(R_0*C_0) - p_L/L_0", "p_L": "q_C/C_0"},
    ),
    "driven_series_oscillator": Case(
        "BondGraphTools test_modular.py, R = L = C = 1",
        [bg.Se("s", "u"), bg.One("j"), bg.R("R", 1), bg.I("L", 1), bg.C("C", 1)],
        "s>j j>R j>L j>C",
        {"q_C": "p_L", "p_L": "u - q_C - p_L"},
    ),
    "low_pass": Case(
        "MTT Electrical_rep.pdf, rc",
        [bg.Se("s", "u"), bg.One("j"), bg.R("r", "r"), bg.Zero("z"), bg.C("c", "c")],
        "s>j>r j>z>c",
        {"q_c": "-q_c/(c*r) + u/r"},
        {"z": "q_c/c"},
    ),
    "motor_generator": Case(
        "MTT Electromechanical_rep.pdf, MotorGenerator",
        [
            bg.Se("s", "u"), bg.One("a"), bg.I("lm", "lm"), bg.R("rm", "rm"), bg.GY("motor", "km"),
            bg.One("b"), bg.I("jm", "jm"), bg.R("bm", "bm"), bg.Zero("shaft"), bg.C("cs", "cs"),
            bg.One("c"), bg.I("jg", "jg"), bg.R("bg", "bg"), bg.GY("generator", "kg"), bg.One("d"),
            bg.I("lg", "lg"), bg.R("rg", "rg"), bg.R("rl", "rl"),
        ],
        "s>a a>lm a>rm a>motor>b b>jm b>bm b>shaft>cs shaft>c c>jg c>bg d>generator>c d>lg d>rg d>rl",
        {
            "p_lm": "u - rm*p_lm/lm - km*p_jm/jm",
            "p_jm": "km*p_lm/lm - bm*p_jm/jm - q_cs/cs",
            "q_cs": "p_jm/jm - p_jg/jg",
            "p_lg": "-(rg + rl)*p_lg/lg - kg*p_jg/jg",
            "p_jg": "q_cs/cs + kg*p_lg/lg - bg*p_jg/jg",
        },
        {"rl": "p_lg/lg"},
    ),
    "direct_current_motor": Case(
        "pyBondGraph examples/bg_dc_motor.py",
        [
            bg.Se("U", "U"), bg.One("a"), bg.R("RA", "RA"), bg.I("LA", "LA"), bg.GY("K", "Kt"),
            bg.One("b"), bg.R("RB", "RB"), bg.I("J", "J"),
        ],
        "U>a a>RA a>LA a>K>b b>RB b>J",
        {"p_LA": "-RA/LA*p_LA - Kt/J*p_J + U", "p_J": "Kt/LA*p_LA - RB/J*p_J"},
    ),
    "hoist": Case(
        "pyBondGraph bg_hoisting_device.py",
        [
            bg.Se("U", "U"), bg.One("a"), bg.R("Rel", "Rel"), bg.I("L", "L"), bg.GY("motor", "K"),
            bg.One("b"), bg.R("Rb", "Rb"), bg.I("J", "J"), bg.TF("drum", "r"), bg.Zero("rope"),
            bg.C("Cr", "Cr"), bg.One("load"), bg.I("m", "m"), bg.Se("weight", "G"),
        ],
        "U>a a>Rel a>L a>motor>b b>Rb b>J b>drum>rope>Cr rope>load>m weight>load",
        {
            "p_L": "U - Rel/L*p_L - K/J*p_J",
            "p_J": "K/L*p_L - Rb/J*p_J - r/Cr*q_Cr",
            "q_Cr": "r/J*p_J - p_m/m",
            "p_m": "q_Cr/Cr + G",
        },
    ),
    "resistances_in_a_loop": Case(
        "Karlinde/bondgraph tests (refused there); BondGraphTools and Delabeye give this",
        [
            bg.Se("F", "F"), bg.One("a"), bg.R("r1", "r1"), bg.Zero("z"), bg.R("r2", "r2"),
            bg.One("b"), bg.R("r3", "r3"), bg.C("c", "c"),
        ],
        "F>a>r1 a>z>r2 z>b>r3 b>c",
        {"q_c": "(r2*F - (r1 + r2)*q_c/c)/(r1*r2 + r1*r3 + r2*r3)"},
        # The voltage of node z by Kirchhoff's law: (F - e)/r1 = e/r2 + (e - q/c)/r3.
        {"z": "(F/r1 + q_c/(c*r3))/(1/r1 + 1/r2 + 1/r3)", "r2": "(F/r1 + q_c/(c*r3))/(1/r1 + 1/r2 + 1/r3)"},
    ),
    "two_resistances_in_series": Case(
        "MTT AlgebraicLoops_rep.pdf, aRC",
        [
            bg.Se("s", "u"), bg.One("j"), bg.R("r1", "r1"), bg.R("r2", "r2"), bg.Zero("z"),
            bg.C("c", "c"),
        ],
        "s>j j>r1 j>r2 j>z>c",
        {"q_c": "(c*u - q_c)/(c*(r1 + r2))"},
        {"z": "q_c/c"},
    ),
    "geared_inertias": Case(
        "BondGraphTools, by hand; w1 = n w2",
        [
            bg.Se("F", "F"), bg.One("a"), bg.I("J1", "J1"), bg.TF("gear", "1/n"), bg.One("b"),
            bg.I("J2", "J2", priority=1), bg.R("b_2", "b"),
        ],
        "F>a>J1 a>gear>b b>J2 b>b_2",
        {"p_J2": "J2*(n*F - b*p_J2/J2)/(n**2*J1 + J2)"},
        {"J1": "n*p_J2/J2"},
    ),
    "open_differential": Case(
        "BondGraphTools; w_in = n (w_L + w_R)",
        [
            bg.Se("T", "T"), bg.One("in"), bg.I("Jin", "Jin", priority=-1), bg.TF("drive", "1/n"),
            bg.Zero("sum"), bg.One("L"), bg.I("JL", "JL"), bg.R("bL", "bL"), bg.One("R"),
            bg.I("JR", "JR"), bg.R("bR", "bR"),
        ],
        "T>in>Jin in>drive>sum sum>L sum>R L>JL L>bL R>JR R>bR",
        {
            "p_JL": "JL*(n*JR*T - bL*(JR + n**2*Jin)*p_JL/JL + n**2*Jin*bR*p_JR/JR)"
            "/(JL*JR + n**2*Jin*(JL + JR))",
            "p_JR": "JR*(n*JL*T - bR*(JL + n**2*Jin)*p_JR/JR + n**2*Jin*bL*p_JL/JL)"
            "/(JL*JR + n**2*Jin*(JL + JR))",
        },
    ),
    "open_differential_in_numbers": Case(
        "BondGraphTools; Jin = .1, JL = 1, JR = 2, n = 2, bL = .3, bR = .4",
        [
            bg.Se("T", "T"), bg.One("in"), bg.I("Jin", 0.1, priority=-1), bg.TF("drive", 0.5),
            bg.Zero("sum"), bg.One("L"), bg.I("JL", 1), bg.R("bL", 0.3), bg.One("R"),
            bg.I("JR", 2), bg.R("bR", 0.4),
        ],
        "T>in>Jin in>drive>sum sum>L sum>R L>JL L>bL R>JR R>bR",
        {
            "p_JL": "-9*p_JL/40 + p_JR/2/20 + 5*T/4",
            "p_JR": "2*(3*p_JL/80 - 7*p_JR/2/40 + 5*T/8)",
        },
    ),
}  # fmt: skip
