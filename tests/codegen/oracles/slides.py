"""Small runs and linear models of which textbooks tell everything."""

import numpy as np
from references.build import bond_graph

import bondgraph as bg
from bondgraph.analyse.state_space import StateSpace
from codegen import Result, Sine, simulator


def slide(friction: float = 3.0, samples: int = 41) -> Result:
    """2 kg at 3 m/s on dry friction of 3 N: at rest after 2 s, its speed falling along a line."""
    graph = bond_graph(
        [bg.One("j"), bg.I("m", "m", flow="v", unit="m/s"), bg.R("rub", effort="F_r", flow="w")],
        "j>m j>rub",
    )
    model = simulator(bg.derive(graph), {"m": 2.0, "F_c": friction}, {"rub": bg.DryFriction("F_c")})
    return model.run(np.linspace(0, 4, samples), {"v": 3.0})


def swing(amplitude: float = 2.5, frequency: float = 5.0, **names: str) -> Result:
    """A force that is a sine, sampled 1000 times a second, on a mass."""
    force = names.get("force", "P")
    graph = bond_graph(
        [bg.Se("push", force, unit="N"), bg.One("j"), bg.I("m", "m", flow=names.get("speed", "v"))],
        "push>j>m",
    )
    model = simulator(bg.derive(graph, outputs=[]), {"m": 1.0})
    return model.run(np.linspace(0, 2, 2001), inputs={force: Sine(amplitude, frequency)})


def oscillator(damping: float = 0.4) -> StateSpace:
    """2 kg on 8 N/m: v over P is s / (2 s^2 + damping s + 8); F - F_2 of equal springs is nothing."""
    nodes = [bg.Se("push", "P"), bg.One("j"), bg.I("m", 2, flow="v"), bg.C("k", "1/8", effort="F"),
             bg.R("b", damping)]  # fmt: skip
    graph = bond_graph(nodes, "push>j>m j>k j>b")
    return bg.linearize(bg.derive(graph), outputs=["v", "F"]).numeric({})


def two_masses() -> StateSpace:
    """Two of 1 kg between walls, three springs of 4 N/m: 2 rad/s together, 2 sqrt(3) against each other."""
    nodes = [
        bg.One("a"), bg.One("b"), bg.I("m_1", 1, flow="v_1"), bg.I("m_2", 1, flow="v_2"),
        bg.C("k_1", "1/4", effort="F_1"), bg.C("k_2", "1/4", effort="F_2"), bg.Zero("gap"),
        bg.C("k_12", "1/4", effort="F_12"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "a>m_1 b>m_2 a>k_1 b>k_2 a>gap>b gap>k_12")
    return bg.linearize(bg.derive(graph)).numeric({})
