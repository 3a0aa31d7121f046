"""Nonlinear models by `Simulator.run` in numpy beside scipy over a right-hand side lambdified by hand.

``python benchmarks/nonlinear.py [model ...]``: five masses on cubic springs, a hydraulic servo whose orifices
are square roots, Robertson's reactions (stiff), and Fig. 11 with tires by the magic formula, whose clutch
locks: by hand a right-hand side for slipping, one for sticking, and the events of both. Both take the same
method and give the same samples, of the states alone by hand, of everything by the toolkit, which has its
default tolerances; by hand there are the loosest with which the error is no larger. Milliseconds are medians
of calls taken in turns. Errors are to scipy at tight tolerances: the largest of any state over its range, at
any sample.
"""

import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import networkx as nx
import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

sys.path[:0] = [str(Path(__file__).parents[1])]

import bondgraph as bg  # noqa: E402
import codegen  # noqa: E402
from differentials.laws import magic_formula_tire  # noqa: E402
from differentials.scenarios import prepared  # noqa: E402

ROUNDS, TIGHT = 7, 1e-13

AWAY = 1e-10
"""So far beyond rest a slip counts as zero [rad/s]: out of rest it begins with rounding."""

Array = np.ndarray[Any, np.dtype[np.float64]]
Rate = Callable[[float, Array], Any]


@dataclass(frozen=True)
class Case:
    """A model, its run, and the node of a clutch that slips first, with its torque over time."""

    equations: bg.StateEquations
    parameters: dict[str, float]
    initial: dict[str, float]
    times: Array
    method: str = "DOP853"
    laws: dict[Any, object] = field(default_factory=dict)
    inputs: dict[str, codegen.Signal] = field(default_factory=dict)
    clutch: str = ""
    breakpoints: tuple[float, ...] = ()


def _graph(nodes: list[Any], bonds: str) -> "nx.DiGraph[Any]":
    graph: nx.DiGraph[Any] = nx.DiGraph()
    graph.add_nodes_from(nodes)
    for path in bonds.split():
        nx.add_path(graph, path.split(">"))
    return graph


def masses(count: int = 5) -> Case:
    """Masses in a row from a wall on, each on a spring to the one before."""
    nodes, bonds = list[Any](), list[str]()
    for i in range(count):
        spring = bg.C(f"s{i}", law=f"k*q_s{i} + h*q_s{i}**3")
        nodes += [bg.One(f"v{i}"), bg.I(f"m{i}", "m", flow=f"w{i}"), spring]
        bonds.append(f"v{i}>m{i}")
        if i:
            nodes.append(bg.Zero(f"z{i}"))
            bonds.append(f"v{i}>z{i}>v{i - 1} z{i}>s{i}")
        else:
            bonds.append(f"v{i}>s{i}")
    equations = bg.derive(_graph(nodes, " ".join(bonds)))
    start = {str(name): 0.3 for name in equations.states if str(name) == "w0"}
    numbers = {"m": 1.0, "k": 40.0, "h": 900.0}
    return Case(equations, numbers, start, np.linspace(0.0, 10.0, 1001))


def servo() -> Case:
    """A cylinder between four orifices of a valve that is driven to and fro, and a mass on a spring."""

    def orifice(name: str, way: str) -> Any:
        drop = f"e_{name}"
        return bg.R(name, law=f"g*(a {way} x)*sign({drop})*sqrt(abs({drop}))", gives="flow")

    nodes = [
        bg.Se("P", "p_s"),
        bg.Zero("sup"),
        bg.Zero("A"),
        bg.Zero("B"),
        bg.Zero("T"),
        bg.Se("tank", "0"),
        *(bg.One(f"j{i}") for i in range(4)),
        orifice("o0", "+"),
        orifice("o1", "-"),
        orifice("o2", "-"),
        orifice("o3", "+"),
        bg.C("cA", "c_o", effort="p_A"),
        bg.C("cB", "c_o", effort="p_B"),
        bg.TF("tA", "1/A_p"),
        bg.TF("tB", "A_p"),
        bg.One("rod"),
        bg.I("M", "M", flow="v"),
        bg.R("d", "d"),
        bg.C("spring", "1/k"),
    ]
    bonds = (
        "P>sup sup>j0>A sup>j2>B A>j1>T B>j3>T T>tank j0>o0 j1>o1 j2>o2 j3>o3 A>cA B>cB "
        "A>tA>rod rod>tB>B rod>M rod>d rod>spring"
    )
    equations = bg.derive(_graph(nodes, bonds))
    numbers = {
        "p_s": 100.0,
        "a": 0.2,
        "g": 0.6,
        "c_o": 2e-3,
        "A_p": 2.0,
        "M": 1.0,
        "d": 30.0,
        "k": 100.0,
    }
    return Case(
        equations, numbers, {"p_A": 50.0, "p_B": 50.0}, np.linspace(0.0, 4.0, 1001),
        inputs={"x": codegen.Sine(0.15, 1.0)},
    )  # fmt: skip


def reactions() -> Case:
    """Robertson's three species: A to B, B and B to C and B, B and C to A and C."""
    nodes = [
        *(bg.Zero(name) for name in "ABC"),
        *(bg.C(f"n{name}", 1, effort=f"c_{name}") for name in "ABC"),
        *(bg.One(f"j{i}") for i in range(3)),
        bg.R("r0", law="k_1*c_A", gives="flow"), bg.R("r1", law="k_2*c_B**2", gives="flow"),
        bg.R("r2", law="k_3*c_B*c_C", gives="flow"),
    ]  # fmt: skip
    bonds = "A>nA B>nB C>nC A>j0>B B>j1>C B>j2>A j0>r0 j1>r1 j2>r2"
    equations = bg.derive(_graph(nodes, bonds))
    numbers = {"k_1": 0.04, "k_2": 3e7, "k_3": 1e4}
    times = np.concatenate([[0.0], np.logspace(-4, 5, 400)])
    return Case(equations, numbers, {"c_A": 1.0}, times, "Radau")


def tires() -> Case:
    """Fig. 11 with tires by the magic formula."""
    ready = prepared("alsd", "fig11", laws={f"tire_{j}": magic_formula_tire(j) for j in (1, 2)})
    return Case(
        ready.equations, dict(ready.parameters), dict(ready.initial), ready.times, "DOP853",
        dict(ready.laws), dict(ready.inputs), "clutch", (0.1, 0.5),
    )  # fmt: skip


MODELS: dict[str, Callable[[], Case]] = {
    "five masses, cubic springs": masses,
    "hydraulic servo": servo,
    "reactions, stiff": reactions,
    "Fig. 11, magic formula": tires,
}


class ByHand:
    """One lambdified right-hand side, or one each for slipping and sticking."""

    def __init__(self, case: Case) -> None:
        self.case = case
        given = {sp.Symbol(name): sp.Float(value) for name, value in case.parameters.items()}
        laws = {k: v for k, v in case.laws.items() if k != case.clutch}
        torque = sp.Symbol("torque_")
        if case.clutch:
            laws[case.clutch] = torque
        rates = bg.explicit(case.equations, laws=laws)
        self.names = [str(name) for name in rates]
        states, inputs = list(rates), [sp.Symbol(name) for name in case.inputs]
        values = [rate.subs(given) for rate in rates.values()]
        function = sp.lambdify([*states, *inputs, torque], values, "numpy", cse=True)
        self.start = np.array([case.initial.get(name, 0.0) for name in self.names])
        self._function, self._signals = function, list(case.inputs.values())
        if case.clutch:
            self._clutch(states, inputs, values, torque, given)

    def _clutch(
        self, states: list[Any], inputs: list[Any], values: list[Any], torque: Any, given: Any
    ) -> None:
        port = next(p for p in self.case.equations.ports if p.element.name == self.case.clutch)
        level = self.case.laws[self.case.clutch].level.subs(given)  # type: ignore[attr-defined]
        self._slip = received(self.case.equations, port.received, states).subs(given)
        self._level = sp.lambdify(inputs, level, "math")
        change = sum(sp.diff(self._slip, x) * v for x, v in zip(states, values, strict=True))
        slope, rest = sp.diff(change, torque), change.subs(torque, 0)
        holding = -rest / slope
        self._slips = sp.lambdify(states, self._slip, "math")
        self._holds = sp.lambdify([*states, *inputs], holding, "math", cse=True)
        stuck = [value.subs(torque, holding) for value in values]
        self._stuck = sp.lambdify([*states, *inputs], stuck, "numpy", cse=True)

    def run(self, rtol: float, atol: float) -> Array:
        """The states at the samples, in rows."""
        case, function, signals = self.case, self._function, self._signals
        if case.clutch:
            return self._run_clutch(rtol, atol)

        def rate(t: float, x: Array) -> Any:
            return function(*x, *[signal(t) for signal in signals], 0.0)

        span = (case.times[0], case.times[-1])
        options = {"method": case.method, "t_eval": case.times, "rtol": rtol, "atol": atol}
        return np.asarray(solve_ivp(rate, span, self.start, **options).y.T)

    def as_exact(self, error: float, expected: Array) -> tuple[float, float]:
        """The loosest tolerance, by half decades from 1e-6, whose error is no larger; and that error."""
        for half in range(12, 26):
            tolerance = 10.0 ** (-half / 2)
            apart = errors(self.run(tolerance, tolerance), expected)
            if apart <= error:
                break
        return tolerance, apart

    def _run_clutch(self, rtol: float, atol: float) -> Array:
        case, signals, n = self.case, self._signals, len(self.start)
        t, x, stuck, rows = float(case.times[0]), self.start, False, np.empty((len(case.times), n))
        sign = 1.0 if self._slips(*x) > 0 else -1.0

        def given(t: float) -> list[float]:
            return [signal(t) for signal in signals]

        def slipping(t: float, x: Array) -> Any:
            w = given(t)
            return self._function(*x, *w, sign * self._level(*w))

        def sticking(t: float, x: Array) -> Any:
            return self._stuck(*x, *given(t))

        def meets(t: float, x: Array) -> float:
            return float(sign * self._slips(*x)) + AWAY

        def breaks(t: float, x: Array) -> float:
            w = given(t)
            return float(self._level(*w) - abs(self._holds(*x, *w)))

        meets.direction = breaks.direction = -1.0  # type: ignore[attr-defined]
        meets.terminal = breaks.terminal = True  # type: ignore[attr-defined]
        while t < case.times[-1]:
            stop = min([b for b in (*case.breakpoints, case.times[-1]) if b > t])
            rate, event = (sticking, breaks) if stuck else (slipping, meets)
            inside = case.times[(case.times >= t) & (case.times <= stop)]
            done = solve_ivp(rate, (t, stop), x, method=case.method, dense_output=True, events=event,
                             t_eval=None, rtol=rtol, atol=atol)  # fmt: skip
            inside = inside[inside <= done.t[-1]] if len(done.t) > 1 else inside[:0]
            rows[np.searchsorted(case.times, inside)] = done.sol(inside).T if len(inside) else 0.0
            t, x = float(done.t[-1]), done.y[:, -1]
            if done.status == 1:
                w = given(t)
                if stuck:
                    stuck, sign = False, float(np.sign(self._holds(*x, *w)))
                else:
                    stuck = bool(abs(self._holds(*x, *w)) <= self._level(*w))
        return rows


def received(equations: bg.StateEquations, name: Any, states: list[Any]) -> Any:
    """What a port receives, as a sum of states."""
    return sum(entry * states[j] for j, entry in equations.readings[name].F.items())


def errors(found: Array, expected: Array) -> float:
    """The largest error of any state, over its range."""
    span = np.maximum(np.ptp(expected, axis=0), 1e-300)
    return float((np.abs(found - expected).max(axis=0) / span).max())


def main(chosen: list[str]) -> None:
    """Measure and print."""
    print(
        f"{'milliseconds':<28}{'toolkit':>10}{'by hand':>10}{'ratio':>8}{'error':>10}{'by hand':>10}"
    )
    for name in chosen or MODELS:
        case = MODELS[name]()
        hand = ByHand(case)
        simulator = codegen.simulator(case.equations, case.parameters, case.laws or None)

        def toolkit() -> Any:
            return simulator.run(case.times, case.initial, case.inputs, method=case.method)  # noqa: B023

        def by_hand() -> Array:
            return hand.run(tolerance, tolerance)  # noqa: B023

        expected = hand.run(TIGHT, TIGHT)
        run = toolkit()
        found = errors(np.column_stack([run[state] for state in hand.names]), expected)
        tolerance, apart = hand.as_exact(found, expected)
        lasted: tuple[list[float], list[float]] = ([], [])
        for _ in range(ROUNDS):
            for call, kept in zip((toolkit, by_hand), lasted, strict=True):
                began = time.perf_counter()
                call()
                kept.append(1e3 * (time.perf_counter() - began))
        mine, other = map(statistics.median, lasted)
        print(f"{name:<28}{mine:>10.1f}{other:>10.1f}{mine / other:>8.2f}{found:>10.1e}{apart:>10.1e}",
              flush=True)  # fmt: skip


if __name__ == "__main__":
    main(sys.argv[1:])
