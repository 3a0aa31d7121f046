"""What a user wrote at a state machine: its modes, the states that it keeps, and its transitions."""

from collections.abc import Iterable, Mapping
from typing import Any

import sympy as sp

from bondgraph.algebra.atoms import symbol
from bondgraph.algebra.expressions import TIME, expression
from bondgraph.errors import StructureError, nearest
from bondgraph.nodes.parts import ARROW
from bondgraph.nodes.resets import resets_of
from bondgraph.nodes.tasks import Machine, Reset, Transition

Acting = tuple[Transition, tuple[Reset, ...]]
"""A transition, and what its action sets."""


def modes_of(given: Any, name: str, where: str) -> tuple[str, ...]:
    """The modes, each of which makes a signal's name."""
    if given is None or isinstance(given, str | Mapping) or not isinstance(given, Iterable):
        raise StructureError(
            f"{where}: modes is {given!r}; give a list of names, ['idle', 'drive']"
        )
    modes = tuple(given)
    if not modes:
        raise StructureError(f"{where} has no modes; give their names, modes=['idle', 'drive']")
    for mode in modes:
        if not isinstance(mode, str) or not f"_{mode}".isidentifier():
            raise StructureError(
                f"{where}: {mode!r} cannot be a mode; use letters, digits and underscores: "
                f"the signal that is 1 in it is called {name}_{mode}"
            )
        if modes.count(mode) > 1:
            raise StructureError(f"{where}: the mode {mode!r} is there twice")
    return modes


def check_mode(mode: Any, modes: tuple[str, ...], where: str) -> None:
    """Refuse what is none of the modes."""
    if mode not in modes:
        raise StructureError(
            f"{where}: there is no mode {mode!r}{nearest(str(mode), modes)}; there are {', '.join(modes)}"
        )


def starts_of(given: Any, where: str) -> dict[sp.Symbol, sp.Expr]:
    """The states of a machine, and where they begin."""
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise StructureError(
            f"{where}, states must map names to where they begin, not be {given!r}"
        )
    found: dict[sp.Symbol, sp.Expr] = {}
    for key, value in given.items():
        one = symbol(key.name if isinstance(key, sp.Symbol) else key, f"{where}, states")
        if one in found:
            raise StructureError(f"{where}: {one} is there twice")
        found[one] = expression(value, f"{where}, start of {one}")
        if TIME in found[one].free_symbols:
            raise StructureError(
                f"{where}: the start of {one} reads the time; give numbers and parameters"
            )
    return found


def transitions_of(attributes: Mapping[str, Any], machine: Machine, where: str) -> list[Acting]:
    """The transitions, with what their actions set."""
    given, actions = attributes.get("transitions"), attributes.get("reset") or {}
    if not isinstance(given, Mapping) or not given:
        raise StructureError(
            f"{where}: transitions is {given!r}; it must map the modes of each to its guard, "
            "{'idle > drive': 'speed - 1'}"
        )
    if not isinstance(actions, Mapping) or (
        unknown := [key for key in actions if key not in given]
    ):
        what = repr(actions) if not isinstance(actions, Mapping) else f"{unknown[0]!r}"
        raise StructureError(f"{where}: reset has {what}, which is no transition of the machine")
    found: dict[str, Acting] = {}
    for words, guard in given.items():
        one = _transition(words, guard, machine, where)
        if one.words in found:
            raise StructureError(
                f"{where}: {one.words!r} is there twice; one guard is above zero where either is, max(a, b)"
            )
        told = f"{where}, action of {words!r}"
        found[one.words] = one, resets_of(actions.get(words), told, ("on",))
    return list(found.values())


def _transition(words: Any, guard: Any, machine: Machine, where: str) -> Transition:
    """One transition, its modes known."""
    ends = [part.strip() for part in words.split(ARROW)] if isinstance(words, str) else []
    if len(ends) != 2:
        raise StructureError(
            f"{where}: {words!r} is no transition; name the mode that it leaves and the one that it comes "
            f"to, '{machine.modes[0]} > {machine.modes[-1]}'"
        )
    for end in ends:
        check_mode(end, machine.modes, f"{where}, {words!r}")
    if isinstance(guard, list | tuple | Mapping):
        raise StructureError(
            f"{where}, {words!r} is {guard!r}; it must be a guard, or a guard and what states become, "
            "('speed - 1', {'gear': 1})"
        )
    source, target = ends
    return Transition(machine, source, target, expression(guard, f"{where}, guard of {words!r}"))


def check_set(
    starts: Mapping[sp.Symbol, sp.Expr], found: list[Acting],
    number: sp.Symbol, where: str,
) -> None:  # fmt: skip
    """Every state is set by some action, none sets the mode, and no transition is without any effect."""
    if number in starts:
        raise StructureError(f"{where}: {number} is its mode; give the state another name")
    for one, resets in found:
        if number in [reset.state for reset in resets]:
            raise StructureError(
                f"{where}, action of {one.words!r} sets {number}, the mode; a transition comes to "
                f"{one.target!r}, write another one"
            )
        if one.source == one.target and not resets:
            raise StructureError(
                f"{where}: {one.words!r} stays in its mode and sets nothing; give it an action, or remove it"
            )
    acted = {reset.state for _, resets in found for reset in resets}
    for state in starts:
        if state not in acted:
            raise StructureError(
                f"{where}: the state {state} is never set; set it in an action, or give a parameter"
            )
