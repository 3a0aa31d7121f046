"""Models with switches to make units of: each kind of guard, impacts, friction beside them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from references.build import bond_graph

import bondgraph as bg
import codegen
from oracles.units import Case


@dataclass(frozen=True)
class SwitchedCase(Case):
    """A case with switches that are on before the start."""

    on: tuple[str, ...] = ()

    def written(self, path: Path, version: str, **more) -> Path:
        return super().written(path, version, **{"initially_on": self.on} | more)

    def run(self, samples: int = 1001, method: str = "auto") -> codegen.Result:
        times = np.linspace(0.0, self.end, samples)
        ready = codegen.simulator(self.equations, self.parameters, self.laws)
        return ready.run(times, self.initial, self.inputs, method, initially_on=self.on)


def _case(nodes: list, bonds: str, outputs: list, numbers: Mapping[str, float], **run):
    equations = bg.derive(bond_graph(nodes, bonds), outputs)
    given = {"initial": {}, "inputs": {}, "end": 1.0} | run
    return SwitchedCase(equations, numbers, None, **given)


def rectifier() -> SwitchedCase:
    """A sine through a diode and R_1 onto C beside R."""
    nodes = [
        bg.Se("src", "u"), bg.One("loop"), bg.Diode("d"), bg.R("R_1", "R_1"), bg.Zero("out"),
        bg.C("c", "C", effort="v"), bg.R("load", "R"),
    ]  # fmt: skip
    numbers = {"R_1": 1.0, "C": 1e-3, "R": 100.0}
    return _case(
        nodes, "src>loop>d loop>R_1 loop>out out>c out>load", ["d"], numbers,
        inputs={"u": codegen.Sine(10, 50)}, initial={"v": 2.0}, end=0.1,
    )  # fmt: skip


def buck() -> SwitchedCase:
    """A transistor switched by time alone, a diode that takes the coil's current over; it dies out."""
    nodes = [
        bg.Se("src", "E"), bg.One("s"), bg.Sw("q", on="sin(w*t) - 0.2"), bg.Zero("n"),
        bg.Sw("d", on="-e_d", off="f_d"), bg.One("l"), bg.I("L", "L", flow="i"), bg.Zero("o"),
        bg.C("c", "C", effort="v"), bg.R("r", "R"),
    ]  # fmt: skip
    numbers = {"L": 1e-3, "C": 1e-4, "R": 150.0, "w": 6283.0}
    return _case(
        nodes, "src>s>q s>n>d n>l>L l>o o>c o>r", ["d"], numbers, inputs={"E": 24.0}, end=0.01
    )


def dog() -> SwitchedCase:
    """A dog clutch joins two inertias, one with a brake, by an impact, and lets them go again."""
    nodes = [
        bg.One("a"), bg.I("J1", "J_1", flow="w1"), bg.One("b"), bg.I("J2", 1, flow="w2"), bg.Zero("z"),
        bg.R("br", law=bg.DryFriction("level")), bg.Sw("slack", on="out", off="-out"),
        bg.Se("drive", "T"),
    ]  # fmt: skip
    return _case(
        nodes, "a>J1 drive>a b>J2 b>br a>z z>slack z>b", ["br"], {"J_1": 1.0, "level": 1.0},
        initial={"w1": 4.0, "w2": -2.0}, on=("slack",), end=6.0,
        inputs={"out": codegen.Step(1.0, -1.0, 1.0) + codegen.Step(5.0, 2.0), "T": 0.3},
    )  # fmt: skip


def freewheel() -> SwitchedCase:
    """A hub drives a wheel through a freewheel, friction at both: it locks, overruns, locks again."""
    nodes = [
        bg.Se("T", "tau"), bg.One("hub"), bg.I("J_1", 0.5, flow="w_1"), bg.Zero("between"),
        bg.Freewheel("fw"), bg.One("wheel"), bg.I("J_2", 2, flow="w_2"),
        bg.R("bearing", law=bg.DryFriction("h")), bg.R("ground", law=bg.DryFriction(0.5, breakaway=1.2)),
    ]  # fmt: skip
    return _case(
        nodes, "T>hub hub>J_1 hub>bearing hub>between>wheel between>fw wheel>J_2 wheel>ground",
        ["fw"], {"h": 0.2}, inputs={"tau": codegen.Sine(4.0, 0.4, phase=0.3)}, end=6.0,
    )  # fmt: skip


def controlled() -> SwitchedCase:
    """A junction that time opens and closes again, one that a thermostat's hysteresis switches."""
    nodes = [
        bg.Se("s", "E"), bg.One("w", on="(t - 1)*(t - 4)"), bg.R("R", 1), bg.Zero("n"),
        bg.C("c", 1, effort="T"), bg.R("l", 3), bg.Se("s2", "E"), bg.One("h"),
        bg.Sw("k", on="lo - T", off="T - hi"), bg.R("R2", 2),
    ]  # fmt: skip
    return _case(
        nodes, "s>w>R w>n n>c n>l s2>h h>k h>R2 h>n", ["c"], {"lo": 1.0, "hi": 1.2},
        inputs={"E": 4.0}, end=6.0,
    )  # fmt: skip


def joined() -> SwitchedCase:
    """Two shafts that a gear joins at first: the speed that was not set follows; then it slides out."""
    nodes = [
        bg.One("a"), bg.I("J1", 2, flow="w1"), bg.TF("gear", "1/3"), bg.Zero("z"), bg.One("b"),
        bg.I("J2", 1, flow="w2"), bg.Sw("slack", on="t - 1"), bg.R("drag", 0.5),
    ]  # fmt: skip
    return _case(
        nodes, "a>J1 a>gear>z>slack z>b b>J2 b>drag", ["slack"], {}, initial={"w1": 3.0}, end=2.0
    )


def crank() -> SwitchedCase:
    """A crank whose angle decides when it latches onto a slider, which rubs: no mode is affine."""
    nodes = [
        bg.One("shaft"), bg.I("J", 2, flow="w"), bg.Df("angle", integrate="theta"),
        bg.TF("yoke", "r*sin(theta)"), bg.Zero("gap"), bg.Sw("slack", on="theta_0 - theta"),
        bg.One("slider"), bg.I("m", 3, flow="v"), bg.R("rail", law=bg.DryFriction(0.4)),
    ]  # fmt: skip
    return _case(
        nodes, "shaft>J shaft>angle shaft>yoke>gap>slack gap>slider>m slider>rail", ["slack"],
        {"r": 0.5, "theta_0": 0.8}, initial={"w": 1.6, "v": -0.4}, on=("slack",), end=1.5,
    )  # fmt: skip


def passing(by_time: bool = False) -> SwitchedCase:
    """A current of 1 but where ``|x - 0.4| < d``, its charge counted as q; x = sin 3 t.

    x is the state of an oscillator or, ``by_time``, that expression.
    """
    x = "sin(3*t)" if by_time else "x"
    nodes = [
        bg.Se("u", 1), bg.One("j"), bg.R("r", 1), bg.Df("count", integrate="q"),
        bg.Sw("k", on=f"Abs({x} - 0.4) - d"),
    ]  # fmt: skip
    bonds, start = "u>j j>k j>r j>count", {}
    if not by_time:
        nodes += [bg.One("m"), bg.I("M", "1/3", flow="v"), bg.C("K", "1/3", effort="x")]
        bonds, start = f"{bonds} m>M m>K", {"v": 1.0, "x": 0.0}
    return _case(nodes, bonds, ["k"], {"d": 1e-3}, initial=start, on=("k",), end=6.0)


SWITCHED: Mapping[str, Callable[[], SwitchedCase]] = {
    made.__name__: made for made in (rectifier, buck, dog, freewheel, controlled, joined, crank)
}
