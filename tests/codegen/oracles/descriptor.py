"""IDA on the descriptor form ``A x' - J x - B u - E u' = 0``: A is never inverted, no rate solved for.

States and inputs are unknowns together. Each input has an equation of its own: the signal it is given, its
law over what its port receives, the friction of a slip of known sign, or, for a port that sticks, that
the slip's rate ``F x'`` vanishes; what holds the port comes out. All is read off the symbolic equations.
The stretches between events are taken from a run, and each event is put to the test: how far a slip
is from zero where it ends, and the holding effort from its limit where it lets go.
"""

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import sympy as sp
from sksundae.ida import IDA

import bondgraph as bg
from codegen import Event, Signal

RTOL, ATOL = 1e-11, 1e-11

UNTESTED = 1e-2
"""Absolute tolerance of inputs, whose rates are unknown where a stretch begins; states have their own."""

Residual = Callable[..., list[float]]


@dataclass(frozen=True)
class Descriptor:
    """A model with constant values: equations, numbers, laws by node, and signals by name."""

    equations: bg.StateEquations
    numbers: Mapping[str, object]
    laws: Mapping[Hashable, object]
    signals: Mapping[str, Signal]

    @property
    def ports(self) -> dict[Hashable, tuple[sp.Symbol, sp.Symbol, sp.Expr]]:
        """Friction port to what it gives, what it receives, and its level."""
        return {
            port.element.name: (port.given, port.received, law.level)
            for port in self.equations.ports
            if isinstance(law := self.laws.get(port.element.name), bg.DryFriction)
        }

    def follow(
        self, times: np.ndarray, start: Mapping[str, float], events: Sequence[Event]
    ) -> tuple[np.ndarray, list[float]]:
        """The states at the times, and for each event how far [s] it is from where it should be."""
        names = self.equations.states
        x = np.array([start.get(name.name, 0.0) for name in names])
        mode = {name: np.sign(self._received(slip, x)) for name, (_, slip, _) in self.ports.items()}
        breaks = {b for signal in self.signals.values() for b in signal.breakpoints}
        marks = sorted({times[0], times[-1], *breaks, *(event.time for event in events)})
        marks = [mark for mark in marks if times[0] <= mark <= times[-1]]
        rows, apart = [x], list[float]()
        for begin, end in pairwise(marks):
            inside = times[(times > begin) & (times <= end)]
            grid = np.unique([begin, *inside, end])
            y, rates = self._stretch(grid, x, mode)
            rows += list(y[np.isin(grid, inside), : len(names)])
            x = y[-1, : len(names)]
            for event in events:
                if event.time == end:
                    apart.append(self._apart(event, end, y, rates, grid, mode))
                    mode[event.port] = self._after(event, y[-1], mode)
        return np.array(rows), apart

    def _received(self, name: sp.Symbol, x: np.ndarray) -> float:
        row = self.equations.readings[name].F
        return sum(float(entry.subs(self.numbers)) * x[i] for i, entry in row.items())

    def _after(self, event: Event, y: np.ndarray, mode: Mapping[Hashable, float]) -> float:
        if event.kind == "stick":
            return 0.0
        if event.kind == "cross":
            return -mode[event.port]
        given = self.ports[event.port][0]
        return float(np.sign(y[len(self.equations.states) + self.equations.inputs.index(given)]))

    def _apart(
        self, event: Event, t: float, y: np.ndarray, rates: np.ndarray, grid: np.ndarray,
        mode: Mapping[Hashable, float],
    ) -> float:  # fmt: skip
        """What should be zero at an event over its rate."""
        n = len(self.equations.states)
        given, slip, level = self.ports[event.port]
        if event.kind != "slip":
            return self._received(slip, y[-1, :n]) / self._received(slip, rates[-1, :n])
        at = n + self.equations.inputs.index(given)
        margin = [self._level(level, t) - abs(y[k, at]) for k, t in ((-2, grid[-2]), (-1, t))]
        return margin[1] / ((margin[1] - margin[0]) / (grid[-1] - grid[-2]))

    def _level(self, level: sp.Expr, t: float) -> float:
        return float(level.subs({name: signal(t) for name, signal in self.signals.items()}))

    def _stretch(
        self, grid: np.ndarray, x: np.ndarray, mode: Mapping[Hashable, float]
    ) -> tuple[np.ndarray, np.ndarray]:
        residual = self._residual(mode)
        pieces = {name: signal.piece(grid[0]) for name, signal in self.signals.items()}

        def fill(t: float, y: np.ndarray, rates: np.ndarray, out: np.ndarray) -> None:
            out[:] = residual(*y, *rates, *(piece(t) for piece in pieces.values()))

        n, size = len(x), len(x) + len(self.equations.inputs)
        solver = IDA(
            fill, rtol=RTOL, atol=np.repeat([ATOL, UNTESTED], [n, size - n]), max_num_steps=100_000,
            algebraic_idx=list(range(n, size)), calc_initcond="yp0",
            calc_init_dt=1e-6 * (grid[-1] - grid[0]),
        )  # fmt: skip
        y, rates = np.concatenate([x, np.zeros(size - n)]), np.zeros(size)
        solver.init_step(grid[0], y, rates)
        found = [(y, rates)]
        for t in grid[1:]:
            step = solver.step(t, "normal", grid[-1])
            assert step.success, step.message
            found.append((step.y, step.yp))
        return tuple(np.array(part) for part in zip(*found, strict=True))

    def _residual(self, mode: Mapping[Hashable, float]) -> Residual:
        e, outside = self.equations, {sp.Symbol(name) for name in self.signals}
        given = {name: sp.Symbol(f"given {name}") for name in outside}
        rates = {name: sp.Symbol(f"{name}'") for name in (*e.states, *e.inputs)}
        dx, du = (sp.Matrix([rates[name] for name in names]) for names in (e.states, e.inputs))
        rows = list(e.A * dx - e.J * sp.Matrix(e.states) - e.B * sp.Matrix(e.inputs) - e.E * du)
        for port in e.ports:
            rows.append(self._closure(port, mode, rates, given))
        levels = {name: known for name, known in given.items() if name not in e.inputs}
        rows = [row.subs(self.numbers).subs(levels) for row in rows]
        arguments = [
            *e.states,
            *e.inputs,
            *rates.values(),
            *(given[sp.Symbol(n)] for n in self.signals),
        ]
        return sp.lambdify(arguments, rows, modules="math")

    def _closure(
        self, port: Any, mode: Mapping[Hashable, float], rates: Mapping[sp.Symbol, sp.Symbol],
        given: Mapping[sp.Symbol, sp.Symbol],
    ) -> sp.Expr:  # fmt: skip
        """What is zero by the law of one port, or by the signal that it gives."""
        name, law = port.given, self.laws.get(port.element.name)
        if law is None:
            return name - given[name]
        if not isinstance(law, bg.DryFriction):
            return name - self._shown(law, port.received)
        if mode[port.element.name]:
            return name - mode[port.element.name] * law.level
        row = self.equations.readings[port.received].F
        return sum(entry * rates[self.equations.states[i]] for i, entry in row.items())

    def _shown(self, law: object, name: sp.Symbol) -> sp.Expr:
        """A law with what its port receives written over states and inputs."""
        e, reading = self.equations, self.equations.readings[name]
        shown = sum(entry * e.states[i] for i, entry in reading.F.items())
        shown += sum(entry * e.inputs[j] for j, entry in reading.D.items())
        return bg.expression(law, "law").subs(name, shown)
