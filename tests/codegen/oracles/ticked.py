"""A motor under a sampled PI: the model that all routes run, and the same as a chain of segments."""

from collections.abc import Sequence

import numpy as np
from references.build import bond_graph
from scipy.linalg import expm

import bondgraph as bg
import codegen
from oracles.units import Case

NUMBERS = {"L": 0.05, "R": 1.0, "k": 0.5, "J": 0.02, "b": 0.01, "K": 0.8, "K_i": 9.0, "T": 0.03}
"""Inductance [H], resistance [ohm], constant [V s], inertia [kg m^2], friction [N m s], gains, period [s]."""

REF = codegen.Step(0.337, 5.0, 2.0)
"""The speed [rad/s] that the motor is to have."""

EVERY, LATE, UNIT, END = 3, 1, 100, 1.2
"""The instants are (3 k + 1)/100 s."""

INSTANTS = tuple((EVERY * k + LATE) / UNIT for k in range(40))
"""The correctly rounded quotients, up to the end."""


def case(offset: object = "1/100") -> Case:
    """The loop; ``stamp`` keeps the time of the latest instant."""
    nodes = [
        bg.Se("source", "1*V"), bg.One("coil"), bg.I("L", "L", flow="i"), bg.R("R", "R"),
        bg.GY("motor", "k"), bg.One("shaft"), bg.I("J", "J", flow="omega"), bg.R("b", "b"),
        bg.Controller(
            "pi", every="3/100", offset=offset, states={"z": 0.0},
            update={"z": "z + T*K_i*(ref - omega)"},
            gives={"V": "K*(ref - omega) + z", "stamp": "t"},
        ),
    ]  # fmt: skip
    graph = bond_graph(nodes, "source>coil>motor>shaft>J coil>L coil>R shaft>b")
    return Case(bg.derive(graph), NUMBERS, None, {}, {"ref": REF}, END)


def counter() -> Case:
    """What counts its own instants, 0.1 s apart, beside a mass that goes on."""
    nodes = [
        bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"),
        bg.Controller("count", every="1/10", states={"n": 0}, update={"n": "n + 1"},
                      gives={"seen": "v", "stamp": "t"}),
    ]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "push>n>m"))
    return Case(equations, {"m": 2.0}, None, {"v": 3.0}, {"P": 0.0}, 1.0)


def segments(times: Sequence[float]) -> dict[str, np.ndarray]:
    """States at these times, of matrix exponentials from instant to instant; just after at an instant."""
    p = NUMBERS
    plant = np.array([[-p["R"] / p["L"], -p["k"] / p["L"], 1 / p["L"]],
                      [p["k"] / p["J"], -p["b"] / p["J"], 0.0], [0.0] * 3])  # fmt: skip
    x, z, stamp, begin = np.zeros(3), 0.0, 0.0, 0.0
    rows, following = [], [*INSTANTS, np.inf]
    for t in times:
        while following[0] <= t + 1e-12:
            stamp = following.pop(0)
            x = expm(plant * (stamp - begin)) @ x
            begin, error = stamp, (5.0 if stamp >= 0.337 else 2.0) - x[1]
            x[2], z = p["K"] * error + z, z + p["T"] * p["K_i"] * error
        here = expm(plant * (t - begin)) @ x
        rows.append([*here[:2], here[2], z, stamp])
    return dict(zip(("i", "omega", "V", "z", "stamp"), np.array(rows).T, strict=True))


def check(run: object, times: Sequence[float], within: float = 1e-9) -> None:
    """A run at these times against the segments: states to a part of their ranges, instants to a rounding.

    Instants are exact where no sample is a rounding before one, which it then shows.
    """
    right = segments(times)
    for name in ("i", "omega", "V", "z"):
        off = np.abs(run[name] - right[name]).max()  # type: ignore[index]
        assert off <= within * np.ptp(right[name]), f"{name} is off by {off:.1e}"
    np.testing.assert_allclose(run["stamp"], right["stamp"], rtol=1e-15, atol=0)  # type: ignore[index]
    if np.abs(np.subtract.outer(times, INSTANTS)).min() > 1e-9:
        assert np.array_equal(run["stamp"], right["stamp"])  # type: ignore[index]
