"""What a run tells, as the judge's unknowns: values to begin with, and which of them the states are."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.optimize import brentq

from .drawn import Drawn
from .judge import Judge, Moving

Array = np.ndarray
WIDE = (-40.0, 40.0)
"""Where what a storage holds is looked for."""


def judged(made: Drawn, inputs: Mapping[str, Any], still: bool = False) -> Judge:
    """The judge of a graph whose inputs are these signals, smooth ones; ``still``: held where they are."""

    def moving(signal: Any) -> Moving:
        piece = signal.piece(0.0)
        return lambda t: (signal(t), 0.0 if still else piece.derivative(t))

    given = {name: moving(signal) for name, signal in inputs.items()}
    return Judge(made.graph, made.parameters, given)


def unknowns(judge: Judge, run: Any) -> Array:
    """All unknowns as a run has them, a row for each sample; what is held is 0 where it tells none."""
    found = np.zeros((len(run.time), judge.size))
    for k, bond in enumerate(judge.written.bonds):
        for j, values in enumerate(run.bond(*bond)):
            found[:, judge.held + 2 * k + j] = values
    return found


def pinned(made: Drawn, judge: Judge, states: Mapping[str, float], z: Array) -> dict[int, float]:
    """Which unknowns the states are, and their values; ``z`` takes them, and what else is held.

    A linear storage whose value reads an input has a state that others add to: there its flow or effort is
    taken as it is in ``z``.
    """
    names, pins = judge.written.names, dict[int, float]()
    for name, value in states.items():
        k = names[name]
        if summed(made, name):
            k = names[_co_energy(name)]
            value = float(z[k])
        pins[k] = z[k] = value
    for name, k in names.items():
        if k < judge.held and k not in pins and _has_law(made, name):
            z[k] = _held(judge, k, names[_co_energy(name)], z)
    return pins


def summed(made: Drawn, name: str) -> bool:
    """Whether a state is what a linear storage and those that depend on it hold together."""
    told = made.graph.nodes.get(name[2:], {})
    return name[:2] in ("p_", "q_") and told.get("value") is not None


def _co_energy(name: str) -> str:
    return ("f" if name[0] == "p" else "e") + name[1:]


def _has_law(made: Drawn, name: str) -> bool:
    told = made.graph.nodes.get(name[2:], {})
    return name[:2] in ("p_", "q_") and "law" in told and "ports" not in told


def _held(judge: Judge, k: int, co: int, z: Array) -> float:
    """What a storage holds by its law, 0 where it gives this in no state."""
    text = next(one for one in judge.texts if sorted(one.places) == sorted((k, co)))

    def left(held: float) -> float:
        local = {
            name: held if place == k else float(z[co])
            for name, place in zip(text.names, text.places, strict=True)
        }
        try:
            return float(eval(text.code, judge.scope, local))
        except OverflowError:
            return -np.inf if held > 0 else np.inf

    try:
        return float(brentq(left, *WIDE, xtol=1e-14))
    except ValueError:
        return 0.0
