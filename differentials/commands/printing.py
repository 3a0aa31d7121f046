"""What commands print: text for people, JSON for machines, files that were written."""

import json
import math
from collections.abc import Iterable, Mapping
from numbers import Integral, Real
from pathlib import Path
from typing import Any

import click
import numpy as np
import sympy as sp

import bondgraph as bg
from bondgraph.show.powers import powers, without_functions
from bondgraph.show.putting_in import closed
from bondgraph.show.statements import statements
from bondgraph.show.whole import ways
from bondgraph.writing import made_folder

MATRICES = "AJBEFDG"


def headed(title: str) -> str:
    """A title with a rule below."""
    return f"{title}\n{'-' * len(title)}"


def print_json(data: object) -> None:
    """Data as JSON: numbers as numbers, expressions as text, nan and infinity as null."""
    click.echo(json.dumps(plain(data), indent=1, ensure_ascii=False, allow_nan=False))


def plain(value: object) -> Any:
    """The value out of what JSON knows; complex numbers have a real and an imaginary part.

    >>> plain({"pole": -1 + 2j, "gain": float("nan"), "A": [sp.Symbol("m")]})
    {'pole': {'real': -1.0, 'imag': 2.0}, 'gain': None, 'A': ['m']}
    """
    if isinstance(value, Mapping):
        return {str(key): plain(part) for key, part in value.items()}
    if value is None or isinstance(value, str | bool):
        return value
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, Iterable):
        return [plain(part) for part in value]
    if isinstance(value, Integral):
        return int(value)
    if isinstance(value, Real) and not isinstance(value, sp.Basic):
        return float(value) if math.isfinite(value) else None
    if isinstance(value, complex):
        return {"real": plain(value.real), "imag": plain(value.imag)}
    return str(value)


def equations_data(equations: bg.StateEquations) -> dict[str, object]:
    """Names and matrices of state equations, signals apart; entries are expressions as text."""
    shown = powers(equations)
    names = {part: [str(n) for n in getattr(shown, part)] for part in
             ("states", "inputs", "outputs", "parameters")}  # fmt: skip
    matrices = {
        name: [[str(entry) for entry in row] for row in getattr(shown, name).tolist()]
        for name in MATRICES
    }
    return {**names, **matrices, **_beside(equations)}


def _beside(equations: bg.StateEquations) -> dict[str, object]:
    """What stands beside the matrices, and all equations with laws and sources put in."""
    equations = without_functions(equations)
    found = statements(equations)
    return {
        "given": {str(one.left): one.right_text for one in found.given},
        "rates": {str(one.left): one.right_text for one in (*found.rates, *found.kept)},
        "together": [list(map(str, loop)) for loop in found.loops],
        "ways": ways(equations),
        "put_in": {str(one.left): one.right_text for one in closed(equations, found)},
    }


def causality_data(causal: bg.CausalGraph) -> dict[str, object]:
    """Which storages are states, which are dependent and why, and where each bond's effort goes."""
    return {
        "integral": causal.integral,
        "derivative": causal.derivative,
        "why": {str(name): causal.why(name) for name in causal.derivative},
        "strokes": [
            {"tail": tail, "head": head, "effort_to": end}
            for (tail, head), end in causal.strokes.items()
        ],
    }


def with_folder(path: Path) -> Path:
    """The path itself, its folder made."""
    made_folder(path.parent)
    return path


def written(path: Path, what: str = "") -> None:
    """Say that a file was written."""
    click.echo(f"{what:15}{path}" if what else str(path))
