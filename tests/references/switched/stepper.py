"""Networks that switch by implicit Euler steps and Lemke's algorithm: no events, no modes, first order.

It confirms the judge, with which it shares the networks alone. Where nothing else ties a node down, a leak
does.
"""

from __future__ import annotations

import contextlib
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from references.switched.network import Branch, Network, Wave

Array = NDArray[np.float64]
LEAK = 1e-6


def lemke(M: Array, q: Array) -> Array:
    """z >= 0 with ``w = M z + q >= 0`` and ``w z = 0`` (Cottle, Pang, Stone 1992, algorithm 4.4.5)."""
    n = len(q)
    if n == 0 or q.min() >= 0:
        return np.zeros(n)
    # Columns: w, z, the artificial one, the right side.
    table = np.hstack([np.eye(n), -M, -np.ones((n, 1)), q[:, None]])
    basis = list(range(n))
    entering, row = 2 * n, int(q.argmin())
    for _ in range(60 * n):
        left = basis[row]
        table[row] /= table[row, entering]
        others = table[:, entering].copy()
        others[row] = 0.0
        table -= others[:, None] * table[row]
        basis[row] = entering
        if left == 2 * n:
            z = np.zeros(2 * n + 1)
            z[basis] = table[:, -1]
            return z[n : 2 * n]
        entering = left + n if left < n else left - n
        column = table[:, entering]
        if not (column > 1e-13).any():
            raise ArithmeticError("a ray: the step has no solution")
        ratios = np.full(n, np.inf)
        ratios[column > 1e-13] = table[column > 1e-13, -1] / column[column > 1e-13]
        least = np.flatnonzero(ratios <= ratios.min() + 1e-13)
        # The artificial variable leaves where it may.
        row = next((int(k) for k in least if basis[k] == 2 * n), int(least[0]))
    raise ArithmeticError("Lemke's algorithm goes round")


@dataclass(frozen=True)
class _Step:
    """One step's matrices for one position of the switches.

    ``open``: the nodes' voltages with no current in ports, by what is stored and what waves are;
    ``lift``: by how much a port's current lowers them; ``M``, ``shift``: of the problem in `_problem`.
    """

    open: Array
    lift: Array
    M: Array
    shift: Array


class Stepper:
    """A network in steps of equal length."""

    def __init__(self, network: Network, h: float) -> None:
        self._network, self._h = network, h
        self._stored, self._driven = network.of("C", "L"), network.of("S", "I", "V")
        ports = network.of("D", "F")
        self._more = np.array([b.more for b in ports])
        self._level = np.array([b.value if b.kind == "F" else 0.0 for b in ports])
        self._rubs = [k for k, b in enumerate(ports) if b.kind == "F"]
        self._ways = np.array([self._way(b) for b in ports]).reshape(-1, network.nodes)
        self._made: dict[tuple[bool, ...], _Step] = {}

    def run(self, steps: int) -> dict[str, Array]:
        """Voltages of capacitors and currents of coils after each step, from the first on."""
        h, stored = self._h, self._stored
        times: Array = h * np.arange(1, steps + 1, dtype=float)
        across = np.array([self._way(b) for b in stored]).reshape(-1, self._network.nodes)
        coil = np.array([float(b.kind == "L") for b in stored])
        gain = np.array([h / b.value if b.kind == "L" else 1.0 for b in stored])
        z = np.zeros(len(self._level) + len(self._rubs))
        kept = np.empty((steps + 1, len(stored)))
        kept[0] = [b.start for b in stored]
        waves = np.array([self._values(b.wave, times) for b in self._driven]).reshape(-1, steps).T
        for k, t in enumerate(times):
            step = self._step(float(t) - h / 2)
            v = step.open @ np.concatenate((kept[k], waves[k]))
            z = self._solved(step.M, self._problem(step, v), z)
            v -= step.lift @ (z[: len(self._level)] - self._level)
            kept[k + 1] = coil * kept[k] + gain * (across @ v)
        names = [("u_" if b.kind == "C" else "i_") + b.name for b in stored]
        return dict(zip(names, kept[1:].T, strict=True))

    def _values(self, wave: Wave, times: Array) -> Array:
        """Within a step, neither at its begin nor at its end, is what commands and levels are of it."""
        lines = np.array([wave.level(t - self._h / 2) for t in times])
        angle = 2 * np.pi * wave.frequency * times + wave.phase
        return np.asarray(lines + wave.amplitude * np.sin(angle))

    def _problem(self, step: _Step, v: Array) -> Array:
        """Of the ports: a diode's is not negative, nor the voltage against it; friction's has a limit.

        With m = j + level and slips s forward and r backward: r = s - u, p = 2 level - m.
        """
        return np.concatenate((-(self._ways @ v) - step.shift, 2 * self._level[self._rubs]))

    @staticmethod
    def _solved(M: Array, q: Array, last: Array) -> Array:
        """What was positive in the last step, if that is a solution of this one; else Lemke's."""
        held = np.flatnonzero(last > 0)
        z = np.zeros(len(q))
        with contextlib.suppress(np.linalg.LinAlgError):
            z[held] = np.linalg.solve(M[np.ix_(held, held)], -q[held])
            w = M @ z + q
            w[held] = 0.0
            if (z >= 0).all() and (w >= 0).all():
                return z
        return lemke(M, q)

    def _step(self, t: float) -> _Step:
        positions = tuple(b.commanded(t) for b in self._network.of("K"))
        if positions not in self._made:
            self._made[positions] = self._make(t)
        return self._made[positions]

    def _make(self, t: float) -> _Step:
        network, h, n = self._network, self._h, self._network.nodes
        forced = [b for b in network.of("V", "K") if b.kind == "V" or b.commanded(t)]
        K = np.zeros((n + len(forced), n + len(forced)))
        K[:n, :n] += LEAK * np.eye(n)
        for b in network.branches:
            way = self._way(b)
            leads = {"C": b.value / h, "L": h / (b.value or 1), "R": 1 / (b.value or 1)}
            lead = 1 / b.more if b.kind == "S" else leads.get(b.kind, 0.0)
            K[:n, :n] += lead * np.outer(way, way)
        for at, b in enumerate(forced):
            K[:n, n + at] = K[n + at, :n] = self._way(b)
        inverse: Array = np.asarray(np.linalg.inv(K), dtype=float)[:n]
        lift = inverse[:, :n] @ self._ways.T
        count, size = len(self._level), len(self._level) + len(self._rubs)
        M = np.zeros((size, size))
        M[:count, :count] = self._ways @ lift + np.diag(self._more)
        for at, k in enumerate(self._rubs, count):
            M[k, at], M[at, k] = 1.0, -1.0
        return _Step(inverse @ self._right(forced), lift, M, M[:count, :count] @ self._level)

    def _right(self, forced: list[Branch]) -> Array:
        """A column for each storage and each wave: what it drives into nodes, what it forces."""
        n, columns = self._network.nodes, self._stored + self._driven
        right = np.zeros((n + len(forced), len(columns)))
        for at, b in enumerate(columns):
            if b.kind == "V":
                right[n + forced.index(b), at] = -1.0
            else:
                lead = {"C": b.value / self._h, "S": -1 / (b.more or 1)}.get(b.kind, -1.0)
                right[:n, at] = lead * self._way(b)
        return right

    def _way(self, b: Branch) -> Array:
        way = np.zeros(self._network.nodes)
        for node, sign in ((b.tail, 1.0), (b.head, -1.0)):
            if node:
                way[node - 1] += sign
        return way
