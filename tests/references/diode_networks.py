"""Networks with diodes, and their currents and voltages without the toolkit.

Kirchhoff's laws in one mode of the diodes are ``E y' = A y`` for ``y`` = node voltages, currents of coils,
currents of diodes, and a rotating pair for each source. The limits of Wong's sequences give the consistent
subspace of the pencil and the projector along its impulses; matrix exponentials lead from event to event;
of all modes that one begins whose impulses, values and derivatives have the right signs (linear
complementarity, by enumeration).

Assumed: ideal switches, on while current flows their way, off while voltage lies against it; constant values;
sources are sines behind resistances; charges and currents are zero at first; no two diodes are at rest for
ever, so that one mode begins at each event. Networks and numbers in, voltages, currents and events out:
nothing of a bond graph is here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import product

import numpy as np
import scipy.linalg
from numpy.typing import NDArray
from scipy.optimize import brentq

Array = NDArray[np.float64]
Mode = tuple[bool, ...]
SMALL = 1e-9


@dataclass(frozen=True)
class Branch:
    """One element from node to node; node 0 is the ground. ``more``: a series resistance."""

    kind: str
    name: str
    tail: int
    head: int
    value: float = 0.0
    more: float = 0.0
    frequency: float = 0.0
    phase: float = 0.0


@dataclass(frozen=True)
class Network:
    """Nodes 1 to ``nodes`` and the branches between them."""

    nodes: int
    branches: tuple[Branch, ...]

    def of(self, kind: str) -> list[Branch]:
        """The branches of one kind: C, L, R, D or S, a sine source with a resistance."""
        return [branch for branch in self.branches if branch.kind == kind]


def random_network(rng: np.random.Generator, ideal: bool) -> Network:
    """A tree of branches with a source at every node and one to three diodes."""
    n = int(rng.integers(2, 5))
    made: list[Branch] = []

    def add(kind: str, tail: int, head: int, least: float, most: float, **more: float) -> None:
        value = round(float(rng.uniform(least, most)), 3)
        made.append(Branch(kind, f"{kind}{len(made)}", tail, head, value, **more))

    # Not through the ground alone: there parts would share nothing.
    pairs = [(int(rng.integers(1, k)) if k > 1 else 0, k) for k in range(1, n + 1)]
    diodes = set(rng.choice(n, size=int(rng.integers(1, min(n, 3) + 1)), replace=False).tolist())
    for at, pair in enumerate(pairs):
        pair = pair if rng.random() < 0.5 else pair[::-1]
        if at in diodes:
            series = 0.0 if ideal else round(float(rng.uniform(0.05, 0.3)), 3)
            add("D", *pair, 0, 0, more=series)
        else:
            kind = str(rng.choice(["R", "L", "C"]))
            add(kind, *pair, 0.2, 2.0)
    for k in range(1, n + 1):
        # A source at every node, so that no diode is at rest for ever and its mode a matter of rounding.
        turns, phase = round(float(rng.uniform(0.3, 1.0)), 3), round(float(rng.uniform(0, 6)), 3)
        add(
            "S",
            0,
            k,
            2.0,
            6.0,
            more=round(float(rng.uniform(0.5, 4.0)), 3),
            frequency=turns,
            phase=phase,
        )
        if rng.random() < 0.5:
            add(str(rng.choice(["C", "C", "L"])), k, 0, 0.2, 1.0)
    return Network(n, tuple(made))


@dataclass(frozen=True)
class _Motion:
    """One mode: ``y = Q c``, ``c' = M c``, the projector onto Q and the impulses of a jump."""

    Q: Array
    M: Array
    onto: Array
    impulse: Array


class Oracle:
    """A network's solution from zero charge and current."""

    def __init__(self, network: Network) -> None:
        self._network = network
        n = network.nodes
        self._coils = {b.name: n + k for k, b in enumerate(network.of("L"))}
        at = n + len(self._coils)
        self._diodes = {b.name: at + k for k, b in enumerate(network.of("D"))}
        at += len(self._diodes)
        self._waves = {b.name: at + 2 * k for k, b in enumerate(network.of("S"))}
        self.size = at + 2 * len(self._waves)
        self.motion = cache(self._motion)

    def run(self, times: Array) -> tuple[dict[str, Array], list[tuple[float, str, str]]]:
        """Voltages of capacitors and currents of coils at the times, and the diodes' events."""
        y = np.zeros(self.size)
        for b in self._network.of("S"):
            k = self._waves[b.name]
            y[k : k + 2] = b.value * np.sin(b.phase), b.value * np.cos(b.phase)
        t, end, rows, events = float(times[0]), float(times[-1]), [], []
        mode, y = self._begin(y)
        step = (end - t) / 6000
        while True:
            stop, y_stop = self._leave(mode, t, y, end, step)
            motion = self.motion(mode)
            assert motion is not None
            c = np.linalg.lstsq(motion.Q, y, rcond=None)[0]
            inside = times[(times >= t) & ((times < stop) | (stop >= end))]
            rows += [motion.Q @ scipy.linalg.expm(motion.M * (s - t)) @ c for s in inside]
            if stop >= end:
                break
            new, y = self._begin(y_stop)
            names = list(self._diodes)
            events += [
                (stop, names[k], "on" if new[k] else "off")
                for k in range(len(names))
                if new[k] != mode[k]
            ]
            t, mode = stop, new
            if len(events) > 400:
                raise RuntimeError("the oracle makes no progress")
        return self._columns(np.array(rows)), events

    def _columns(self, table: Array) -> dict[str, Array]:
        volts = np.hstack([np.zeros((len(table), 1)), table[:, : self._network.nodes]])
        found = {f"u_{b.name}": volts[:, b.tail] - volts[:, b.head] for b in self._network.of("C")}
        return found | {f"i_{name}": table[:, k] for name, k in self._coils.items()}

    def _leave(
        self, mode: Mode, t: float, y: Array, end: float, step: float
    ) -> tuple[float, Array]:
        """The first time at which a diode leaves its mode, or the end."""
        motion = self.motion(mode)
        assert motion is not None
        watch = self._signs(mode) @ motion.Q
        c: Array = np.asarray(np.linalg.lstsq(motion.Q, y, rcond=None)[0], dtype=float)
        forward = scipy.linalg.expm(motion.M * step)
        while t < end:
            after = forward @ c
            for row in watch[(watch @ after < 0)]:
                if row @ c <= 0 and row @ motion.M @ c >= 0:
                    continue  # it has only begun to rise
                left = _root(row, motion.M, c, step)
                if t + left >= end:
                    continue
                later = scipy.linalg.expm(motion.M * left) @ c
                first = [_root(r, motion.M, c, left) for r in watch if r @ later < 0 and r @ c > 0]
                left = min([left, *first])
                return t + left, motion.Q @ scipy.linalg.expm(motion.M * left) @ c
            t, c = t + step, after
        return end, motion.Q @ c

    def _signs(self, mode: Mode) -> Array:
        """Rows that stay positive: the currents of diodes that are on, the reverse voltages of others."""
        rows = np.zeros((len(mode), self.size))
        for k, b in enumerate(self._network.of("D")):
            if mode[k]:
                rows[k, self._diodes[b.name]] = 1.0
            else:
                self._across(rows[k], b, -1.0)
        return rows

    def _across(self, row: Array, b: Branch, sign: float = 1.0) -> None:
        for node, way in ((b.tail, sign), (b.head, -sign)):
            if node:
                row[node - 1] += way

    def _begin(self, y: Array) -> tuple[Mode, Array]:
        """The mode whose impulses, values and derivatives have the right signs, and its y."""
        for mode in product((False, True), repeat=len(self._diodes)):
            motion = self.motion(mode)
            if motion is None:
                continue
            start, signs = motion.onto @ y, self._signs(mode)
            chain = [signs @ motion.impulse @ y]
            c = np.linalg.lstsq(motion.Q, start, rcond=None)[0]
            for _ in range(5):
                chain.append(signs @ motion.Q @ c)
                c = motion.M @ c
            if all(_starts_positive([values[k] for values in chain]) for k in range(len(mode))):
                return mode, start
        raise RuntimeError("no mode of the diodes is consistent")

    def _motion(self, mode: Mode) -> _Motion | None:
        E, A = self._pencil(mode)
        Q, W = np.eye(self.size), np.zeros((self.size, 0))
        for _ in range(self.size):
            Q = _kernel(_away(E @ Q) @ A)
            W = _kernel(_away(A @ W) @ E)
        both = np.hstack([Q, W])
        if both.shape[1] != self.size or np.linalg.cond(both) > 1e10:
            return None
        parts = np.linalg.inv(both)
        onto = Q @ parts[: Q.shape[1]]
        M: Array = np.asarray(np.linalg.lstsq(E @ Q, A @ Q, rcond=None)[0], dtype=float)
        impulse = W @ np.linalg.lstsq(A @ W, E @ (onto - np.eye(self.size)), rcond=None)[0]
        return _Motion(Q, M, onto, impulse)

    def _pencil(self, mode: Mode) -> tuple[Array, Array]:
        """Currents that leave each node sum to zero; coils, diodes and waves have a row of their own."""
        E, A = np.zeros((self.size, self.size)), np.zeros((self.size, self.size))
        on = dict(zip(self._diodes, mode, strict=True))
        for b in self._network.branches:
            current_E, current_A = np.zeros(self.size), np.zeros(self.size)
            if b.kind == "C":
                self._across(current_E, b, b.value)
            elif b.kind == "R":
                self._across(current_A, b, 1 / b.value)
            elif b.kind == "S":
                k, w = self._waves[b.name], 2 * np.pi * b.frequency
                self._across(current_A, b, 1 / b.more)
                current_A[k] = 1 / b.more
                E[[k, k + 1], [k, k + 1]] = 1.0
                A[k, k + 1], A[k + 1, k] = w, -w
            elif b.kind == "L":
                k = self._coils[b.name]
                current_A[k], E[k, k] = 1.0, b.value
                self._across(A[k], b)
            else:
                k = self._diodes[b.name]
                current_A[k] = 1.0
                A[k, k] = -b.more if on[b.name] else 1.0
                if on[b.name]:
                    self._across(A[k], b)
            for node, way in ((b.tail, 1.0), (b.head, -1.0)):
                if node:
                    E[node - 1] += way * current_E
                    A[node - 1] -= way * current_A
        return E, A


def _root(row: Array, M: Array, c: Array, step: float) -> float:
    """Where a trigger falls through zero within a step."""

    def value(s: float) -> float:
        return float(row @ scipy.linalg.expm(M * s) @ c)

    begin = 0.0 if value(0.0) > 0 else 1e-3 * step
    if value(begin) <= 0 or value(step) >= 0:
        return begin if value(begin) <= 0 else step
    return float(brentq(value, begin, step, xtol=1e-15))


def _starts_positive(chain: Sequence[float]) -> bool:
    """Whether the first of impulse, value and derivatives that is not zero is positive."""
    first = next((value for value in chain if abs(value) > SMALL), 0.0)
    return first >= 0


def _kernel(matrix: Array) -> Array:
    return np.asarray(scipy.linalg.null_space(matrix, rcond=1e-11))


def _away(columns: Array) -> Array:
    """Rows that vanish on the span of the columns."""
    return _kernel(columns.T).T
