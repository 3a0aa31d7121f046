"""Random networks in which no port stays undetermined for ever."""

from __future__ import annotations

from dataclasses import replace

import networkx as nx
import numpy as np

from references.switched.network import PORTS, Branch, Network, Wave

SPAN = 3.0
"""Commands and steps fall within it."""


def random_network(rng: np.random.Generator, ideal: bool) -> Network:
    """A tree of branches with a source at every node and one to three diodes."""
    n = int(rng.integers(2, 5))
    made: list[Branch] = []

    def add(kind: str, tail: int, head: int, least: float, most: float, more: float = 0.0) -> None:
        value = round(float(rng.uniform(least, most)), 3)
        made.append(Branch(kind, f"{kind}{len(made)}", tail, head, value, more))

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
        turns, phase = _number(rng, 0.3, 1.0), _number(rng, 0, 6)
        more, size = _number(rng, 0.5, 4.0), _number(rng, 2.0, 6.0)
        wave = Wave(amplitude=size, frequency=turns, phase=phase)
        made.append(Branch("S", f"S{len(made)}", 0, k, more=more, wave=wave))
        if rng.random() < 0.5:
            add(str(rng.choice(["C", "C", "L"])), k, 0, 0.2, 1.0)
    return Network(n, tuple(made))


def random_switched(
    rng: np.random.Generator, ports: int | None = None, kinds: str = "DKF"
) -> Network:
    """One to eight ports of some kinds, mixed, on a tree of branches, with meshes of what stores and resists.

    A source behind a resistance at every node: nothing is cut off, or at rest for ever. Ports and ideal
    sources are on branches of one tree: they close no loop, and what they hold is not shared. Some stand in
    series with a coil of their own, some frictions with another of a different level.
    """
    return _Drawing(rng, ports or int(rng.integers(1, 9)), kinds).network()


def random_mixed(rng: np.random.Generator) -> Network:
    """The same, charged at first, some of whose switches are turned by a voltage or a current instead.

    Charges and currents are such that no source or other charge is against them: each node has a potential.
    """
    network = random_switched(rng)
    stored = network.of("C", "L")
    potentials = {k: _number(rng, -1, 1) for k in range(1, network.nodes + 1)} | {0: 0.0}
    for b in network.of("V"):
        potentials[b.head] = b.wave.level(0.0) + b.wave.amplitude * float(np.sin(b.wave.phase))

    def changed(b: Branch) -> Branch:
        if b.kind == "C":
            return replace(b, start=potentials[b.tail] - potentials[b.head])
        if b.kind != "K" or not stored or rng.random() < 0.6:
            return b
        watched = stored[int(rng.integers(len(stored)))]
        level, sense = _number(rng, -0.5, 0.8), int(rng.choice([-1, 1]))
        off = round(level - _number(rng, 0.1, 0.6), 3)
        return Branch(
            "G", b.name, b.tail, b.head, level, watched=watched.name, off=off, sense=sense
        )

    return replace(network, branches=tuple(changed(b) for b in network.branches))


class _Drawing:
    """A network on the way."""

    def __init__(self, rng: np.random.Generator, ports: int, kinds: str) -> None:
        self._rng, self._ports, self._kinds = rng, ports, kinds
        self._n = ports + int(rng.integers(ports == 1, 3))
        self._made: list[Branch] = []
        self._rigid: nx.Graph[int] = nx.Graph()
        self._last = self._n

    def network(self) -> Network:
        """What was drawn."""
        rng, n = self._rng, self._n
        chosen = set(rng.choice(n, size=self._ports, replace=False).tolist())
        for k in range(1, n + 1):
            pair = (int(rng.integers(1, k)) if k > 1 else 0, k)
            pair = pair if rng.random() < 0.5 else pair[::-1]
            if k - 1 not in chosen or sum(b.kind in PORTS for b in self._made) >= self._ports:
                self._passive("RLC", *pair)
            elif rng.random() < 0.8:
                self._port(*pair)
            else:
                # To the ground, through which alone parts would share nothing.
                self._port(*((0, k) if rng.random() < 0.5 else (k, 0)))
                self._passive("RLC", *pair)
        for k in range(1, n + 1):
            self._drive(k)
            if rng.random() < 0.55:
                self._passive("CCCL", k, 0)
        for _ in range(int(rng.integers(0, n))):
            tail, head = (rng.choice(n, size=2, replace=False) + 1).tolist() if n > 1 else (1, 0)
            self._passive("RRRCL", tail, head)
        return Network(self._last, tuple(self._made))

    def _add(self, kind: str, tail: int, head: int, value: float = 0.0, **more: object) -> None:
        name = f"{kind}{len(self._made)}"
        self._made.append(Branch(kind, name, tail, head, value, **more))  # type: ignore[arg-type]

    def _passive(self, kinds: str, tail: int, head: int) -> None:
        self._add(str(self._rng.choice(list(kinds))), tail, head, _number(self._rng, 0.2, 2.0))

    def _inner(self) -> int:
        self._last += 1
        return self._last

    def _port(self, tail: int, head: int) -> None:
        rng, kind = self._rng, str(self._rng.choice(list(self._kinds)))
        self._rigid.add_edge(tail, head)
        if rng.random() < 0.2:
            inner = self._inner()
            self._passive("L", tail, inner)
            tail = inner
        if kind == "D":
            self._add("D", tail, head, more=_number(rng, 0.05, 0.3) * (rng.random() < 0.3))
        elif kind == "K":
            instants = sorted(
                {_number(rng, 0.05, SPAN - 0.05) for _ in range(int(rng.integers(1, 5)))}
            )
            self._add("K", tail, head, on=bool(rng.random() < 0.5), instants=tuple(instants))
        else:
            level = _number(rng, 0.2, 2.0)
            if rng.random() < 0.15 and sum(b.kind in PORTS for b in self._made) < self._ports - 1:
                inner = self._inner()
                self._add("F", tail, inner, round(level * float(rng.choice([0.7, 1.4])), 3))
                tail = inner
            self._add("F", tail, head, level)

    def _drive(self, k: int) -> None:
        rng = self._rng
        sine = Wave(_number(rng, -2, 2) * (rng.random() < 0.3), (), *self._sine(2.0, 6.0))
        looped = k in self._rigid and 0 in self._rigid and nx.has_path(self._rigid, k, 0)
        if rng.random() < 0.08 and not looped:
            self._rigid.add_edge(k, 0)
            self._add("V", 0, k, wave=sine)
            return
        wave = Wave(sine.constant, self._steps(4.0), sine.amplitude, sine.frequency, sine.phase)
        self._add("S", 0, k, more=_number(rng, 0.5, 4.0), wave=wave)
        if rng.random() < 0.1:
            push = Wave(_number(rng, -1, 1), self._steps(1.0), *self._sine(0.3, 1.0))
            self._add("I", 0, k, wave=push)

    def _sine(self, least: float, most: float) -> tuple[float, float, float]:
        rng = self._rng
        return _number(rng, least, most), _number(rng, 0.3, 1.0), _number(rng, 0, 6)

    def _steps(self, size: float) -> tuple[tuple[float, float], ...]:
        rng = self._rng
        if rng.random() < 0.7:
            return ()
        return ((_number(rng, 0.1, SPAN - 0.1), _number(rng, -size, size)),)


def _number(rng: np.random.Generator, least: float, most: float) -> float:
    return round(float(rng.uniform(least, most)), 3)
