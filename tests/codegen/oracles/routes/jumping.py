"""Laws that jump, each with a run that is known by hand."""

from collections.abc import Mapping

import numpy as np
from references.build import bond_graph

import bondgraph as bg
from oracles.routes.kind import Array, Kind, stepwise

N, A, P, LEVEL = 4.0, 6.0, 7.0, 0.5
BRAKE, PULL = 2.0, 20.0


def _relay():
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"),
             bg.R("relay", flow="w", law="N*sign(w - level)")]  # fmt: skip
    return bond_graph(nodes, "push>n>m n>relay")


def relay() -> Kind:
    """v' = A t - N sign(v - level) from twice the level on: it slides until A t is N."""
    comes, goes = (N - np.sqrt(N**2 - 2 * LEVEL * A)) / A, N / A

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        above = stepwise(t, (0, lambda s: LEVEL - N * s + A * s**2 / 2), (comes, lambda s: 0 * s),
                         (goes, lambda s: A * s**2 / 2))  # fmt: skip
        return {"v": LEVEL + above}

    return Kind(
        "relay that slides", _relay(), {"m": 1.0, "N": N, "level": LEVEL}, {"P": f"ramp(0, {A})"}, known, 1.0,
        {"v": 2 * LEVEL}, at=0.8, rest={"inputs": {"P": 2.0}, "initial": {"v": 1.0}},
    )  # fmt: skip


def crossed() -> Kind:
    """v' = P + N below the level, P - N above it."""
    at = LEVEL / (P + N)

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"v": stepwise(t, (0, lambda s: (P + N) * s), (at, lambda s: LEVEL + (P - N) * s))}

    return Kind(
        "law that jumps and is crossed", _relay(), {"m": 1.0, "N": N, "level": LEVEL}, {"P": f"{P}"}, known,
        0.2, at=0.1, rest={"inputs": {"P": 2.0}},
    )  # fmt: skip


def resting() -> Kind:
    """m x'' = P - N sign(x) - A sign(x'): swings shrink to rest, until P is beyond both."""
    m, out, back = 1.0, N + BRAKE, N - BRAKE
    leaves = 3.2 + out / PULL

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        parts, begin, top, side = [], 0.0, 1.0, 1.0
        while top > 1e-13:
            fall, rise = np.sqrt(2 * top * m / back), np.sqrt(2 * top * m * back) / out
            height = back * top / out
            parts.append((begin, lambda s, a=side * top, b=side: a - b * back * s**2 / 2 / m))
            parts.append((begin + fall, lambda s, h=-side * height, r=rise, b=side:
                          h + b * out * (r - s) ** 2 / 2 / m))  # fmt: skip
            begin, top, side = begin + fall + rise, height, -side
        rest = (begin, lambda s: 0 * s), (leaves, lambda s: PULL / m * s**3 / 6)
        return {"x": stepwise(t, *parts, *rest)}

    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"), bg.Df("d", integrate="x"),
             bg.R("relay", flow="w", law="N*sign(x) + A*sign(w)")]  # fmt: skip
    return Kind(
        "relay of second order", bond_graph(nodes, "push>n>m n>relay n>d"), {"m": m, "N": N, "A": BRAKE},
        {"P": f"ramp(3.2, {PULL})"}, known, 4.0, {"x": 1.0}, at=0.3,
        rest={"inputs": {"P": 2.0}, "initial": {"x": 0.1}},
    )  # fmt: skip


JUMPING = (relay, crossed, resting)
