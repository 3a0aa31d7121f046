"""Signals as nodes, each with a run that is known by hand."""

from collections.abc import Callable, Mapping

import numpy as np
from references.build import bond_graph

import bondgraph as bg
from oracles.routes.kind import Array, Kind

J, B, REF = 0.5, 0.2, 3.0
"""A motor's inertia [kg m^2] and friction [N m s], and the speed [rad/s] that it is to have."""


def _motor(*nodes: bg.nodes.elements.Node) -> "bg.BondGraph":
    return bond_graph(
        [bg.Se("motor", "1*tau"), bg.One("shaft"), bg.I("J", "J", flow="omega"), bg.R("b", "b"), *nodes],
        "motor>shaft>J shaft>b",
    )  # fmt: skip


def function() -> Kind:
    """J w' = K (ref - w) - b w."""
    K = 2.0

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        w = K * REF / (K + B) * (1 - np.exp(-(K + B) / J * t))
        return {"omega": w, "tau": K * (REF - w)}

    graph = _motor(bg.Function("tau", "K*e"), bg.Function("e", "ref - omega"))
    return Kind("function of signals", graph, {"J": J, "b": B, "K": K}, {"ref": f"{REF}"}, known, 1.0, at=0.3,
                rest={"inputs": {"ref": REF}})  # fmt: skip


def state() -> Kind:
    """J w'' + (b + K) w' + K_i w = K_i ref, from rest, and w' = K ref/J at first."""
    K, Ki = 0.4, 4.0
    decay = (B + K) / (2 * J)
    w0 = np.sqrt(Ki / J - decay**2)

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        swing = np.exp(-decay * t)
        slope = (K * REF / J - decay * REF) / w0
        w = REF + swing * (-REF * np.cos(w0 * t) + slope * np.sin(w0 * t))
        return {"omega": w}

    graph = _motor(bg.Function("tau", "K*(ref - omega) + z"), bg.State("z", "K_i*(ref - omega)"))
    return Kind("state with a rate", graph, {"J": J, "b": B, "K": K, "K_i": Ki}, {"ref": f"{REF}"}, known,
                1.0, at=0.3, rest={"inputs": {"ref": REF}})  # fmt: skip


def bounded() -> Kind:
    """z' = 2 - 4 t up to 0.3, where it stays until t = 1/2, down to -0.2."""
    first = 0.5 * (1 - np.sqrt(1 - 0.6))

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        z = np.where(t < first, 2 * t - 2 * t**2, 0.3)
        z = np.where(t > 0.5, 0.3 - 2 * (t - 0.5) ** 2, z)
        return {"z": np.maximum(z, -0.2)}

    graph = _motor(bg.Function("tau", "z"), bg.State("z", "2 - 4*t", low=-0.2, high="top"))
    return Kind("integrator within bounds", graph, {"J": J, "b": B, "top": 0.3}, {}, known, 1.3, at=0.3,
                mode={"z.high": "touch", "z.low": "apart"})  # fmt: skip


def _held(t: Array, period: float, step: Callable[[int, float], float]) -> tuple[Array, Array]:
    """Speed and torque of the motor: at each instant ``step`` tells the torque of the speed there."""
    speeds, torques = np.zeros_like(t), np.zeros_like(t)
    w = 0.0
    count = int(np.floor(float(t[-1]) / period + 1e-9)) + 1
    for k in range(count):
        begin = k * period
        tau = step(k, w)
        own = t > begin - 1e-12
        rest = t[own] - begin
        speeds[own] = tau / B + (w - tau / B) * np.exp(-B / J * rest)
        torques[own] = tau
        w = tau / B + (w - tau / B) * float(np.exp(-B / J * period))
    return speeds, torques


def controller() -> Kind:
    """A sampled PI: between its instants the motor relaxes to a constant torque."""
    T, K, Ki = 0.05, 2.0, 6.0

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        z = [0.0]

        def step(_: int, w: float) -> float:
            given = K * (REF - w) + z[0]
            z[0] += T * Ki * (REF - w)
            return given

        speeds, torques = _held(t, T, step)
        return {"omega": speeds, "tau": torques}

    pi = bg.Controller(
        "pi", every=T, states={"z": 0}, update={"z": "z + T*K_i*(ref - omega)"},
        gives={"tau": "K*(ref - omega) + z"},
    )  # fmt: skip
    return Kind("sampled controller", _motor(pi), {"J": J, "b": B, "T": T, "K": K, "K_i": Ki},
                {"ref": f"{REF}"}, known, 1.0, at=0.31, rest={"inputs": {"ref": REF}})  # fmt: skip


def saturating() -> Kind:
    """The same within bounds of its torque, its sum then frozen."""
    T, K, Ki, most = 0.05, 2.0, 6.0, 2.5

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        z = [0.0]

        def step(_: int, w: float) -> float:
            wanted = K * (REF - w) + z[0]
            if abs(wanted) < most:
                z[0] += T * Ki * (REF - w)
            return min(max(wanted, -most), most)

        speeds, torques = _held(t, T, step)
        return {"omega": speeds, "tau": torques}

    pi = bg.Controller(
        "pi", every=T, states={"z": 0},
        update={"z": "Piecewise((z + T*K_i*(ref - omega), abs(K*(ref - omega) + z) < most), (z, True))"},
        gives={"tau": "max(-most, min(most, K*(ref - omega) + z))"},
    )  # fmt: skip
    return Kind("sampled controller that saturates", _motor(pi),
                {"J": J, "b": B, "T": T, "K": K, "K_i": Ki, "most": most}, {"ref": f"{REF}"}, known, 1.0,
                at=0.31, rest={"inputs": {"ref": REF}})  # fmt: skip


def cascade() -> Kind:
    """A slow controller, late by its offset, tells a fast one what to follow; both at once see the past."""
    fast, K = 0.02, 2.0

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        wanted = [0.0]

        def step(k: int, w: float) -> float:
            given = K * (wanted[0] - w)
            if k % 5 == 2:
                wanted[0] = REF - 0.25 * w
            return given

        speeds, torques = _held(t, fast, step)
        return {"omega": speeds, "tau": torques}

    graph = _motor(
        bg.Controller("inner", every=fast, gives={"tau": "K*(wanted - omega)"}),
        bg.Controller("outer", every="1/10", offset=0.04, reads=["ref", "omega"],
                      gives={"wanted": "ref - omega/4"}),
    )  # fmt: skip
    return Kind("two controllers at two rates", graph, {"J": J, "b": B, "K": K}, {"ref": f"{REF}"}, known,
                1.0, at=0.31, rest={"inputs": {"ref": REF}})  # fmt: skip


def thermostat() -> Kind:
    """A vent that a sampled thermostat opens above 25 degrees: each way a lag, turned at instants alone."""
    P, C, R, vent, every = 12.0, 2.0, 10.0, 1.0, 0.1

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        theta, at, found, opens = 24.5, 0.0, np.zeros_like(t), np.zeros_like(t)
        while at < t[-1] + every / 2:
            opened = theta > 25
            conductance = 1 / R + opened / vent
            to, tau = P / conductance, C / conductance
            own = t > at - 1e-12
            found[own] = to + (theta - to) * np.exp((at - t[own]) / tau)
            opens[own] = opened
            theta, at = to + (theta - to) * float(np.exp(-every / tau)), at + every
        return {"theta": found, "gate": opens}

    nodes = [bg.Sf("power", "P"), bg.Zero("n"), bg.One("pass"), bg.R("vent", "R_v"), bg.R("wall", "R"),
             bg.Sw("relay", on="gate - 1/2"), bg.C("room", "C", effort="theta"),
             bg.Controller("thermostat", every=every,
                           gives={"gate": "Piecewise((1, theta > 25), (0, True))"})]  # fmt: skip
    graph = bond_graph(nodes, "power>n n>room n>wall n>pass pass>vent pass>relay")
    return Kind("switch that a sampled controller turns", graph, {"C": C, "R": R, "R_v": vent}, {"P": f"{P}"},
                known, 2.05, {"theta": 24.5}, at=0.05, mode={"relay": "off"},
                rest={"inputs": {"P": 1.0}, "initial": {"theta": 9.0}})  # fmt: skip


def braked() -> Kind:
    """A brake of 3 N for four of a controller's instants, then of 1/2: a rest from 1/4 to 0.4 s."""

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"v": np.where(t < 0.4, np.maximum(0.5 - 2 * t, 0), 0.5 * (t - 0.4))}

    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"),
             bg.R("brake", law=bg.DryFriction("N")),
             bg.Controller("sequence", every="1/10", states={"k": 0}, update={"k": "Min(k + 1, 9)"},
                           gives={"N": "Piecewise((3, k < 4), (most, True))"})]  # fmt: skip
    return Kind("brake that a sampled controller sets", bond_graph(nodes, "push>n>m n>brake"),
                {"m": 1.0, "most": 0.5}, {"P": "1"}, known, 0.98, {"v": 0.5}, at=0.12, mode={"brake": "slip"},
                rest={"inputs": {"P": 0.25}, "initial": {"v": 0.0, "k": 9.0, "N": 0.5}})  # fmt: skip


def wired() -> Kind:
    """The sampled PI by wires: a detector, a sum of two ports, a source without a value."""
    T, K, Ki = 0.05, 2.0, 6.0
    pi = bg.Controller(
        "pi", every=T, ports=["e"], states={"z": 0}, update={"z": "z + T*K_i*e"}, gives={"tau": "K*e + z"}
    )  # fmt: skip
    graph = bg.graph(
        [bg.Se("motor"), bg.One("shaft"), bg.I("J", "J", flow="omega"), bg.R("b", "b"), bg.Df("tacho"),
         bg.Function("goal", "1*ref"), bg.Function("error", "plus - minus", ports=["plus", "minus"]), pi],
        "motor > shaft > J, shaft > b, shaft > tacho",
        "goal > error.plus, tacho > error.minus, error > pi.tau > motor",
    )  # fmt: skip
    return Kind("controller by wires", graph, {"J": J, "b": B, "T": T, "K": K, "K_i": Ki}, {"ref": f"{REF}"},
                controller().known, 1.0, at=0.31, rest={"inputs": {"ref": REF}})  # fmt: skip


SIGNALS = (function, state, bounded, controller, saturating, cascade, wired, thermostat, braked)
