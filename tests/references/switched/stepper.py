"""Networks that switch by implicit Euler steps and Lemke's algorithm: no events, no modes, first order.

It confirms the judge, with which it shares the networks alone. Where nothing else ties a node down, a leak
does.
"""

from __future__ import annotations

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
        others = np.arange(n) != row
        table[others] -= np.outer(table[others, entering], table[row])
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
    """One step's matrix for one position of the switches: nodes and forced branches; ports."""

    inverse: Array
    lift: Array
    M: Array


class Stepper:
    """A network in steps of equal length."""

    def __init__(self, network: Network, h: float) -> None:
        self._network, self._h = network, h
        self._ways = {b.name: self._way(b) for b in network.branches}
        self._ports = network.of("D", "F")
        self._made: dict[tuple[bool, ...], _Step] = {}

    def run(self, steps: int) -> dict[str, Array]:
        """Voltages of capacitors and currents of coils after each step, from the first on."""
        network, h = self._network, self._h
        times: Array = h * np.arange(1, steps + 1, dtype=float)
        waves = {b.name: self._values(b.wave, times) for b in network.of("S", "V", "I")}
        stored = {b.name: b.start for b in network.of("C", "L")}
        kept = {name: np.empty(steps) for name in stored}
        for k, t in enumerate(times):
            v = self._step(
                float(t) - h / 2, stored, {name: wave[k] for name, wave in waves.items()}
            )
            for b in network.of("C", "L"):
                across = float(self._ways[b.name] @ v)
                new = across if b.kind == "C" else stored[b.name] + h / b.value * across
                kept[b.name][k] = stored[b.name] = new
        names = {b.name: ("u_" if b.kind == "C" else "i_") + b.name for b in network.of("C", "L")}
        return {names[name]: values for name, values in kept.items()}

    def _values(self, wave: Wave, times: Array) -> Array:
        """Within a step, neither at its begin nor at its end, is what commands and levels are of it."""
        lines = np.array([wave.level(t - self._h / 2) for t in times])
        angle = 2 * np.pi * wave.frequency * times + wave.phase
        return np.asarray(lines + wave.amplitude * np.sin(angle))

    def _step(self, t: float, stored: dict[str, float], wave: dict[str, float]) -> Array:
        """The voltages of the nodes after a step."""
        network, h, n = self._network, self._h, self._network.nodes
        forced = self._forced(t)
        right = np.zeros(n + len(forced))
        for b in network.branches:
            way = self._ways[b.name]
            if b.kind == "C":
                right[:n] += way * b.value / h * stored[b.name]
            elif b.kind == "L":
                right[:n] -= way * stored[b.name]
            elif b.kind == "S":
                right[:n] -= way * wave[b.name] / b.more
            elif b.kind == "I":
                right[:n] -= way * wave[b.name]
        right[n:] = [-wave.get(b.name, 0.0) for b in forced]
        step = self._made.get(self._positions(t)) or self._make(t, forced)
        open_ = step.inverse @ right
        return (open_ - step.lift @ self._currents(step, open_[:n]))[:n]

    def _currents(self, step: _Step, v: Array) -> Array:
        """Of the ports: a diode's is not negative, nor the voltage against it; friction's has a limit.

        With m = j + level and slips s forward and r backward: r = s - u, p = 2 level - m.
        """
        count, ports = len(self._ports), self._ports
        rubs = [k for k, b in enumerate(ports) if b.kind == "F"]
        size = count + len(rubs)
        level = np.array([b.value if b.kind == "F" else 0.0 for b in ports])
        u = np.array([self._ways[b.name] @ v for b in ports])
        M, q = np.zeros((size, size)), np.zeros(size)
        M[:count, :count] = step.M
        q[:count] = -u - step.M @ level
        for at, k in enumerate(rubs):
            M[k, count + at], M[count + at, k] = 1.0, -1.0
            q[count + at] = 2 * level[k]
        return np.asarray(lemke(M, q)[:count] - level)

    def _make(self, t: float, forced: list[Branch]) -> _Step:
        network, h, n = self._network, self._h, self._network.nodes
        K = np.zeros((n + len(forced), n + len(forced)))
        K[:n, :n] += LEAK * np.eye(n)
        for b in network.branches:
            way = self._ways[b.name]
            leads = {"C": b.value / h, "L": h / (b.value or 1), "R": 1 / (b.value or 1)}
            lead = 1 / b.more if b.kind == "S" else leads.get(b.kind, 0.0)
            K[:n, :n] += lead * np.outer(way, way)
        for at, b in enumerate(forced):
            K[:n, n + at] = K[n + at, :n] = self._ways[b.name]
        inverse: Array = np.asarray(np.linalg.inv(K), dtype=float)
        ways = np.array([self._ways[b.name] for b in self._ports]).reshape(-1, n).T
        lift = inverse[:, :n] @ ways
        M = ways.T @ lift[:n] + np.diag([b.more for b in self._ports])
        made = self._made[self._positions(t)] = _Step(inverse, lift, M)
        return made

    def _forced(self, t: float) -> list[Branch]:
        return [b for b in self._network.of("V", "K") if b.kind == "V" or b.commanded(t)]

    def _positions(self, t: float) -> tuple[bool, ...]:
        return tuple(b.commanded(t) for b in self._network.of("K"))

    def _way(self, b: Branch) -> Array:
        way = np.zeros(self._network.nodes)
        for node, sign in ((b.tail, 1.0), (b.head, -1.0)):
            if node:
                way[node - 1] += sign
        return way
