"""Equations, causality and events as text that a person can read."""

from collections.abc import Hashable
from typing import Any

import sympy as sp

import bondgraph as bg
from codegen import Result


def equations_text(equations: bg.StateEquations) -> str:
    """``A x' = J x + B u`` and ``y = F x``, matrix by matrix; those that are zero are left out."""
    shown = [name for name in "AJBEFDG" if name in "AB" or getattr(equations, name).todok()]
    right = {"J": "J x", "B": "B u", "E": "E u'"}
    rates = " + ".join(right[name] for name in right if name in shown)
    lines = [f"A x' = {rates}"]
    if equations.outputs:
        read = {"F": "F x", "D": "D u", "G": "G u'"}
        lines[0] += ",   y = " + (" + ".join(read[n] for n in read if n in shown) or "0")
    for letter, names in (
        ("x", equations.states),
        ("u", equations.inputs),
        ("y", equations.outputs),
    ):
        if names:
            lines.append(f"  {letter} = [{', '.join(str(name) for name in names)}]")
    for name in shown:
        lines += ["", _labelled(name, getattr(equations, name))]
    return "\n".join(lines)


def causality_text(causal: bg.CausalGraph) -> str:
    """Which storages are states, which is dependent, and why."""
    lines = [
        f"states (integral causality):        {_listed(causal.integral)}",
        f"dependent (derivative causality):   {_listed(causal.derivative)}",
    ]
    for name in causal.derivative:
        lines += ["", f"why {name!r} is dependent:"]
        lines += [f"  - {sentence}" for sentence in causal.why(name)]
    return "\n".join(lines)


def events_text(result: Result) -> str:
    """When each friction port stuck, slipped and crossed zero, one event a line."""
    words = {"stick": "sticks", "slip": "slips again", "cross": "crosses zero slip"}
    lines = [f"t = {e.time:.6f} s   {e.port} {words[e.kind]}" for e in result.events]
    return "\n".join(lines) or "no friction port stuck, was released or changed its slip's sign"


def _labelled(name: str, matrix: Any) -> str:
    rows = sp.pretty(sp.Matrix(matrix), use_unicode=True, wrap_line=False).split("\n")
    label, middle = f"{name} = ", len(rows) // 2
    return "\n".join(
        (label if at == middle else " " * len(label)) + row for at, row in enumerate(rows)
    )


def _listed(names: tuple[Hashable, ...]) -> str:
    return ", ".join(str(name) for name in names) or "none"
