"""All bond equations of a graph at an instant, and their slopes in time: solved at once, none eliminated."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import networkx as nx
import numpy as np

from .jets import FUNCTIONS, Jet
from .looked import looked_in
from .written import Written, written

Array = np.ndarray
Moving = Callable[[float], tuple[float, float]]
"""An input: its value and its slope at a time."""

NOTHING = 1e-10
"""Singular values below, of rows of length 1, are none."""


@dataclass(frozen=True)
class Text:
    """A text that vanishes, the numbers of the unknowns in it, and inputs or the time that it reads."""

    code: Any
    names: tuple[str, ...]
    places: tuple[int, ...]
    outside: tuple[str, ...]


class Judge:
    """A graph with numbers for its parameters and its inputs as functions of time."""

    def __init__(
        self, graph: nx.DiGraph[str], parameters: Mapping[str, float], inputs: Mapping[str, Moving]
    ) -> None:
        self.written: Written = written(graph)
        self.inputs = {**inputs, "t": lambda t: (t, 1.0)}
        tables = {
            one.name: looked_in(
                one.method, one.outside, [np.array(a) for a in one.axes],
                np.array(one.values).reshape([len(a) for a in one.axes]),
            )
            for one in graph.graph.get("tables", ())
        }  # fmt: skip
        self.scope = {**FUNCTIONS, **tables, **parameters, "__builtins__": {}}
        self.texts = [self._text(text) for text in self.written.texts]
        self.size, self.held = self.written.size, len(self.written.held)
        self.sums = np.zeros((len(self.written.sums), self.size))
        for k, row in enumerate(self.written.sums):
            for at, factor in row.items():
                self.sums[k, at] = factor
        self.flows = np.array([self.written.held[k] for k in range(self.held)], dtype=int)

    def _text(self, text: str) -> Text:
        tree = ast.parse(text, mode="eval")
        used = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)} - {*self.scope}
        inside = sorted(used & {*self.written.names})
        outside = sorted(used - {*inside})
        assert all(name in self.inputs for name in outside), (text, outside)
        places = tuple(self.written.names[name] for name in inside)
        return Text(compile(tree, text, "eval"), tuple(inside), places, tuple(outside))

    def left(self, t: float, z: Array) -> Array:
        """What is left of every equation; of the texts first."""
        outside = {name: moving(t)[0] for name, moving in self.inputs.items()}
        found = []
        for one in self.texts:
            local = {name: float(z[k]) for name, k in zip(one.names, one.places, strict=True)}
            found.append(eval(one.code, self.scope, {**outside, **local}))
        return np.append(np.array(found, dtype=float), self.sums @ z)

    def jets(self, t: float, z: Array) -> list[tuple[Text, Jet]]:
        """Of each text the value and its slopes along what it reads."""
        found = []
        for one in self.texts:
            n = len(one.names) + len(one.outside)
            values = [float(z[k]) for k in one.places]
            values += [self.inputs[name](t)[0] for name in one.outside]
            unit = np.eye(n)
            local = {
                name: Jet(v, unit[k], np.zeros((n, n)))
                for k, (name, v) in enumerate(zip((*one.names, *one.outside), values, strict=True))
            }
            jet = eval(one.code, self.scope, local)
            found.append((one, jet))
        return found

    def slopes(self, t: float, z: Array) -> Array:
        """Of every equation along every unknown."""
        J = np.zeros((len(self.texts), self.size))
        for k, (one, jet) in enumerate(self.jets(t, z)):
            np.add.at(J[k], list(one.places), jet.g[: len(one.places)])
        return np.vstack([J, self.sums])

    def moving(self, t: float, z: Array, dz: Array) -> tuple[Array, Array]:
        """All equations and their slopes in time, and the slopes of both along unknowns and their rates.

        Columns: the unknowns, then the rates of efforts and flows; rates of what is held are unknowns.
        """
        rows = len(self.texts) + len(self.sums)
        left, slopes = np.zeros(2 * rows), np.zeros((2 * rows, 2 * self.size - self.held))
        for k, (one, jet) in enumerate(self.jets(t, z)):
            count, at = len(one.places), list(one.places)
            rates = np.append(dz[at], [self.inputs[name](t)[1] for name in one.outside])
            left[k], left[rows + k] = jet.v, jet.g @ rates
            np.add.at(slopes[k], at, jet.g[:count])
            np.add.at(slopes[rows + k], at, (jet.H @ rates)[:count])
            for j, g in zip(at, jet.g[:count], strict=True):
                where = self.flows[j] if j < self.held else self.size + j - self.held
                slopes[rows + k, where] += g
        begin = len(self.texts)
        left[begin:rows], left[rows + begin :] = self.sums @ z, self.sums @ dz
        slopes[begin:rows, : self.size] = self.sums
        slopes[rows + begin :, self.size :] = self.sums[:, self.held :]
        return left, slopes

    def rates(self, z: Array, free: Array) -> Array:
        """The rates of all unknowns: of what is held by what flows in."""
        return np.append(z[self.flows], free)


@dataclass(frozen=True)
class Instant:
    """All unknowns and their rates where all equations hold, and which of both follow from the states.

    ``left``: the most that is left of an equation, over one and the sizes of its terms.
    """

    z: Array
    rates: Array
    told: Array
    told_rates: Array
    left: float


def solved(
    judge: Judge, t: float, states: Mapping[int, float], z: Array, turns: int = 12
) -> Instant:
    """The instant with these unknowns given, by number, from ``z`` on.

    First the unknowns alone, then their rates, in which all is linear, then both at once.
    """
    pins = sorted(states)
    n = 2 * judge.size - judge.held
    pinned = np.zeros((len(pins), n))
    pinned[np.arange(len(pins)), pins] = 1.0
    right = np.array([states[k] for k in pins])
    z = _still(judge, t, z, pinned[:, : judge.size], right, turns)
    x = np.append(z, np.zeros(judge.size - judge.held))
    left, slopes = _whole(judge, t, x, pinned, right)
    x[judge.size :] = np.linalg.lstsq(slopes[:, judge.size :], -left, rcond=NOTHING)[0]
    for _ in range(turns):
        left, slopes = _whole(judge, t, x, pinned, right)
        change = np.linalg.lstsq(slopes, -left, rcond=NOTHING)[0]
        x = x + change
        if np.abs(change).max() <= 1e-13 * (1 + np.abs(x).max()):
            break
    left, slopes = _whole(judge, t, x, pinned, right)
    # Rows are of length one: what their terms come to is what rounding goes with.
    left = left / (1.0 + np.abs(slopes) @ np.abs(x))
    sized = slopes * (1.0 + np.abs(x))
    _, values, right_vectors = np.linalg.svd(sized / np.linalg.norm(sized, axis=1)[:, None])
    rank = int((values > NOTHING * values[0]).sum())
    loose = np.abs(right_vectors[rank:]).max(axis=0, initial=0.0) > 1e-6
    z, free = x[: judge.size], x[judge.size :]
    return Instant(
        z, judge.rates(z, free), ~loose[: judge.size],
        ~np.append(loose[judge.flows], loose[judge.size :]), float(np.abs(left).max()),
    )  # fmt: skip


def _still(judge: Judge, t: float, z: Array, pinned: Array, right: Array, turns: int) -> Array:
    """Unknowns at which all equations hold, whatever their rates."""
    for _ in range(turns):
        left = np.append(judge.left(t, z), pinned @ z - right)
        slopes = np.vstack([judge.slopes(t, z), pinned])
        change = np.linalg.lstsq(slopes, -left, rcond=NOTHING)[0]
        z = z + change
        if np.abs(change).max() <= 1e-13 * (1 + np.abs(z).max()):
            break
    return z


def _whole(judge: Judge, t: float, x: Array, pinned: Array, right: Array) -> tuple[Array, Array]:
    """Equations and pins, each row divided by its length."""
    z = x[: judge.size]
    left, slopes = judge.moving(t, z, judge.rates(z, x[judge.size :]))
    slopes, left = np.vstack([slopes, pinned]), np.append(left, pinned @ x - right)
    length = np.linalg.norm(slopes, axis=1)
    length[length == 0] = 1.0
    return left / length, slopes / length[:, None]


def singular(judge: Judge, t: float, points: Sequence[Array], frequencies: Sequence[float]) -> bool:
    """Whether the pencil of all equations and of what is held is singular at all these points."""
    for z in points:
        F = judge.slopes(t, z)
        for s in frequencies:
            hold = np.zeros((judge.held, judge.size))
            hold[np.arange(judge.held), np.arange(judge.held)] = s
            hold[np.arange(judge.held), judge.flows] -= 1.0
            both = np.vstack([F, hold])
            both = both / np.linalg.norm(both, axis=1)[:, None]
            if np.linalg.cond(both) < 1e11:
                return False
    return True
