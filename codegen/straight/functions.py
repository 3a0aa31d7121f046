"""Recordings as functions: of one instant over plain floats, of many instants over arrays."""

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from bondgraph.algebra.called import Called
from codegen.model.numpy_backend import compiled
from codegen.program.records import Block
from codegen.standalone.arrays import Array
from codegen.straight.sums import PARTS, Line, Recording, Sum, Value, names_in, needed
from codegen.straight.words import text_of, writable, written
from codegen.tuning import TUNING

Straight = Callable[[float, list[float], Sequence[float], Sequence[float]], list[float] | None]
"""From t, s, w and w' to results; None, or an arithmetic error, where the evaluation has to tell more."""


def is_writable(recording: Recording) -> bool:
    """Whether all laws of a recording are written over floats."""
    return all(writable(line.code) for line in recording.lines if isinstance(line.code, Block))


def straight(recording: Recording, parts: Sequence[str]) -> Straight:
    """A function that gives these parts one after the other, all finite."""
    results = [value for part in parts for value in recording.parts[part]]
    looks = [line for part in parts for line in recording.looks.get(part, ())]
    lines = needed([*recording.lines, *looks], results)
    used = names_in(results).union(*(names_in(line.read) for line in lines))
    body = [f"{name} = {letter}[{name[1:]}]" for letter in "swd"
            for name in sorted(used, key=lambda n: (len(n), n)) if name.startswith(letter)]  # fmt: skip
    for line in lines:
        body += written(line)
    body += [f"found = [{', '.join(map(text_of, results))}]"]
    body += ["return found if math.isfinite(sum(found)) else None"]
    text = "\n    ".join(["def straight(t, s, w, d):", *body]) + "\n"
    names: dict[str, Any] = {"math": math, "loops": recording.loops, "least": _least, "most": _most}
    names |= {"inf": math.inf, "nan": math.nan, **_tables(lines)}
    exec(compile(text, "<straight>", "exec"), names)
    found: Straight = names["straight"]
    return found


def _tables(lines: Sequence[Line]) -> dict[str, Callable[..., float]]:
    """What looks into tables, by the names that it is called by."""
    blocks = [line.code for line in lines if isinstance(line.code, Block)]
    looks = {part for code in blocks for value in code.values for part in value.atoms(Called)}
    return {part.code: part.numeric for part in looks}


def _least(*values: float) -> float:
    return min(values) + 0.0 * sum(values)


def _most(*values: float) -> float:
    return max(values) + 0.0 * sum(values)


def over(
    recording: Recording, times: Array, vectors: Array, w: Array, dw: Array
) -> dict[str, Array] | None:
    """The parts at many instants, rows of tables; ``vectors``, ``w``, ``dw``: with a column for each instant.

    None where a law has no value, or friction is none, somewhere: an evaluation there has to tell.
    """
    known: dict[str, Any] = {"t": times}
    for letter, table in (("s", vectors), ("w", w), ("d", dw)):
        known |= {f"{letter}{at}": row for at, row in enumerate(table)}
    try:
        with np.errstate(divide="raise", invalid="raise", over="raise"):
            if not all(_taken(line, known, recording) for line in recording.lines):
                return None
            tables = {part: _table(recording.parts[part], known) for part in PARTS}
    except (ArithmeticError, TypeError, ValueError):
        return None
    return tables if all(np.isfinite(table).all() for table in tables.values()) else None


def _table(values: Sequence[Value], known: dict[str, Any]) -> Array:
    """Values at many instants, with a row for each of these."""
    table = np.zeros((len(known["t"]), len(values)))
    for at, value in enumerate(values):
        table[:, at] = _value(value, known)
    return table


def _value(value: Value, known: dict[str, Any]) -> Any:
    if not isinstance(value, Sum):
        return value
    return sum((factor * known[name] for name, factor in value.terms.items()), value.constant)


def _taken(line: Line, known: dict[str, Any], recording: Recording) -> bool:
    """Take a line; whether it is sound."""
    read = [_value(value, known) for value in line.read]
    if isinstance(line.code, Block):
        found = compiled(line.code)(*read)
    elif isinstance(line.code, int):
        # Loops are solved one instant after the other.
        points = np.broadcast_arrays(known["t"], *read)[1:]
        solve = recording.loops[line.code]
        found = list(np.array([solve(*point) for point in zip(*points, strict=True)]).T)
    elif line.code == "!":
        level, cap, curve, rest = map(np.asarray, read)
        short = cap < level * rest * (1 - TUNING.breakaway)
        return not bool(((level < 0) | (curve < 0) | short).any())
    elif line.code == "/":
        found = [read[0] / read[1]]
    else:
        found = read if line.code == "+" else [read[0] * read[1]]
    known.update(zip(line.names, found, strict=True))
    return True
