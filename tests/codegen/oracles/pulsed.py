"""A coil on pulses: of a source, or by two switches that a gate drives in turn."""

from functools import cache

from references.build import bond_graph

import bondgraph as bg


@cache
def coil() -> bg.StateEquations:
    """A voltage over a coil and a resistance."""
    nodes = [bg.Se("src", "u"), bg.One("n"), bg.I("L", "L", flow="i"), bg.R("R", "R")]
    return bg.derive(bond_graph(nodes, "src>n>L n>R"))


@cache
def half_bridge() -> bg.StateEquations:
    """The switches join the coil to a voltage, or to the ground."""
    nodes = [bg.Se("src", "V"), bg.One("up"), bg.Sw("high", on="gate - 1/2"), bg.Zero("m"),
             bg.Sw("low", on="1/2 - gate"), bg.One("n"), bg.I("L", "L", flow="i"),
             bg.R("R", "R")]  # fmt: skip
    return bg.derive(bond_graph(nodes, "src>up>high up>m>low m>n>L n>R"))
