"""Laws that give a signal from itself and have several solutions: they are run, with a warning that tells so.

Counted is what can be: of one signal, or of several of which all but one follow by laws that are affine
in them. The count is exact for rational functions (Sturm's theorem on rationals) at any numbers of the
other signals, of which a few are looked at; else changes of sign are told by bounds, in a stretch.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import sympy as sp

from bondgraph.errors import SimulationError
from codegen.model.exact_values import at_parameters
from codegen.model.hybrid import hybrid
from codegen.model.real_roots import Roots, roots_of
from codegen.numbers.arrays import Array
from codegen.numbers.lambdified import lambdified
from codegen.program.gains import shown, written_out
from codegen.program.records import Group, Program
from codegen.standalone.loops import searched

Numbers = Mapping[str, sp.Rational]
Point = dict[sp.Symbol, sp.Integer]

POINTS = (0, 1, -1)
"""Values of all other signals, or with alternating signs, at which solutions are counted."""

MOST_LISTED = 6
"""So many solutions are told by their values."""

MOST_OPERATIONS = 500
"""Laws with more of them are not put into one another."""


@dataclass(frozen=True)
class Loop:
    """Laws that determine one another: ``unknowns`` for which ``left`` vanishes.

    ``received``: what their ports receive, a sum of the unknowns, ``D``, and of other signals.
    """

    ports: tuple[str, ...]
    unknowns: tuple[sp.Symbol, ...]
    left: tuple[sp.Expr, ...]
    received: tuple[sp.Expr, ...]
    D: sp.ImmutableMatrix


def several_solutions(program: Program, parameters: Numbers) -> Iterator[str]:
    """What is to be told of each loop of laws that has several solutions."""
    for group in program.groups:
        loop = _loop(program, group, parameters) if group.loop else None
        found = None if loop is None else _several(loop)
        if loop is not None and found is not None:
            yield _told(loop, *found)


def _loop(program: Program, group: Group, parameters: Numbers) -> Loop | None:
    """A loop at these numbers; None where its ports receive what rates show."""
    rows = {letter: dict(shown(program, letter)) for letter in "FDHK"}
    names = {"F": program.states, "D": program.inputs}
    laws = written_out(group.values)
    read = {program.readings[i] for i in group.readings}
    read |= {name for law in laws for name in law.free_symbols if name in program.readings}
    if any(rows[letter].get(name) for letter in "HK" for name in read):
        return None
    constants = _constants(program, parameters)

    def at(expr: sp.Expr) -> sp.Expr:
        return _exact(at_parameters(expr, parameters)).xreplace(constants)

    received = {
        name: at(sp.Add(*(entry * names[letter][j]
                          for letter in "FD" for j, entry in rows[letter][name].items())))
        for name in sorted(read, key=str)
    }  # fmt: skip
    unknowns = [program.inputs[j] for j in group.inputs]
    left = [u - at(law.xreplace(received)) for u, law in zip(unknowns, laws, strict=True)]
    own = [received[program.readings[i]] for i in group.readings]
    D = sp.ImmutableMatrix([[sp.diff(expr, u) for u in unknowns] for expr in own])
    ports = tuple(repr(port) for port in group.ports)
    return Loop(ports, tuple(unknowns), tuple(left), tuple(own), D)


def _constants(program: Program, parameters: Numbers) -> dict[sp.Symbol, sp.Expr]:
    """Inputs that laws hold at a number, and sources written out."""
    count = len(program.asked)
    found = dict(zip(program.external[count:], program.sources, strict=True))
    for j, law in zip(program.known.inputs, written_out(program.known.values), strict=True):
        value = _exact(at_parameters(law.xreplace(found), parameters))
        if value.is_number:
            found[program.inputs[j]] = value
    return {name: at_parameters(value, parameters) for name, value in found.items()}


def _exact(expr: sp.Expr) -> sp.Expr:
    return expr.xreplace({one: sp.Rational(str(one)) for one in expr.atoms(sp.Float)})


def _several(loop: Loop) -> tuple[Point, sp.Symbol, Roots] | None:
    """Where there are several solutions, for which signal, and which; None where none are found."""
    reduced = _reduced(list(loop.left), list(loop.unknowns))
    if reduced is None:
        return None
    left, unknown = reduced
    others = sorted(left.free_symbols - {unknown}, key=str)
    for value in POINTS if others else POINTS[:1]:
        for sign in (1, -1) if value and len(others) > 1 else (1,):
            point = {name: sp.Integer(value * sign**i) for i, name in enumerate(others)}
            found = roots_of(left.xreplace(point), unknown)
            if found is not None and found.count > 1:
                return point, unknown, found
    return None


def _reduced(left: list[sp.Expr], unknowns: list[sp.Symbol]) -> tuple[sp.Expr, sp.Symbol] | None:
    """One law of one unknown that has the same solutions: the others are solved where they are affine.

    By a factor that is a number, so that nothing is divided by zero; None where that does not do.
    """
    while len(unknowns) > 1:
        pairs = ((at, u, _slope(left[at], u)) for at in range(len(left)) for u in unknowns)
        found = next(((at, u, slope) for at, u, slope in pairs if slope), None)
        if found is None or sum(int(sp.count_ops(law)) for law in left) > MOST_OPERATIONS:
            return None
        at, u, slope = found
        value = u - left[at] / slope
        left = [sp.expand(law.xreplace({u: value})) for law in left[:at] + left[at + 1 :]]
        unknowns = [name for name in unknowns if name != u]
    return left[0], unknowns[0]


def _slope(expr: sp.Expr, name: sp.Symbol) -> sp.Expr | None:
    """The slope in a name, as it is written: where that is a number, else None.

    Read off: slopes of laws with many signs and magnitudes are long to derive, and are no numbers.
    """
    if expr == name or name not in expr.free_symbols:
        return sp.Integer(expr == name)
    if expr.is_Mul:
        factor, rest = expr.as_independent(name, as_Add=False)
        inner = _slope(rest, name) if factor.is_number and not rest.is_Mul else None
        return None if inner is None else factor * inner
    slopes = [_slope(term, name) for term in expr.args] if expr.is_Add else [None]
    return None if None in slopes else sp.Add(*slopes)


def _told(loop: Loop, point: Point, unknown: sp.Symbol, roots: Roots) -> str:
    names, ports = ", ".join(map(str, loop.unknowns)), ", ".join(loop.ports)
    one = len(loop.unknowns) == 1
    laws = f"the law at {ports} gives {names} from itself"
    if not one:
        laws = f"the laws at {ports} give {names} from one another"
    count = f"{roots.count} real solutions" if roots.values else "more than one real solution"
    if roots.within:
        least = "at least " if roots.values else ""
        count = f"{least}{count} between {roots.within[0]:g} and {roots.within[1]:g}"
    if point:
        count += " where " + " and ".join(f"{name} = {value}" for name, value in point.items())
    if roots.values:
        listed = [f"{value:.6g}" for value in roots.values[:MOST_LISTED]]
        count += (
            f", {unknown} = {', '.join(listed)}{' ..' if len(roots.values) > MOST_LISTED else ''}"
        )
    taken = _taken(loop, point, unknown)
    which = "" if taken is None else f" ({unknown} = {taken:.6g})"
    return (
        f"{laws}, with {count}; taken is the one between giving and receiving nothing, else the one "
        f"that Newton's steps find from there{which}: write the branch that is meant"
    )


def _taken(loop: Loop, point: Point, unknown: sp.Symbol) -> float | None:
    """The solution that runs take at a point, all signals that are not told there at zero."""
    rest = {
        name: point.get(name, sp.Integer(0))
        for expr in (*loop.left, *loop.received, *loop.D)
        for name in expr.free_symbols - set(loop.unknowns)
    }
    law = lambdified(list(loop.unknowns), [expr.xreplace(rest) for expr in loop.left])
    nothing = rest | dict.fromkeys(loop.unknowns, sp.Integer(0))

    def left(values: Array) -> Array:
        found = np.array(law(*values.tolist()), dtype=float)
        return np.asarray(np.nan_to_num(found, nan=1e300), dtype=float)

    try:
        D = np.array(loop.D.xreplace(rest).tolist(), dtype=float)
        received = np.array([expr.xreplace(nothing) for expr in loop.received], dtype=float)
        with np.errstate(all="ignore"):
            values, _ = searched(left, D, received, hybrid)
    except (ArithmeticError, TypeError, ValueError, SimulationError):
        return None
    return None if values is None else float(values[list(loop.unknowns).index(unknown)])
