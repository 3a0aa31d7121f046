"""Models with many ports that are held or let go: a chain that rubs, a bridge of diodes, a gearbox."""

from collections.abc import Mapping
from dataclasses import dataclass

import networkx as nx
import numpy as np
from references.build import bond_graph

import bondgraph as bg
from codegen import Sampled, Signal, Sine

CLUTCHES = (
    ("in", "a"), ("in", "b"), ("in", "c"), ("a", "b"), ("b", "c"), ("c", "d"), ("a", "out"), ("d", "out"),
    ("a", None), ("b", None), ("c", None), ("d", None),
)  # fmt: skip
"""The shafts that each clutch of `gearbox` joins; None: a brake."""

SETS = (("in", "a", "b", 0.5), ("b", "c", "d", 0.6), ("c", "out", "d", 0.7))
"""Its planetary gear sets: sun, ring, carrier, and how many times as fast as the ring the sun turns."""

GEARS = ((0, 8, 11), (0, 3, 11), (1, 4, 9), (2, 5, 7))
"""The clutches that are closed in each second of a run."""


@dataclass(frozen=True)
class Many:
    """A model without parameters, the inputs of a run, its samples, and what is looked at."""

    graph: "nx.DiGraph[object]"
    inputs: Mapping[str, Signal]
    times: np.ndarray
    shown: tuple[str, ...]


def chain(count: int) -> Many:
    """Blocks in a row with springs between, each rubs on the ground; the first is pushed to and fro."""
    nodes, bonds = [bg.Se("push", "P")], ["push>v0"]
    for k in range(count):
        law = bg.DryFriction(1 + 0.003 * k)
        nodes += [
            bg.One(f"v{k}"),
            bg.I(f"m{k}", 1 + 0.01 * k, flow=f"w{k}"),
            bg.R(f"b{k}", law=law),
        ]
        bonds += [f"v{k}>m{k}", f"v{k}>b{k}"]
    for k in range(count - 1):
        nodes += [bg.Zero(f"z{k}"), bg.C(f"s{k}", 0.02, effort=f"F{k}")]
        bonds += [f"v{k}>z{k}>v{k + 1}", f"z{k}>s{k}"]
    push = Sine(1.5 * count**0.5, 1.0)
    shown = tuple(f"w{k}" for k in range(count))
    return Many(bond_graph(nodes, " ".join(bonds)), {"P": push}, np.linspace(0, 3, 61), shown)


def stack(count: int) -> Many:
    """Blocks in a row, each pushed, that rub on the next and the last on the ground: all ports touch."""
    nodes, bonds = [bg.R("ground", law=bg.DryFriction(1.0))], [f"v{count - 1}>ground"]
    for k in range(count):
        nodes += [
            bg.Se(f"p{k}", f"P{k}"),
            bg.One(f"v{k}"),
            bg.I(f"m{k}", 1 + 0.01 * k, flow=f"w{k}"),
        ]
        bonds += [f"p{k}>v{k}>m{k}"]
    for k in range(count - 1):
        law = bg.DryFriction(1 + 0.1 * (count - k))
        nodes += [bg.Zero(f"z{k}"), bg.R(f"b{k}", law=law)]
        bonds += [f"v{k}>z{k}>v{k + 1}", f"z{k}>b{k}"]
    inputs = {f"P{k}": Sine(3.0, 1 + 0.1 * k, 2.0 * k) for k in range(count)}
    shown = tuple(f"w{k}" for k in range(count))
    return Many(bond_graph(nodes, " ".join(bonds)), inputs, np.linspace(0, 3, 61), shown)


def bridge(phases: int) -> Many:
    """Sources in star, each behind a coil, and two diodes a phase; a choke with a resistance as the load.

    In a period and a third of 0.5 s each diode turns on and off.
    """
    nodes = [
        bg.Zero("plus"),
        bg.Zero("minus"),
        bg.One("load"),
        bg.I("choke", 0.2, flow="i"),
        bg.R("r", 2.0),
    ]
    bonds = ["plus>load>choke", "load>r", "load>minus"]
    for k in range(phases):
        coil = bg.I(f"L{k}", 0.02 * (1 + 0.01 * k), flow=f"i{k}")
        nodes += [
            bg.Se(f"s{k}", f"U{k}"),
            bg.One(f"p{k}"),
            coil,
            bg.Zero(f"n{k}"),
            bg.R(f"r{k}", 50.0),
        ]
        nodes += [bg.One(f"t{k}"), bg.Diode(f"u{k}"), bg.One(f"b{k}"), bg.Diode(f"l{k}")]
        bonds += [f"s{k}>p{k}>L{k}", f"p{k}>n{k}>r{k}", f"n{k}>t{k}>u{k}", f"t{k}>plus"]
        bonds += [f"minus>b{k}>l{k}", f"b{k}>n{k}"]
    inputs = {f"U{k}": Sine(10.0, 2.0, 2 * np.pi * k / phases) for k in range(phases)}
    return Many(
        bond_graph(nodes, " ".join(bonds)), inputs, np.linspace(0, 0.65, 66), ("i", "i0", "i1")
    )


def gearbox() -> Many:
    """Six shafts, three planetary gear sets, eight clutches and four brakes, through four gears."""
    shafts = ("in", "a", "b", "c", "d", "out")
    nodes, bonds = [bg.Se("engine", "T"), bg.R("drag", 0.3)], ["engine>in", "out>drag"]
    for k, shaft in enumerate(shafts):
        inertia = 2.0 if shaft == "out" else 0.1 + 0.05 * k
        nodes += [bg.One(shaft), bg.I(f"I_{shaft}", inertia, flow=f"w_{shaft}")]
        bonds += [f"{shaft}>I_{shaft}"]
    for k, (sun, ring, carrier, ratio) in enumerate(SETS):
        nodes += [bg.Zero(f"g{k}"), bg.TF(f"r{k}", ratio), bg.TF(f"c{k}", 1 + ratio)]
        bonds += [f"{sun}>g{k}", f"{ring}>r{k}>g{k}", f"g{k}>c{k}>{carrier}"]
    for k, (one, other) in enumerate(CLUTCHES):
        nodes += [bg.R(f"q{k}", law=bg.DryFriction(f"N{k}"))]
        bonds += [f"{one}>z{k}>{other}", f"z{k}>q{k}"] if other else [f"{one}>q{k}"]
        nodes += [bg.Zero(f"z{k}")] if other else []
    times = np.arange(0, 4.01, 0.25)
    gear = np.minimum(times.astype(int), len(GEARS) - 1)
    closed = [[k in GEARS[at] for at in gear] for k in range(len(CLUTCHES))]
    inputs = {f"N{k}": Sampled(times, 0.02 + 6.0 * np.array(one)) for k, one in enumerate(closed)}
    inputs["T"] = Sine(25.0, 0.7)
    return Many(
        bond_graph(nodes, " ".join(bonds)), inputs, np.linspace(0, 4, 81), ("w_in", "w_a", "w_c")
    )
