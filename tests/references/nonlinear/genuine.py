"""Whether a refusal is one of physics, or a limit that the page of limits names."""

from __future__ import annotations

import random
import re
from pathlib import Path

import numpy as np

from .drawn import Drawn
from .judge import Judge, Text, singular
from .told import judged

Array = np.ndarray
PAGE = Path(__file__).parents[3] / "docs" / "limits.md"

LIMITS = {
    r"a value depends on \w+, which depends on that value at once": "follows from that value at once",
    r"the law at '.*' drives a dependent storage": "does not close a port that drives a dependent storage",
    r"a value depends on \w+, which a law gives": "A value whose rate counts",
    r"a value depends on \w+, which shows what": "A value whose rate counts",
    r"has derivative causality and follows the time itself": "that follows a source of the time alone",
}
"""Refusals, and the words of the page that name each."""


class Constant:
    """An input that does not move."""

    def __init__(self, value: float) -> None:
        self.value = value

    def __call__(self, t: float) -> float:
        return self.value

    def piece(self, t: float) -> Constant:
        return self

    def derivative(self, t: float) -> float:
        return 0.0


def reason(made: Drawn, error: Exception) -> str:
    """Why a graph is refused: the kind of error where it is confirmed, or the limit.

    Raises `AssertionError` where neither is so.
    """
    kind, told = type(error).__name__, str(error)
    for pattern, words in LIMITS.items():
        if re.search(pattern, told):
            assert words in PAGE.read_text("utf-8"), words
            if "drives a dependent" in told:
                assert _dependent(made) or _read(made), told
            return words
    if kind == "CausalityError":
        assert not _independent(made, fixed(made)), told
        return kind
    assert kind in ("AlgebraicLoopError", "SingularStorageError"), (kind, told)
    judge, points = _judge(made)
    assert singular(judge, 0.3, points, (0.7, 1.9)), told
    return kind


def fixed(made: Drawn) -> list[tuple[str, str]]:
    """What cannot be given otherwise: the nodes and ports of sources and of laws that go one way."""
    found = []
    for node, told in made.graph.nodes(data=True):
        kind, law = told["kind"], told.get("law")
        if kind in ("Se", "De", "Sf", "Df"):
            found.append((node, {"Se": "e", "De": "f", "Sf": "f", "Df": "e"}[kind]))
        elif kind == "R" and law is not None:
            found.append((node, told["gives"][0]))
        elif kind in "IC" and (told.get("energy") or (law and node not in made.turned)):
            found.append((node, "f" if kind == "I" else "e"))
    return found


def _dependent(made: Drawn) -> bool:
    """Whether not all storages can be independent of one another, of sources and of laws as they give."""
    storages = [
        (node, "f" if kind == "I" else "e")
        for node, kind in made.graph.nodes(data="kind")
        if kind in "IC"
    ]
    return not _independent(made, [*dict.fromkeys([*fixed(made), *storages])])


def _read(made: Drawn) -> bool:
    """Whether the value of a storage or a two-port reads what a law gives: its slope would be needed."""
    given = {f"{letter}_{node}" for node, letter in fixed(made)}
    texts = [
        str(told.get("value"))
        for _, told in made.graph.nodes(data=True)
        if told["kind"] in ("I", "C", "TF", "GY")
    ]
    return any(re.search(rf"\b{name}(_[ab])?\b", text) for name in given for text in texts)


def _independent(made: Drawn, given: list[tuple[str, str]]) -> bool:
    """Whether all that is given may be given at once: rows of the structure and of these, at some moduli."""
    judge, points = _judge(made)
    rows = []
    for node, letter in given:
        for k, bond in enumerate(judge.written.bonds):
            if node in bond:
                row = np.zeros(judge.size)
                row[judge.written.names[f"_{letter}{k}"]] = 1.0
                rows.append(row)
    z = points[0]
    for k in judge.written.two_ports:
        text = judge.texts[k]
        # The equation is linear in the two-port's own variables, the last that it reads: "_e3", "_f4".
        rows.append(_own_slopes(judge, text, z))
    whole = np.vstack([judge.sums, *rows])[:, judge.held :]
    return int(np.linalg.matrix_rank(whole, tol=1e-9)) == len(whole)


def _own_slopes(judge: Judge, text: Text, z: Array) -> Array:
    """Of a two-port's equation the slopes along its own variables: what moves its modulus is none."""
    row = np.zeros(judge.size)
    outside = {name: judge.inputs[name](0.3)[0] for name in text.outside}
    local = {name: float(z[k]) for name, k in zip(text.names, text.places, strict=True)}
    own = [name for name in text.names if name.startswith("_")]
    for name in own:
        at = {**outside, **local, **dict.fromkeys(own, 0.0), name: 1.0}
        row[judge.written.names[name]] = float(eval(text.code, judge.scope, at))
    return row


def _judge(made: Drawn) -> tuple[Judge, list[Array]]:
    rng = random.Random("points")
    inputs = [f"u_{node}" for node in made.graph] + ["load"]
    judge = judged(made, {name: Constant(rng.uniform(0.3, 1.5)) for name in inputs})
    draw = np.random.default_rng(5)
    return judge, [draw.uniform(0.2, 0.9, judge.size) for _ in range(3)]
