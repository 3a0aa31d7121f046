"""Delays, each with a run that is known by hand: by the method of steps, or shifted."""

from collections.abc import Mapping
from math import factorial

import numpy as np
from references.build import bond_graph

import bondgraph as bg
from oracles.routes.kind import Array, Kind
from oracles.routes.signals import REF, B, J


def past() -> Kind:
    """J w' = K (ref - w(t - T)): ref times the sum of (-K/J)^k (t - (k - 1) T)^k / k! is left of it."""
    K, T = 0.8, 0.23

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        left = np.ones_like(t)
        for k in range(1, 10):
            left += (-K / J) ** k * np.maximum(t - (k - 1) * T, 0.0) ** k / factorial(k)
        return {"omega": REF * (1 - left)}

    graph = bond_graph(
        [bg.Se("motor", "K*(ref - late)"), bg.One("shaft"), bg.I("J", "J", flow="omega"),
         bg.Delay("late", "omega", time="T")], "motor>shaft>J")  # fmt: skip
    return Kind("loop over a delay", graph, {"J": J, "K": K, "T": T}, {"ref": f"{REF}"}, known, 1.6, at=0.31,
                rest={"inputs": {"ref": 0.0}, "initial": {"omega": 1.0}})  # fmt: skip


def line() -> Kind:
    """What a sampled controller gives comes two periods and a half later: jumps stay jumps."""
    every, T, K = 0.1, 0.25, 0.6

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        instants = np.arange(0, t[-1] + every, every)
        changes = sorted([(at, False) for at in instants] + [(at + T, True) for at in instants])
        w, torque, at, sent, found = 0.0, 0.0, 0.0, list[float](), np.zeros_like(t)
        for (begin, arrives), end in zip(
            changes, [*(c[0] for c in changes[1:]), np.inf], strict=True
        ):
            w = torque / B + (w - torque / B) * np.exp(-B / J * (begin - at))
            at = begin
            torque = sent.pop(0) if arrives else torque
            if not arrives:
                sent.append(K * (REF - w))
            own = (t >= begin - 1e-12) & (t < end - 1e-12)
            found[own] = torque / B + (w - torque / B) * np.exp(-B / J * (t[own] - begin))
        return {"omega": found}

    graph = bond_graph(
        [bg.Se("motor", "1*arrived"), bg.One("shaft"), bg.I("J", "J", flow="omega"), bg.R("b", "b"),
         bg.Controller("p", every=every, gives={"tau": "K*(ref - omega)"}),
         bg.Delay("arrived", "tau", time="T")], "motor>shaft>J shaft>b")  # fmt: skip
    return Kind("sampled controller over a line", graph, {"J": J, "b": B, "K": K, "T": T}, {"ref": f"{REF}"},
                known, 1.03, at=0.32, rest={"inputs": {"ref": 0.0}, "initial": {"omega": 1.0}})  # fmt: skip


def pushed_late() -> Kind:
    """A push of 3 N up to 0.3 s comes T later to a mass that 1 N of friction holds, and stops again."""
    T, m = 0.2, 2.0

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        first, then = np.clip(t - T, 0, 0.3), np.maximum(t - T - 0.3, 0)
        return {"v": np.maximum(2 / m * first - 1 / m * then, 0)}

    graph = bond_graph(
        [bg.Se("push", "1*late"), bg.One("n"), bg.I("m", "m", flow="v"), bg.Delay("late", "P", time="T"),
         bg.R("floor", law=bg.DryFriction("N"))], "push>n>m n>floor")  # fmt: skip
    return Kind("friction that a late push lets go", graph, {"m": m, "N": 1.0, "T": T},
                {"P": "constant(3) + step(0.3, -3)"}, known, 1.53, at=0.31, mode={"floor": "slip"},
                rest={"inputs": {"P": 0.5}})  # fmt: skip


DELAYED = (past, line, pushed_late)
