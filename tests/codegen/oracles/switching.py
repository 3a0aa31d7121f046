"""One small model of every kind of port that switches, with a run of it, for whatever runs models."""

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import networkx as nx
import numpy as np
from numpy.typing import NDArray
from references.build import bond_graph

import bondgraph as bg
from codegen import Constant, Sine, Step


@dataclass(frozen=True)
class Case:
    """A graph, its numbers and laws, and a run of it."""

    graph: "nx.DiGraph[Any]"
    parameters: Mapping[str, float]
    inputs: Mapping[str, Any]
    initial: Mapping[str, float] = field(default_factory=dict)
    laws: Mapping[Hashable, Any] = field(default_factory=dict)
    initially_on: tuple[Hashable, ...] = ()
    end: float = 1.0

    @property
    def times(self) -> NDArray[np.float64]:
        """Samples that meet no event."""
        return np.linspace(0.0, self.end, 102)


def rectifier() -> Case:
    """A source charges a capacitor through a diode."""
    nodes = [bg.Se("mains", "u"), bg.One("loop"), bg.Diode("d"), bg.R("R_s", "R_s"), bg.Zero("out"),
             bg.C("c", "C", effort="v"), bg.R("load", "R_l")]  # fmt: skip
    graph = bond_graph(nodes, "mains>loop>d loop>R_s loop>out>c out>load")
    return Case(graph, {"R_s": 1.0, "C": 0.01, "R_l": 10.0}, {"u": Sine(10, 2.3)}, {"v": 2.0})


def bridge() -> Case:
    """Four diodes between a source with inductance and a choke: they overlap as they commutate.

    With resistances that differ, as where a current may take two ways alike it is not told which it takes.
    """
    ways = {"d1": "a>w1>d1 w1>r1 w1>p", "d2": "b>w2>d2 w2>r2 w2>p", "d3": "w3>a w3>d3 w3>r3",
            "d4": "w4>b w4>d4 w4>r4"}  # fmt: skip
    ones = ("s", "out", "w1", "w2", "w3", "w4")
    nodes = [bg.Se("src", "u"), *map(bg.One, ones), bg.Zero("a"), bg.Zero("b"), bg.Zero("p"),
             bg.I("Ls", "Ls", flow="i_s"), bg.I("L", 2, flow="i"), bg.R("R", 5),
             *map(bg.Diode, ways), *(bg.R(f"r{k}", f"{k}/5") for k in (1, 2, 3, 4))]  # fmt: skip
    bonds = "src>s>Ls s>a b>s p>out out>L out>R " + " ".join(ways.values())
    return Case(bond_graph(nodes, bonds), {"Ls": 0.1}, {"u": Sine(10, 1.7, phase=0.3)})


def contactor() -> Case:
    """A contactor cuts a coil off, whose current goes on through a diode."""
    nodes = [bg.Se("s", "E"), bg.One("w"), bg.Sw("k", on="sin(9*t + 1)"), bg.Zero("n"),
             bg.Sw("d", on="-e_d", off="f_d"), bg.One("c"), bg.I("L", "L", flow="i"),
             bg.R("R", 1)]  # fmt: skip
    return Case(bond_graph(nodes, "s>w>k w>n>c c>L c>R n>d"), {"L": 0.3}, {"E": Sine(2, 1.1, 0, 3)})


def buck() -> Case:
    """A converter whose transistor is driven by time, with a current that dies in each period."""
    nodes = [bg.Se("src", "E"), bg.One("s"), bg.Sw("q", on="sin(40*t) - 0.5"), bg.Zero("n"),
             bg.Sw("d", on="-e_d", off="f_d"), bg.One("l"), bg.I("L", "L", flow="i"), bg.Zero("o"),
             bg.C("c", 0.05, effort="v"), bg.R("r", 8)]  # fmt: skip
    graph = bond_graph(nodes, "src>s>q s>n>d n>l>L l>o o>c o>r")
    return Case(graph, {"L": 0.1}, {"E": 24.0}, {"v": 5.0})


def dog_by_time() -> Case:
    """A dog clutch joins two inertias."""
    nodes = [bg.Se("e", "T"), bg.One("first"), bg.I("m_1", 1, flow="v_1"), bg.Zero("gap"),
             bg.Sw("dog", on="0.31 - t"), bg.One("second"), bg.I("m_2", "m_2", flow="v_2"),
             bg.R("d", 0.1)]  # fmt: skip
    graph = bond_graph(nodes, "e>first>m_1 first>gap>dog gap>second>m_2 second>d")
    return Case(graph, {"m_2": 3.0}, {"T": Sine(2, 0.7)}, {"v_1": 4.0, "v_2": 0.0})


def dog_by_input() -> Case:
    """The same by an input that opens it, with another spelling of off."""
    nodes = [bg.Se("e", "T"), bg.One("first"), bg.I("m_1", 1, flow="v_1"), bg.Zero("gap"),
             bg.Sw("dog", on="gate - 1", off="0.5 - gate"), bg.One("second"),
             bg.I("m_2", "m_2", flow="v_2"), bg.R("d", 0.1)]  # fmt: skip
    graph = bond_graph(nodes, "e>first>m_1 first>gap>dog gap>second>m_2 second>d")
    gate = Constant(0.75) + Step(0.4, -0.5) + Step(0.7, 2.0)
    start = {"v_1": 4.0, "v_2": 0.0}
    return Case(graph, {"m_2": 3.0}, {"T": 2.0, "gate": gate}, start, initially_on=("dog",))


def freewheel() -> Case:
    """A shaft drives another, which overruns it."""
    nodes = [bg.Se("e", "T"), bg.One("a"), bg.I("J_1", "J_1", flow="w_1"), bg.Zero("z"),
             bg.Freewheel("fw"), bg.One("b"), bg.I("J_2", 2, flow="w_2"), bg.R("d", 1)]  # fmt: skip
    graph = bond_graph(nodes, "e>a>J_1 a>z>fw z>b>J_2 b>d")
    return Case(graph, {"J_1": 0.5}, {"T": Sine(20, 2.1)}, {"w_1": 1.0, "w_2": 1.0})


def check_valve() -> Case:
    """A pump fills a tank, whose valve keeps it from flowing back."""
    nodes = [bg.Se("pump", "p"), bg.One("pipe"), bg.CheckValve("valve"), bg.R("rub", 2), bg.Zero("tank"),
             bg.C("level", "C", effort="h"), bg.R("leak", 9)]  # fmt: skip
    graph = bond_graph(nodes, "pump>pipe>valve pipe>rub pipe>tank>level tank>leak")
    return Case(graph, {"C": 0.1}, {"p": Sine(4, 1.3)}, {"h": 1.0})


def controlled_junctions() -> Case:
    """A loop that is cut, and a node that is grounded."""
    nodes = [bg.Se("s", "E"), bg.One("w", on="sin(7*t + 1)"), bg.R("R", 1), bg.Zero("g", on="cos(11*t)"),
             bg.One("j"), bg.R("r", 1), bg.C("c", "C", effort="u")]  # fmt: skip
    return Case(bond_graph(nodes, "s>w>R w>g>j j>r j>c"), {"C": 0.2}, {"E": Sine(3, 0.9, 0, 2)})


def across_a_capacitor() -> Case:
    """A switch that empties a capacitor, in flow form."""
    nodes = [bg.Sf("s", "i"), bg.Zero("n"), bg.C("c", "C", effort="u"), bg.R("r", 5),
             bg.Sw("k", on="sin(13*t) - 0.9")]  # fmt: skip
    return Case(bond_graph(nodes, "s>n>c n>r n>k"), {"C": 0.1}, {"i": 2.0}, {"u": 1.0})


def thermostat() -> Case:
    """A general condition with hysteresis."""
    nodes = [bg.Se("s", "E"), bg.One("w"), bg.Sw("k", on="lo - T", off="T - hi"), bg.R("R", 1),
             bg.C("c", 0.1, effort="T"), bg.Zero("z"), bg.R("l", 3)]  # fmt: skip
    numbers = {"lo": 1.0, "hi": 1.5}
    return Case(bond_graph(nodes, "s>w>k w>R w>z>c z>l"), numbers, {"E": 4.0})


def nonlinear_condition() -> Case:
    """A general condition that is not affine: a relay that looks at an energy."""
    nodes = [bg.Se("s", "E"), bg.One("w"), bg.Sw("k", on="1 - T**2", off="T**2 - hi"), bg.R("R", 1),
             bg.C("c", 0.1, effort="T"), bg.Zero("z"), bg.R("l", 3)]  # fmt: skip
    return Case(bond_graph(nodes, "s>w>k w>R w>z>c z>l"), {"hi": 2.0}, {"E": 4.0})


def switch_beside_friction() -> Case:
    """A freewheel drives a block that rubs."""
    nodes = [bg.Se("e", "T"), bg.One("first"), bg.I("m_1", 1, flow="v_1"), bg.Zero("gap"),
             bg.Sw("free", on="-e_free", off="f_free"), bg.One("second"), bg.I("m_2", 3, flow="v_2"),
             bg.R("rub", effort="tau_r", flow="v_r")]  # fmt: skip
    graph = bond_graph(nodes, "e>first>m_1 first>gap>free gap>second>m_2 second>rub")
    rub = {"rub": bg.DryFriction("N")}
    return Case(graph, {"N": 2.0}, {"T": Sine(25, 2.3)}, laws=rub)


def dog_beside_brake() -> Case:
    """A dog that joins a shaft to one that a brake may hold."""
    nodes = [bg.One("a"), bg.I("J1", 1, flow="w1"), bg.One("b"), bg.I("J2", 1, flow="w2"), bg.Zero("z"),
             bg.R("br", law=bg.DryFriction("N")), bg.Sw("dog", on="0.31 - t")]  # fmt: skip
    start = {"w1": 4.0, "w2": -1.0}
    return Case(bond_graph(nodes, "a>J1 b>J2 b>br a>z z>dog z>b"), {"N": 6.0}, {}, start)


def friction_behind_a_moving_ratio() -> Case:
    """A crank drives a slider that rubs."""
    nodes = [bg.Se("drive", "tau"), bg.One("shaft"), bg.I("J", "J", flow="omega"),
             bg.Df("angle", integrate="theta"), bg.TF("yoke", "r*sin(theta)"), bg.One("slider"),
             bg.R("rub", effort="tau_r", flow="v_r")]  # fmt: skip
    graph = bond_graph(nodes, "drive>shaft>J shaft>angle shaft>yoke>slider>rub")
    laws, start = {"rub": bg.DryFriction("N")}, {"omega": 3.0, "theta": 0.3}
    inputs = {"tau": Sine(0.8, 1), "N": 12.0}
    return Case(graph, {"J": 0.1, "r": 0.05}, inputs, start, laws)


def dog_behind_a_moving_ratio() -> Case:
    """A crank latches onto a slider at an angle."""
    nodes = [bg.One("shaft"), bg.I("J", 2, flow="w"), bg.Df("angle", integrate="theta"),
             bg.TF("yoke", "r*sin(theta)"), bg.Zero("gap"), bg.Sw("dog", on="0.8 - theta"),
             bg.One("slider"), bg.I("m", 3, flow="v")]  # fmt: skip
    graph = bond_graph(nodes, "shaft>J shaft>angle shaft>yoke>gap>dog gap>slider>m")
    return Case(graph, {"r": 0.5}, {}, {"w": 1.6, "v": -0.4})


CASES: Mapping[str, Callable[[], Case]] = {
    "diode": rectifier,
    "bridge of diodes": bridge,
    "contactor and diode": contactor,
    "converter, switched by time": buck,
    "dog clutch, by time": dog_by_time,
    "dog clutch, by an input": dog_by_input,
    "freewheel": freewheel,
    "check valve": check_valve,
    "controlled junctions": controlled_junctions,
    "switch across a capacitor": across_a_capacitor,
    "condition with hysteresis": thermostat,
    "condition that is not affine": nonlinear_condition,
    "freewheel beside friction": switch_beside_friction,
    "dog clutch beside a brake": dog_beside_brake,
    "friction behind a moving ratio": friction_behind_a_moving_ratio,
    "dog clutch behind a moving ratio": dog_behind_a_moving_ratio,
}
"""By what they are."""


@cache
def case(name: str) -> Case:
    """A case, made once."""
    return CASES[name]()


@cache
def equations(name: str) -> bg.StateEquations:
    """What is derived of it, once."""
    return bg.derive(case(name).graph)
