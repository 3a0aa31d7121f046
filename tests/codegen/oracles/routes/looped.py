"""A nonlinear law that determines itself at once, with a run that is known by hand."""

from collections.abc import Mapping

import numpy as np
import scipy
from references.build import bond_graph

import bondgraph as bg
from oracles.routes.kind import Array, Kind


def loop_of_nonlinear_laws() -> Kind:
    """A throttle f = g x^3, x = e_a, and a resistance r in series charge a capacitor C.

    u - v = x + r g x^3, so that (1 + 3 r g x^2) x' = -g x^3/C: of s = 1/x^2, s + 3 r g ln s rises by 2 g/C
    each second, and Lambert's W tells s.
    """
    g, r, C, x = 2.0, 0.3, 0.4, 1.0
    u, part = x + r * g * x**3, 3 * r * g
    nodes = [bg.Se("source", "u"), bg.One("line", flow="f"), bg.C("store", "C", effort="v"),
             bg.R("a", law="g*e_a**3", gives="flow"), bg.R("b", law="r*f_b", gives="effort")]  # fmt: skip

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        told = (1 / x**2 + part * np.log(1 / x**2) + 2 * g / C * t) / part
        found = 1 / np.sqrt(part * scipy.special.lambertw(np.exp(told) / part).real)
        return {"v": u - found - r * g * found**3}

    return Kind("nonlinear law that determines itself at once",
                bond_graph(nodes, "source>line>store line>a line>b"), {"g": g, "r": r, "C": C}, {"u": f"{u}"},
                known, 1.0, at=0.3, rest={"inputs": {"u": 0.0}}, loop=True)  # fmt: skip


LOOPED = (loop_of_nonlinear_laws,)
