"""Random mechanisms: sliders behind ratios that move, with masses, springs and friction on them."""

from __future__ import annotations

import random

import networkx as nx

import bondgraph as bg
from references.build import bond_graph

RATIOS = ("r*sin(theta)", "r*cos(theta) + l", "l + r*sin(2*theta)", "r*sin(theta)*cos(theta) + l", "1/2",
          "n", "l + r*n")  # fmt: skip
"""By the shaft's angle theta, or by an input n."""

NUMBERS = {"J": 0.5, "m": 1.2, "r": 0.3, "l": 0.9, "c": 0.2}


def random_mechanism(rng: random.Random) -> tuple[nx.DiGraph[str], list[str]]:
    """A graph with one to three branches, and its nodes of dry friction, which hold whatever comes.

    A branch hangs on the shaft or on the end of another: a mass, a mass behind friction or behind a spring
    with a law, or nothing, and perhaps a damper whose law reads the shaft's speed.
    """
    inertia = rng.choice(["J", "J", "J*(2 + sin(theta))"])
    nodes = [bg.Se("drive", "tau"), bg.One("rot"), bg.I("J", inertia, flow="omega"),
             bg.Df("angle", integrate="theta")]  # fmt: skip
    bonds, holding, ends, ratios = "drive>rot>J rot>angle", list[str](), ["rot"], set[str]()
    for k in range(rng.randint(1, 3)):
        root, ratio = rng.choice(ends), rng.choice(RATIOS)
        ratios.add(ratio)
        nodes += [bg.TF(f"c{k}", ratio), bg.One(f"s{k}", flow=f"v{k}")]
        bonds += f" {root}>c{k}>s{k}"
        mass = rng.choice([f"{k + 1}*m", f"{k + 1}*m", f"m*({k + 1} + cos(theta)**2)"])
        what = rng.choice(["mass", "friction", "friction", "spring", "nothing"])
        if what == "mass":
            nodes.append(bg.I(f"m{k}", mass, priority=-1))
            bonds += f" s{k}>m{k}"
        elif what != "nothing":
            between = bg.R(f"x{k}", law=bg.DryFriction(1_000_000))
            if what == "spring":
                between = bg.C(f"x{k}", law=f"3*q_x{k} + q_x{k}**3")
            nodes += [bg.Zero(f"z{k}"), between, bg.One(f"e{k}"),
                      bg.I(f"M{k}", mass, flow=f"w{k}", priority=-2 - k)]  # fmt: skip
            bonds += f" s{k}>z{k}>x{k} z{k}>e{k}>M{k}"
            ends.append(f"e{k}")
            holding += [f"x{k}"] if what == "friction" else []
        if rng.random() < 0.5:
            nodes.append(bg.R(f"d{k}", law=f"c*f_d{k}**3 + c*f_d{k}*omega"))
            bonds += f" s{k}>d{k}"
    if ratios & {"n", "l + r*n"}:
        nodes += [bg.Se("lever", "n"), bg.R("rest", 1)]
        bonds += " lever>rest"
    return bond_graph(nodes, bonds), holding
