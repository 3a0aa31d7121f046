"""Models with switches, and what drives them, for runs in fixed steps."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import networkx as nx
import numpy as np
from references.build import bond_graph

import bondgraph as bg
from codegen import Constant, Lag, Ramp, Signal, Sine, Step


@dataclass(frozen=True)
class Switched:
    """A model and a run of it; ``step``: [s], of which ``count`` make it up; ``near``: an error then.

    The error is that against located events, of each state's range, at the shorter steps of two.
    """

    graph: nx.DiGraph
    numbers: Mapping[str, float]
    inputs: Mapping[str, Signal]
    step: float
    count: int
    near: float
    initial: Mapping[str, float] = field(default_factory=dict)
    on: tuple[str, ...] = ()


def gate(*edges: float) -> Signal:
    """1 at first, changing at each of the edges."""
    total: Signal = Constant(1.0)
    for k, at in enumerate(edges):
        total = total + Step(at, 1.0 if k % 2 else -1.0)
    return total


def _rectifier() -> Switched:
    """A half wave through R_1 onto C beside R."""
    nodes = [bg.Se("src", "u"), bg.One("loop"), bg.Diode("d"), bg.R("R_1", "R_1"), bg.Zero("out"),
             bg.C("c", "C", effort="v"), bg.R("load", "R")]  # fmt: skip
    graph = bond_graph(nodes, "src>loop>d loop>R_1 loop>out out>c out>load")
    numbers = {"R_1": 1.0, "C": 1e-3, "R": 100.0}
    return Switched(graph, numbers, {"u": Sine(10, 50)}, 1e-4, 400, 1e-3, {"v": 2.0})


def _chopper() -> Switched:
    """The same onto a choke: what remains of its current is taken from it as the diode blocks."""
    nodes = [
        bg.Se("src", "u"),
        bg.One("n"),
        bg.R("r", "R"),
        bg.I("l", "L", flow="i"),
        bg.Diode("d"),
    ]
    graph = bond_graph(nodes, "src>n>r n>l n>d")
    return Switched(graph, {"R": 2.0, "L": 0.05}, {"u": Sine(100, 50)}, 1e-4, 400, 1e-3)


def _buck() -> Switched:
    """Its current is interrupted: the transistor on, the diode on, neither."""
    nodes = [bg.Se("src", "E"), bg.One("s"), bg.Sw("q", on="g - 0.5"), bg.Zero("n"), bg.Freewheel("d"),
             bg.One("l"), bg.I("L", "L", flow="i"), bg.Zero("o"), bg.C("c", "C", effort="v"),
             bg.R("r", "R")]  # fmt: skip
    graph = bond_graph(nodes, "src>s>q s>n n>d n>l>L l>o o>c o>r")
    inputs = {"E": Constant(24.0), "g": gate(*(np.arange(1, 12) * 5.13e-5))}
    numbers = {"L": 1e-3, "C": 1e-5, "R": 60.0}
    return Switched(graph, numbers, inputs, 2e-6, 250, 0.05, {"v": 12.0}, ("q",))


def _dog() -> Switched:
    """A dog between two masses, at whose slack (on) it gives no torque, comes in and goes out again."""
    nodes = [bg.Se("T", "tau"), bg.One("a"), bg.I("J_1", "J_1", flow="w_1"), bg.Zero("gap"),
             bg.Sw("dog", on="(t - 0.1305)*(t - 0.3105)"), bg.One("b"),
             bg.I("J_2", "J_2", flow="w_2")]  # fmt: skip
    graph = bond_graph(nodes, "T>a>J_1 a>gap>b>J_2 gap>dog")
    start = {"w_1": 5.0, "w_2": -3.0}
    return Switched(graph, {"J_1": 2.0, "J_2": 0.7}, {"tau": Constant(1.3)}, 2e-3, 250, 0.01, start)


def _freewheel() -> Switched:
    """A shaft overruns, drives and is held by a brake that sticks and slips."""
    nodes = [bg.Se("T", "tau"), bg.One("a"), bg.I("J_1", "J_1", flow="w_1"), bg.R("loss", "b"),
             bg.Zero("gap"), bg.Freewheel("fw"), bg.One("c"), bg.I("J_2", "J_2", flow="w_2"),
             bg.R("brake", law=bg.DryFriction(0.8))]  # fmt: skip
    graph = bond_graph(nodes, "T>a>J_1 a>loss a>gap>c>J_2 gap>fw c>brake")
    numbers = {"J_1": 0.5, "J_2": 0.3, "b": 0.4}
    return Switched(
        graph, numbers, {"tau": Sine(3.0, 0.7)}, 4e-3, 500, 0.01, {"w_1": 0.0, "w_2": 1.0}
    )


def _coil(diode: bool) -> Switched:
    """A contactor interrupts a coil, whose current is lost unless a diode takes it."""
    nodes = [bg.Se("s", "E"), bg.One("w"), bg.Sw("k", on="g - 0.5"), bg.Zero("n"), bg.One("l"),
             bg.I("L", "L", flow="i"), bg.R("R", "R")]  # fmt: skip
    bonds = "s>w>k w>n>l>L l>R"
    if diode:
        nodes, bonds = [*nodes, bg.Freewheel("d")], f"{bonds} n>d"
    inputs = {"E": Constant(12.0), "g": gate(0.0313, 0.0627)}
    numbers = {"L": 0.02, "R": 1.0}
    return Switched(bond_graph(nodes, bonds), numbers, inputs, 2e-4, 450, 0.03, {"i": 3.0}, ("k",))


def _junction() -> Switched:
    """A valve that is a junction fills a tank by the clock."""
    nodes = [bg.Se("pump", "p"), bg.One("valve", on="g - 0.5"), bg.R("pipe", "R"), bg.Zero("n"),
             bg.C("tank", "C", effort="h"), bg.R("leak", "R_l")]  # fmt: skip
    graph = bond_graph(nodes, "pump>valve>pipe valve>n n>tank n>leak")
    inputs = {"p": Constant(5.0), "g": gate(0.4013, 1.2027)}
    numbers = {"R": 0.5, "C": 1.0, "R_l": 3.0}
    return Switched(graph, numbers, inputs, 5e-3, 400, 0.01, on=("valve",))


def _relay() -> Switched:
    """A heater between two temperatures, which its own past decides."""
    nodes = [bg.Sf("power", "P"), bg.Zero("n"), bg.Sw("relay", on="theta - 30", off="25 - theta"),
             bg.One("pass"), bg.R("fan", "R_f"), bg.C("room", "C", effort="theta"),
             bg.R("wall", "R")]  # fmt: skip
    graph = bond_graph(nodes, "power>n n>room n>wall n>pass pass>fan pass>relay")
    numbers = {"C": 2.0, "R": 10.0, "R_f": 1.0}
    return Switched(graph, numbers, {"P": Constant(12.0)}, 1e-2, 400, 0.02, {"theta": 22.0})


def _yoke() -> Switched:
    """Friction behind a ratio that moves: what sticks is held as the crank's angle has it."""
    nodes = [bg.Se("drive", "tau"), bg.One("rot"), bg.I("J", "J", flow="omega"),
             bg.Df("angle", integrate="theta"), bg.TF("crank", "r*sin(theta)"), bg.One("slider"),
             bg.R("rub", law=bg.DryFriction(4.0))]  # fmt: skip
    graph = bond_graph(nodes, "drive>rot>J rot>angle rot>crank>slider>rub")
    inputs = {"tau": Ramp(0.0, -2.0) + Lag(Step(1.5, 9.0), 0.2)}
    start = {"omega": 2.0, "theta": 0.6}
    return Switched(graph, {"J": 0.5, "r": 0.3}, inputs, 5e-3, 500, 0.01, start)


def switched_steps() -> Iterator[tuple[str, Switched]]:
    """All of them, by name."""
    yield "rectifier", _rectifier()
    yield "chopper", _chopper()
    yield "buck", _buck()
    yield "dog", _dog()
    yield "freewheel", _freewheel()
    yield "coil", _coil(diode=False)
    yield "coil with diode", _coil(diode=True)
    yield "junction", _junction()
    yield "relay", _relay()
    yield "yoke", _yoke()
