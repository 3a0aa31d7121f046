"""A signal that follows another at a bounded rate: `RateLimiter`, and the elements that it is made of."""

from collections.abc import Hashable, Mapping
from typing import Any

import sympy as sp

from bondgraph.algebra.atoms import number, symbol
from bondgraph.algebra.expressions import TIME, expression
from bondgraph.errors import StructureError
from bondgraph.nodes.attributes import start_of, unit_of
from bondgraph.nodes.elements import Element, Node, stated
from bondgraph.nodes.kinds import Kind
from bondgraph.nodes.laws import DryFriction
from bondgraph.nodes.signals import own_name, source_of, variables_of


def RateLimiter(
    name: Hashable, input: object, rate: object, falling: object = None, start: object = None,
    **more: object,
) -> Node:  # fmt: skip
    """A state that follows its input, rising no faster than ``rate`` and falling no faster than ``falling``.

    Both are rates per second, not negative; it falls as fast as it rises unless told. It is dry friction: an
    input in motion drags a mass along, which sticks to it while the input is slow enough and else slips, at
    the rate. So the instants at which it leaves its input and meets it again are located events, "slip" and
    "stick" of ``<name>.clutch``, and while it follows, it does so exactly. It begins at ``start``; unless
    told at what its input is then, if that holds numbers and the time alone, else at 0.

    To follow its input it needs the input's rate: one of inputs, states and the time has one, one that
    reads what laws give of states (a `Function` of a state) has none, and a run is refused as it comes to
    follow; write the function's expression instead of its name.

    Raises nothing: `validate` looks at nodes.

    >>> import bondgraph as bg, codegen
    >>> ramp = bg.derive(bg.graph([RateLimiter("r", "ref", rate=2, falling=1)]))
    >>> step = codegen.Pulse(0, 2, 3)
    >>> run = codegen.simulator(ramp, {}).run([0, 1, 2, 3, 4], inputs={"ref": step})
    >>> run["r"].round(9).tolist()
    [0.0, 2.0, 3.0, 2.0, 1.0]
    """
    told = {"value": input, "rate": rate, "falling": falling, "start": start, **more}
    return stated(name, Kind.RATE_LIMITER, told)


def rate_limiter_elements(name: Hashable, attributes: Mapping[str, Any]) -> list[Element]:
    """A unit mass whose flow is the signal, and what drags it along: a clutch to a flow source.

    ``m y' = drift + friction``: with half the sum of both rates as the friction's level and half their
    difference as the drift the mass goes at one rate or the other where it slips.
    """
    where = f"node {name!r}"
    for key, word in (("value", "input"), ("rate", "rate")):
        if attributes.get(key) is None:
            raise StructureError(f"{where} has no {word}; give a number, a name or an expression")
    read = expression(attributes["value"], f"{where}, input")
    rates = [
        expression(attributes[key], f"{where}, {key}")
        for key in ("rate", "falling")
        if attributes.get(key) is not None
    ]
    for one in rates:
        if one.is_negative:
            raise StructureError(f"{where}: the rate {one} is negative; give its magnitude")
    own = own_name(name, where)
    if own in read.free_symbols:
        raise StructureError(f"{where}: its input reads {own} itself; a State has a rate of itself")
    rise, fall = rates[0], rates[-1]
    start = _start(attributes, read, where)
    drift = [] if rise == fall else [source_of(name, "drift", Kind.SE, (rise - fall) / 2)]
    return [
        Element(name, Kind.ONE, None, None, symbol(f"f_{name}", where), whole=name),
        Element(
            f"{name}.mass", Kind.I, sp.Integer(1), variables_of(name, "mass")[0], own,
            start=start, unit=unit_of(attributes, where), whole=name,
        ),
        *drift,
        Element(f"{name}.slip", Kind.ZERO, None, variables_of(name, "slip")[0], None, whole=name),
        source_of(name, "input", Kind.SF, read),
        Element(
            f"{name}.clutch", Kind.R, None, *variables_of(name, "clutch"), whole=name,
            law=DryFriction((rise + fall) / 2),
        ),
    ]  # fmt: skip


def _start(attributes: Mapping[str, Any], read: sp.Expr, where: str) -> sp.Expr | None:
    """Where it begins: as told, or at what the input is then, where its expression tells that."""
    told = start_of(attributes, where)
    if told is not None or not read.free_symbols <= {TIME}:
        return told
    found = read.subs(TIME, 0)
    # Of a table there is no exact number.
    return found if found.is_finite and found.is_real else number(found.evalf(), where)
