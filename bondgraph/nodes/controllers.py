"""Sampled controllers: `Controller` as a user writes it, and the elements that it is made of."""

from collections.abc import Hashable, Iterable, Mapping
from math import lcm
from typing import Any

import sympy as sp

from bondgraph.algebra.atoms import number, symbol
from bondgraph.algebra.expressions import TIME, expression
from bondgraph.errors import ExpressionError, StructureError, nearest
from bondgraph.nodes.elements import Element, Node, stated
from bondgraph.nodes.kinds import Kind
from bondgraph.nodes.tasks import TICK, Called, Reset, Task

LARGEST = 2**40
"""No instant of a run of a thousand million periods is beyond what a double counts exactly."""


def Controller(
    name: Hashable, every: object, offset: object = 0, reads: object = None,
    states: Mapping[str, object] | None = None, update: Mapping[str, object] | None = None,
    gives: Mapping[str, object] | Iterable[str] | None = None, step: Called | None = None, **more: object,
) -> Node:  # fmt: skip
    """A controller that works at the instants ``offset + k*every`` [s], k = 0, 1, ..., and holds between.

    ``gives``: signals by name and the expression that each takes the value of at an instant, and holds
    until the next. ``states``: what it keeps, with where it begins, and ``update``, what each becomes. All
    expressions read what stood before the instant, after events there: so what it gives is told by its
    states before their update, and controllers that work at one instant do not see one another's new values.
    What it gives is 0 before its first instant, or what ``states`` tells of it. ``reads``: the signals that
    the expressions may read, where one that is left out is refused; any unless told.

    ``step``: a Python function instead of expressions, called at each instant with the values of ``reads``,
    of its states and of ``t`` by name; it returns what its states become and what it gives, by name.
    ``gives`` are then names. Runs in numpy call it, and no other way can.

    Raises nothing: `validate` looks at nodes.

    >>> import bondgraph as bg
    >>> motor = bg.graph(
    ...     [bg.Se("motor", "1*tau"), bg.One("shaft"), bg.I("J", "J", flow="omega"),
    ...      Controller("pi", every=0.01, states={"z": 0}, update={"z": "z + T*(ref - omega)"},
    ...                 gives={"tau": "K*(ref - omega) + z"})], "motor > shaft > J")
    >>> bg.derive(motor).further_states, [task.period for task in bg.derive(motor).tasks]
    ((z, tau), [0.01])
    """
    given = {
        "every": every, "offset": offset, "reads": reads, "states": states, "update": update,
        "outputs": gives, "step": step, **more,
    }  # fmt: skip
    if offset == 0:
        del given["offset"]
    return stated(name, Kind.CONTROLLER, given)


def controller_elements(name: Hashable, attributes: Mapping[str, Any]) -> list[Element]:
    """A junction that carries nothing, and at it a detector for each value that is kept."""
    where = f"node {name!r}"
    told = _of_function(attributes, where) if attributes.get("step") is not None else attributes
    starts, updates, gives = (
        _by_name(told.get(key), word, where)
        for key, word in (("states", "states"), ("update", "update"), ("outputs", "gives"))
    )
    _check(starts, updates, gives, where)
    kept = [*starts, *(one for one in gives if one not in starts)]
    becomes = {**updates, **gives}
    reads = _names(told.get("reads"), f"{where}, reads")
    resets = tuple(Reset(one, becomes[one], TICK) for one in kept)
    step = attributes.get("step")
    if step is None:
        _check_read(becomes, reads, where)
    task = Task(name, *_instants(attributes, where), resets, step, reads)
    effort, flow = (symbol(f"{letter}_{name}", where) for letter in "ef")
    found = [
        Element(name, Kind.ZERO, None, effort, None, whole=name, task=task),
        # No flow passes it, so that its effort, the rate of all that is kept, is zero.
        Element(f"{name}.still", Kind.R, sp.Integer(1), effort, flow, whole=name),
    ]
    for one in kept:
        effort, flow = (symbol(f"{letter}_{name}_{one}", where) for letter in "ef")
        found.append(
            Element(
                f"{name}.{one}", Kind.DE, None, effort, flow, gives="flow", integral=one,
                start=starts.get(one), whole=name,
            )
        )  # fmt: skip
    return found


_EXAMPLES = {
    "states": "states={'z': 0}",
    "update": "update={'z': 'z + e'}",
    "gives": "gives={'u': 'K*e'}",
}


def _by_name(given: Any, key: str, node: str) -> dict[sp.Symbol, sp.Expr]:
    if given is None:
        return {}
    where = f"{node}, {key}"
    if not isinstance(given, Mapping):
        raise StructureError(
            f"{where} must map names to expressions, such as {_EXAMPLES[key]}, not be {given!r}"
        )
    found: dict[sp.Symbol, sp.Expr] = {}
    for name, value in given.items():
        one = symbol(name.name if isinstance(name, sp.Symbol) else name, where)
        if one in found:
            raise StructureError(f"{where}: {one} is there twice")
        found[one] = expression(value, f"{where} of {one}")
    return found


def _check(
    starts: Mapping[sp.Symbol, sp.Expr], updates: Mapping[sp.Symbol, sp.Expr],
    gives: Mapping[sp.Symbol, sp.Expr], where: str,
) -> None:  # fmt: skip
    """Every state is updated and has a start, and nothing is both a state and given."""
    if not gives:
        raise StructureError(f"{where} gives nothing; name what it gives, gives={{'u': ...}}")
    for one in updates:
        if one in gives:
            raise StructureError(
                f"{where}: {one} is updated and given; give the state another name"
            )
        if one not in starts:
            raise StructureError(
                f"{where}: update of {one}, which is no state; tell where it begins, states={{'{one}': 0}}, "
                f"or write what others read into gives"
            )
    for one, start in starts.items():
        if one not in updates and one not in gives:
            raise StructureError(
                f"{where}: the state {one} is never updated; tell what it becomes, update={{'{one}': ...}}"
            )
        if TIME in start.free_symbols:
            raise StructureError(
                f"{where}: the start of {one} reads the time; give numbers and parameters"
            )


def _of_function(attributes: Mapping[str, Any], where: str) -> dict[str, Any]:
    """The attributes of a controller whose values a function tells: each keeps what it is until then."""
    if not callable(attributes["step"]):
        raise StructureError(
            f"{where}: step is {attributes['step']!r}; it must be a Python function"
        )
    gives = attributes.get("outputs")
    if isinstance(gives, Mapping) or attributes.get("update") is not None:
        raise StructureError(
            f"{where}: with a step, gives is a list of names, and there is no update: the function tells "
            "what all becomes"
        )
    states = attributes.get("states") or {}
    update = {one: one for one in states} if isinstance(states, Mapping) else None
    given = {str(one): str(one) for one in _names(gives, f"{where}, gives")}
    return {**attributes, "update": update, "outputs": given}


def _names(given: Any, where: str) -> tuple[sp.Symbol, ...]:
    if given is None:
        return ()
    if isinstance(given, str) or not isinstance(given, Iterable):
        raise StructureError(f"{where} must be a list of names, not {given!r}")
    return tuple(symbol(getattr(one, "name", one), where) for one in given)


def _check_read(
    becomes: Mapping[sp.Symbol, sp.Expr], names: Iterable[sp.Symbol], where: str
) -> None:
    """Every signal that it is to read is read; that nothing else is, is checked among all names."""
    used = {name for value in becomes.values() for name in value.free_symbols}
    for one in names:
        if one not in used:
            known = sorted(map(str, used))
            raise StructureError(
                f"{where}: its reads name {one}{nearest(str(one), known)}, but its expressions read "
                f"{', '.join(known) or 'nothing'}; write one name in both places, or leave {one} out"
            )


def _instants(attributes: Mapping[str, Any], where: str) -> tuple[int, int, int]:
    """Period and offset as integers over one unit."""
    if attributes.get("every") is None:
        raise StructureError(f"{where} has no period; give every=..., a number of seconds")
    every, offset = (
        exact_seconds(attributes.get(key, 0), f"{where}, {key}") for key in ("every", "offset")
    )
    if every <= 0 or offset < 0:
        raise StructureError(
            f"{where}: every is {every} and offset {offset}; a period is above zero, an offset not below"
        )
    unit = lcm(int(every.q), int(offset.q))
    found = int(every * unit), int(offset * unit), unit
    if max(found) > LARGEST:
        raise StructureError(
            f"{where}: every {every} and offset {offset} have too many digits for exact instants; round them"
        )
    return found


def exact_seconds(value: Any, where: str) -> sp.Rational:
    """A number of seconds, exactly as it is written: 0.1 is a tenth; or a text that is one, ``"1/3"``.

    Raises `StructureError` for anything else.
    """
    try:
        found = expression(value, where) if isinstance(value, str) else number(value, where)
    except ExpressionError as error:
        raise StructureError(f"{error}; give a number of seconds") from None
    if not isinstance(found, sp.Rational):
        raise StructureError(
            f"{where}: {found} is not a number of seconds; instants are the same in all runs"
        )
    return found
