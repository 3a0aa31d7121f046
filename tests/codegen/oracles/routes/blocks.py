"""Blocks, each with a run that is known by hand; what they give drives a motor from rest."""

from collections.abc import Mapping, Sequence

import numpy as np
from references.build import bond_graph
from scipy.optimize import brentq

import bondgraph as bg
from oracles.routes.kind import Array, Kind, relaxed, stepwise

J, B, REF = 0.5, 0.2, 3.0
"""A motor's inertia [kg m^2] and friction [N m s], and the speed [rad/s] that it is to have."""

MOTOR = {"J": J, "b": B}


def _motor(*nodes: bg.nodes.elements.Node) -> bg.BondGraph:
    return bond_graph(
        [bg.Se("motor", "1*tau"), bg.One("shaft"), bg.I("J", "J", flow="omega"), bg.R("b", "b"), *nodes],
        "motor>shaft>J shaft>b",
    )  # fmt: skip


def _lag(t: Array, level: float, rate: float, start: float = 0.0) -> Array:
    """What goes to a level at a rate [1/s]."""
    return level + (start - level) * np.exp(-rate * t)


def _ramped(t: Array, slope: float) -> Array:
    """The motor's speed under a torque that rises from 0."""
    return slope / B * (t - J / B * (1 - np.exp(-B / J * t)))


def _stepped(t: Array, num: Sequence[float], den: Sequence[float]) -> Array:
    """The response to a step of one, by partial fractions; the poles are single."""
    poles, slope = np.roots(den), np.polyder(den)
    parts = [np.polyval(num, p) / (p * np.polyval(slope, p)) * np.exp(p * t) for p in poles]
    return np.real(sum(parts)) + num[-1] / den[-1]


def chain() -> Kind:
    """J w' = K z - b w, z' = ref - w, both from rest."""
    K = 4.0
    decay = B / (2 * J)
    w0 = np.sqrt(K / J - decay**2)

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        swing = np.cos(w0 * t) + decay / w0 * np.sin(w0 * t)
        return {"omega": REF - REF * np.exp(-decay * t) * swing}

    graph = _motor(bg.Sum("e", "ref", "-omega"), bg.Integrator("z", "e"), bg.Gain("tau", "z", "K"))
    return Kind("sum, integrator, gain", graph, {**MOTOR, "K": K}, {"ref": f"{REF}"}, known, 1.0,
                at=0.3, rest={"inputs": {"ref": REF}})  # fmt: skip


def transfer() -> Kind:
    """A lead of first order, and a lag of third order with a zero behind it."""
    numbers = {"k": 2.0, "T": 0.3, "c": 4.0, "g": 2.0}
    lead = [2.0 * 0.3, 2.0], [0.1, 1.0]
    lag = [4.0, 1.0], [2.0, 5.0, 11.0, 4.0]

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        both = np.polymul(lead[0], lag[0]), np.polymul(lead[1], lag[1])
        return {"u": REF * _stepped(t, *lead), "tau": REF * _stepped(t, *both)}

    graph = _motor(
        *bg.TransferFunction("u", "ref", ["k*T", "k"], [0.1, 1]),
        *bg.TransferFunction("tau", "u", [0, "c", 1], ["g", 5, "c + 7", "c"]),
    )
    return Kind("transfer functions", graph, {**MOTOR, **numbers}, {"ref": f"{REF}"}, known, 2.0,
                at=0.7, rest={"inputs": {"ref": REF}})  # fmt: skip


def space() -> Kind:
    """x' = -(a + i w) x + w u, its real and its imaginary part."""
    a, w = 0.5, 3.0

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        x = w * REF / (a + 1j * w) * (1 - np.exp(-(a + 1j * w) * t))
        return {"y_1": x.real + REF / 2, "y_2": 2 * x.imag}

    made = bg.StateSpace("y", ["ref", "0*t"], A=[["-a", "w"], ["-w", "-a"]], B=[["w", 0], [0, 1]],
                         C=np.diag([1, 2]), D=[[1 / 2, 0], [0, 0]])  # fmt: skip
    return Kind("state space", _motor(*made, bg.Gain("tau", "y_1", 1)), {**MOTOR, "a": a, "w": w},
                {"ref": f"{REF}"}, known, 2.0, at=0.7, rest={"inputs": {"ref": REF}})  # fmt: skip


def pid() -> Kind:
    """w/ref is C/(C + J s + b), with the controller's three terms over one denominator."""
    kp, ki, kd, tau_d = 2.0, 6.0, 0.3, 0.05
    own = np.polyadd(np.polymul([kp, ki], [tau_d, 1]), [kd, 0, 0])
    loop = np.polyadd(np.polymul([tau_d, 1, 0], [J, B]), own)

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        torque = np.polymul(own, [J, B])
        return {"omega": REF * _stepped(t, own, loop), "tau": REF * _stepped(t, torque, loop)}

    graph = _motor(*bg.PID("tau", "ref - omega", "kp", "ki", "kd", "tau_d"))
    return Kind("PID controller", graph, {**MOTOR, "kp": kp, "ki": ki, "kd": kd, "tau_d": tau_d},
                {"ref": f"{REF}"}, known, 1.5, at=0.4, rest={"inputs": {"ref": REF}})  # fmt: skip


def clamped() -> Kind:
    """An error 2 - 4 t: the integral rests at the bound from where it comes to it until t = 1/2."""
    kp, most = 0.1, 0.3
    first = 0.5 * (1 - np.sqrt(1 - 2 * most))

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        z = np.where(t < first, 2 * t - 2 * t**2, most)
        z = np.where(t > 0.5, most - 2 * (t - 0.5) ** 2, z)
        return {"x_tau_i": z, "tau": np.minimum(kp * (2 - 4 * t) + z, most)}

    graph = _motor(*bg.PID("tau", "2 - 4*t", kp, 1, low=-9, high="most"))
    return Kind("PID within bounds, clamped", graph, {**MOTOR, "most": most}, {}, known, 1.1, at=0.4,
                mode={"x_tau_i.high": "touch", "x_tau_i.low": "apart"})  # fmt: skip


def led_back() -> Kind:
    """An error of 1 until 1/2, then -1: beyond its bound the sum is led back within tau_t."""
    kp, ki, most, tau_t = 1.0, 4.0, 1.5, 0.1
    comes = (most - kp) / ki
    top = most - kp + ki * tau_t * (1 - np.exp(-(0.5 - comes) / tau_t))

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        beyond = lambda s: _lag(s, most - kp + ki * tau_t, 1 / tau_t, most - kp)  # noqa: E731
        z = stepwise(t, (0, lambda s: ki * s), (comes, beyond), (0.5, lambda s: top - ki * s))
        return {"x_tau_i": z, "tau": np.minimum(np.where(t < 0.5, kp, -kp) + z, most)}

    graph = _motor(*bg.PID("tau", "e", "kp", ki, high="most", tau_t="tau_t"))
    return Kind("PID within a bound, led back", graph, {**MOTOR, "kp": kp, "most": most, "tau_t": tau_t},
                {"e": "step(0.5, -1, 1)"}, known, 0.99, at=0.3,
                rest={"inputs": {"e": 0.0}})  # fmt: skip


def limited() -> Kind:
    """All that the motor may give as long as K (ref - w) is more."""
    K, most = 2.0, 2.5
    leaves = -J / B * np.log(1 - (REF - most / K) * B / most)

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        near = lambda s: _lag(s, K * REF / (K + B), (K + B) / J, REF - most / K)  # noqa: E731
        w = stepwise(t, (0, lambda s: _lag(s, most / B, B / J)), (leaves, near))
        return {"omega": w, "tau": np.minimum(K * (REF - w), most)}

    graph = _motor(bg.Limiter("tau", "K*(ref - omega)", -1, "most"))
    return Kind("limiter", graph, {**MOTOR, "K": K, "most": most}, {"ref": f"{REF}"}, known, 1.0,
                at=0.8, rest={"inputs": {"ref": REF}})  # fmt: skip


def dead_zone() -> Kind:
    """A ramp moves the motor once it is beyond the dead zone."""
    slope, high = 4.0, 0.5

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        since = np.maximum(t - high / slope, 0)
        return {"tau": slope * since, "omega": _ramped(since, slope)}

    graph = _motor(bg.DeadZone("tau", "ref", -1, "high"))
    return Kind("dead zone", graph, {**MOTOR, "high": high}, {"ref": f"ramp(0, {slope})"}, known, 0.6,
                at=0.4, rest={"inputs": {"ref": 1.0}})  # fmt: skip


def looked_up() -> Kind:
    """A torque of 2 - w up to w = 1, then of (3 - w)/2."""
    passes = J / (1 + B) * np.log(1 / (1 - (1 + B) / 2))

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        before = lambda s: _lag(s, 2 / (1 + B), (1 + B) / J)  # noqa: E731
        after = lambda s: _lag(s, 1.5 / (0.5 + B), (0.5 + B) / J, 1.0)  # noqa: E731
        return {"omega": stepwise(t, (0, before), (passes, after))}

    graph = _motor(bg.LookUp("tau", "omega", bg.LookupTable("curve", [0, 1, 3], [2, 1, 0])))
    return Kind("look-up", graph, MOTOR, {}, known, 1.0, at=0.8, rest={})  # fmt: skip


def two_valued() -> Kind:
    """Pushed up to a speed, let go down to another."""
    low, high, push = 1.0, 1.5, 2.0
    T = J / B
    top = push / B
    rises, falls = T * np.log((top - low) / (top - high)), T * np.log(high / low)
    first = T * np.log(top / (top - high))

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        edges = [(0.0, top)]
        for k in range(4):
            edges.append((first + k * (rises + falls), 0.0))
            edges.append((first + k * (rises + falls) + falls, top))
        w = relaxed(t, 0.0, T, edges)
        pushed = stepwise(t, *((at, lambda s, v=v: v * B + 0 * s) for at, v in edges))
        return {"omega": w, "tau": pushed}

    graph = _motor(bg.Hysteresis("tau", "omega", "low", high, off="push", on=0))
    return Kind("hysteresis", graph, {**MOTOR, "low": low}, {"push": f"{push}"}, known, 2.0, at=0.2,
                mode={"tau.switch": "off"}, rest={"inputs": {"push": 0.1}})  # fmt: skip


def slewing() -> Kind:
    """A torque that rises at a rate until it meets K (ref - w), which it then follows."""
    K, rate = 0.4, 2.0
    meets = brentq(lambda t: K * (REF - _ramped(t, rate)) - rate * t, 0.1, 2.0, xtol=1e-15)

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        follows = lambda s: _lag(s, K * REF / (K + B), (K + B) / J, _ramped(meets, rate))  # noqa: E731
        w = stepwise(t, (0, lambda s: _ramped(s, rate)), (meets, follows))
        return {"omega": w, "tau": np.where(t < meets, rate * t, K * (REF - w))}

    graph = _motor(bg.RateLimiter("tau", "K*(ref - omega)", "rate", falling=3))
    return Kind("rate limiter in a loop", graph, {**MOTOR, "K": K, "rate": rate}, {"ref": f"{REF}"},
                known, 1.5, at=1.0, mode={"tau.clutch": "stick"},
                rest={"inputs": {"ref": 0.0}})  # fmt: skip


def slewed() -> Kind:
    """A step of 1 up and down again, at 4 a second up and 2 a second down."""

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"tau": np.clip(np.minimum(4 * (t - 0.1), 1 - 2 * (t - 0.6)), 0, 1)}

    graph = _motor(bg.RateLimiter("tau", "ref", "rise", "fall"))
    return Kind("rate limiter of a step", graph, {**MOTOR, "rise": 4.0, "fall": 2.0},
                {"ref": "step(0.1, 1, 0) + step(0.6, -1, 0)"}, known, 1.3, at=0.2,
                mode={"tau.clutch": "slip"}, rest={"inputs": {"ref": 0.0}})  # fmt: skip


BLOCKS = (
    chain, transfer, space, pid, clamped, led_back, limited, dead_zone, looked_up, two_valued, slewing,
    slewed,
)  # fmt: skip
"""All kinds, in the order of the table."""
