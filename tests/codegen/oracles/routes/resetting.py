"""Switches and stops that reset states at their events, each with a run that is known by hand."""

from collections.abc import Mapping

import numpy as np
from references.build import bond_graph

import bondgraph as bg
from oracles.routes.kind import Array, Kind, stepwise


def _firing(**told: object):
    """A membrane, and beside it a switch that carries no power."""
    nodes = [
        bg.Sf("source", "I"), bg.Zero("n"), bg.C("membrane", "C", effort="v"), bg.R("leak", "R"),
        bg.One("pivot"), bg.R("rest", 1), bg.Sw("spike", **told),
    ]  # fmt: skip
    return bond_graph(nodes, "source>n>membrane n>leak pivot>rest pivot>spike")


def reset() -> Kind:
    """It integrates and fires: v = 2 - (2 - v_0) exp(-t), from v_0 again as it comes to 1."""
    v_0 = 0.2
    first, period = np.log(2.0), np.log(2.0 - v_0)

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        parts = [(0.0, lambda s: 2 - 2 * np.exp(-s))]
        parts += [(first + k * period, lambda s: 2 - (2 - v_0) * np.exp(-s)) for k in range(4)]
        return {"v": stepwise(t, *parts)}

    return Kind(
        "switch that resets a state", _firing(on="v - 1", reset={"v": "v_0"}),
        {"R": 2.0, "C": 0.5, "v_0": v_0}, {"I": "1"}, known, 2.5, at=0.5, mode={"spike": "off"},
        rest={"inputs": {"I": 0.25}},
    )  # fmt: skip


def reset_bent() -> Kind:
    """The same, by a law that is no line: it comes to v^2/5, which is 1/5, and by how it turns off."""
    made = reset()
    states = {"on": {"v": "v**2*v_0"}, "off": {"v": "v + 0*v**3"}}
    graph = _firing(on="v - 1", off="v_0 + 1/4 - v", reset=states)
    return Kind(
        "switch that resets a state, not affine", graph, made.numbers, made.inputs, made.known,
        made.end, at=made.at, mode=made.mode, rest=made.rest,
    )  # fmt: skip


def reset_stop() -> Kind:
    """A ball that bounces, e = 0.8, and what counts that: at the floor at 1 s, and 2 e^k s later."""
    m, e, g, height = 2.0, 0.8, 10.0, 5.0
    nodes = [
        bg.Se("F", "F"), bg.One("n"), bg.I("m", "m", flow="v"),
        bg.Stop("floor", restitution="e", reset={"count": "count + 1", "top": "v**1/g"}),
        bg.Sf("none", "0*g"), bg.One("c"), bg.Df("counter", integrate="count"),
        bg.Df("record", integrate="top"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "F>n>m n>floor none>c>counter c>record")

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        falls = [(0.0, lambda s: height - g * s**2 / 2)]
        begins, speeds = [0.0], [0.0]
        begin = 1.0
        for k in range(1, 5):
            falls.append((begin, lambda s, v=10 * e**k: v * s - g * s**2 / 2))
            begins.append(begin)
            speeds.append(10 * e**k)
            begin += 2 * e**k
        counted = [(at, lambda s, n=n: n + 0 * s) for n, at in enumerate(begins)]
        tops = [(at, lambda s, v=v: v / g + 0 * s) for at, v in zip(begins, speeds, strict=True)]
        return {
            "q_floor": stepwise(t, *falls), "count": stepwise(t, *counted), "top": stepwise(t, *tops)
        }  # fmt: skip

    return Kind(
        "rigid stop that resets states", graph, {"m": m, "e": e, "g": g}, {"F": f"{-m * g}"},
        known, 4.9, {"q_floor": height}, on=("floor",), at=0.5, mode={"floor": "apart"},
        rest={"inputs": {"F": 0.0}, "initial": {"q_floor": 1.0}},
    )  # fmt: skip


def reset_told() -> Kind:
    """A tank that fills at 2 a second and is half emptied as a gate opens, at 0.3 and at 0.8 s."""
    nodes = [
        bg.Sf("source", "Q"), bg.Zero("n"), bg.C("tank", "A", effort="h"), bg.One("pivot"),
        bg.R("rest", 1), bg.Sw("gate", "g - 0.5", reset={"h": "h/2"}),
    ]  # fmt: skip

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        parts = (0, lambda s: 1 + 2 * s), (0.3, lambda s: 0.8 + 2 * s), (0.8, lambda s: 0.9 + 2 * s)
        return {"h": stepwise(t, *parts)}

    return Kind(
        "switch that an input commands and that resets a state",
        bond_graph(nodes, "source>n>tank pivot>rest pivot>gate"), {"A": 0.5},
        {"Q": "1", "g": "step(0.3, 1, 0) + step(0.6, -1, 0) + step(0.8, 1, 0)"}, known, 0.99,
        {"h": 1.0}, at=0.5, mode={"gate": "on"}, rest={"inputs": {"Q": 0.0, "g": 0.0}},
    )  # fmt: skip


RESETTING = (reset, reset_bent, reset_told, reset_stop)
