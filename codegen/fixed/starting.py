"""Starts that tell what storages hold, a momentum or a displacement, instead of their states."""

from collections.abc import Callable, Mapping, Sequence
from itertools import islice
from typing import NamedTuple

import numpy as np

from codegen.standalone.arrays import Array
from codegen.standalone.running import number


class Held(NamedTuple):
    """The states that what is held is a sum of, by their places; or the one that a law gives."""

    states: tuple[int, ...]
    by_law: bool = False


class Begin(NamedTuple):
    """States at a start; of laws what is held in their place."""

    x: Array


def started(
    initial: Mapping[str, object],
    states: Sequence[str],
    held: Mapping[str, Held],
    values: Callable[[Begin], Sequence[float]],
) -> Mapping[str, object]:
    """Initial values by states, with what storages hold turned into these.

    ``values``: of each that is held in turn the coefficients of its states, or what its law gives.

    Raises `ValueError` for what does not tell a state: of a field all has to be told, or the other
    states.
    """
    told = {name: number(initial[name], f"initial {name}") for name in held if name in initial}
    if not told:
        return initial
    given = {name: value for name, value in initial.items() if name not in told}
    x = np.zeros(len(states))
    for name, value in told.items():
        if held[name].by_law:
            x[held[name].states[0]] = value
    entries, rows = iter(values(Begin(x))), {}
    for name, one in held.items():
        row = dict(zip(one.states, islice(entries, len(one.states)), strict=True))
        if name in told and one.by_law:
            _give(given, states[one.states[0]], row[one.states[0]], name)
        elif name in told:
            rows[name] = {states[at]: entry for at, entry in row.items() if entry}
    return {**given, **_solved(rows, told, given)} if rows else given


def _give(given: dict[str, object], state: str, value: float, name: str) -> None:
    """What a law gives, which nothing else may."""
    if state in given or not np.isfinite(value):
        raise ValueError(f"initial {name} does not tell {state}; tell {state} alone")
    given[state] = value


def _solved(
    rows: Mapping[str, Mapping[str, float]],
    told: Mapping[str, float],
    given: Mapping[str, object],
) -> dict[str, float]:
    """The states that are not given, from sums of states; of each field as many as are told."""
    opened = [[state for state in row if state not in given] for row in rows.values()]
    names = list(dict.fromkeys(state for row in opened for state in row))
    wrong = [name for name, row in zip(rows, opened, strict=True) if not row] or [*rows]
    if len(names) == len(rows) and all(opened):
        matrix = np.array([[row.get(state, 0.0) for state in names] for row in rows.values()])
        rest = [
            told[name] - sum(entry * number(given[state], f"initial {state}")
                             for state, entry in row.items() if state in given)
            for name, row in rows.items()
        ]  # fmt: skip
        scale = np.abs(matrix).max(axis=1)
        try:
            found = np.linalg.solve(matrix / scale[:, None], np.array(rest) / scale)
            return dict(zip(names, found.tolist(), strict=True))
        except np.linalg.LinAlgError:
            pass
    raise ValueError(
        f"initial {', '.join(wrong)}: this does not tell {', '.join(names) or 'a state'}; tell all "
        "that a field holds, or the other states, and nothing twice"
    )
