"""Relays with runs known in closed form: each slides along where its law jumps (Filippov 1988, section 4)."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
import sympy as sp
from references.build import bond_graph

import bondgraph as bg
from codegen import Ramp

Array = np.ndarray


@dataclass(frozen=True)
class Relay:
    """A model and its run; ``slides``: when it does, and ``known``: signals from then on."""

    equations: bg.StateEquations
    start: Mapping[str, float]
    slides: float
    known: Callable[[Array], Mapping[str, Array]]
    inputs: Mapping[str, object] = field(default_factory=dict)


def mass(law: object) -> bg.StateEquations:
    """A mass of 1 that F pushes, with a law of its speed."""
    nodes = [bg.Se("F", "F"), bg.One("j"), bg.I("m", 1, flow="v"),
             bg.R("r", law=law, effort="F_r", flow="v_r")]  # fmt: skip
    return bg.derive(bond_graph(nodes, "F>j>m j>r"))


def two(x: object, y: object) -> bg.StateEquations:
    """Two states with these rates."""
    nodes = [bg.Sf("a", x), bg.Zero("p"), bg.C("X", 1, effort="x"),
             bg.Sf("b", y), bg.Zero("q"), bg.C("Y", 1, effort="y")]  # fmt: skip
    return bg.derive(bond_graph(nodes, "a>p>X b>q>Y"))


def oscillating(law: object) -> bg.StateEquations:
    """x'' is minus a law of x and of v = x'."""
    nodes = [bg.One("j"), bg.I("m", 1, flow="v"), bg.Df("d", integrate="x"),
             bg.R("r", law=law, effort="F_r", flow="v_r")]  # fmt: skip
    return bg.derive(bond_graph(nodes, "j>m j>r j>d"))


def at_level(law: object, start: float, time: float, level: float) -> Relay:
    """The mass comes to a level and stays, though 0.2 pushes."""
    known = {"v": level, "F_r": 0.2}
    return Relay(
        mass(law), {"v": start}, time,
        lambda t: {name: np.full(len(t), value) for name, value in known.items()}, {"F": 0.2},
    )  # fmt: skip


def sides() -> Relay:
    """x' = -2 where x > y, else 2; y' = 3/2 there, else -3: 10/17 of one side and 7/17 of the other."""
    x, y = sp.symbols("x y")
    one = sp.Piecewise((-2, x > y), (2, True))
    other = sp.Piecewise((sp.Rational(3, 2), x > y), (-3, True))

    def known(t: Array) -> Mapping[str, Array]:
        both = 3 / 7 - 6 / 17 * (t - 2 / 7)
        return {"x": both, "y": both, "f_a": 0 * t - 6 / 17, "f_b": 0 * t - 6 / 17}

    return Relay(two(one, other), {"x": 1.0}, 2 / 7, known)


def thermostat() -> Relay:
    """T' = heat - T/5 from 15 degrees, heat 10 below 20 degrees: there it heats with 4."""
    law = sp.Piecewise((10, sp.Symbol("T") < 20), (0, True))
    nodes = [bg.Sf("heat", law), bg.Zero("room"), bg.C("c", 1, effort="T"), bg.R("wall", 5)]
    return Relay(
        bg.derive(bond_graph(nodes, "heat>room>c room>wall")), {"T": 15.0}, 5 * np.log(35 / 30),
        lambda t: {"T": 0 * t + 20, "f_heat": 0 * t + 4},
    )  # fmt: skip


def moving() -> Relay:
    """v' = 1/2 - 2 sign(v - t) from v = 1: they meet at 0.4 s and it goes on with v = t."""
    return Relay(
        mass("2*sign(v_r - c)"), {"v": 1.0}, 0.4, lambda t: {"v": t, "F_r": 0 * t - 0.5},
        {"F": 0.5, "c": Ramp(0.0, 1.0)},
    )  # fmt: skip


def damped() -> Relay:
    """x'' = -sign(x + v) from x = 1: along x + v = 0 it decays."""
    at = np.sqrt(3.0) - 1

    def known(t: Array) -> Mapping[str, Array]:
        return {"x": at * np.exp(at - t), "v": -at * np.exp(at - t)}

    return Relay(oscillating("sign(x + v_r)"), {"x": 1.0}, at, known)


def zone() -> Relay:
    """Three levels by two thresholds of one speed: it stays at the upper one."""
    v = sp.Symbol("v_r")
    return at_level(sp.Piecewise((2, v > 1), (0, v > -1), (-2, True)), 1.9, 0.5, 1.0)


RELAYS: Mapping[str, Callable[[], Relay]] = {
    "sign": lambda: at_level("sign(v_r)", 1.0, 1.25, 0.0),
    "level": lambda: at_level("sign(v_r - 5)", 5.3, 0.375, 5.0),
    "sides of a mass": lambda: at_level(
        sp.Piecewise((2, sp.Rational(1, 2) < sp.Symbol("v_r")), (0, True)), 1.0, 0.5 / 1.8, 0.5
    ),
    "cubic": lambda: at_level("sign(v_r**3 - 1)", 1.2, 0.25, 1.0),
    "fast": lambda: at_level("1000*sign(v_r - 1/2)", 1.0, 0.5 / 999.8, 0.5),
    "zone": zone,
    "sides": sides,
    "thermostat": thermostat,
    "moving": moving,
    "damped": damped,
}  # fmt: skip


def together() -> tuple[bg.StateEquations, Mapping[str, float]]:
    """Relays of first and second order and two that cross, side by side, and where they start.

    A thermostat of 20 degrees; ``x'' = -2 sign(x) - sign(x')``; and ``p' = -sign(p) + 2 sign(q)``,
    ``q' = -sign(q) - 2 sign(p)``, whose quarter turns are each a third of the last. A sum of all
    makes it one.
    """
    heat = sp.Piecewise((10, sp.Symbol("T") < 20), (0, True))
    nodes = [bg.Sf("heat", heat), bg.Zero("room"), bg.C("c", 1, effort="T"), bg.R("wall", 5),
             bg.One("j"), bg.I("m", 1, flow="v"), bg.Df("d", integrate="x"),
             bg.R("r", law="2*sign(x) + sign(v_r)", effort="F_r", flow="v_r"),
             bg.Sf("a", "-sign(p) + 2*sign(q)"), bg.Zero("z"), bg.C("P", 1, effort="p"),
             bg.Sf("b", "-sign(q) - 2*sign(p)"), bg.Zero("y"), bg.C("Q", 1, effort="q"),
             bg.Sf("all", "T + x + p"), bg.Zero("w"), bg.C("W", 1, effort="sum")]  # fmt: skip
    graph = bond_graph(nodes, "heat>room>c room>wall j>m j>r j>d a>z>P b>y>Q all>w>W")
    return bg.derive(graph), {"T": 15.0, "x": 1.0, "q": 1.0}
