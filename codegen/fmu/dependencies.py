"""Which starts, inputs and states each variable of a unit depends on, by structure alone."""

from collections.abc import Iterable, Mapping, Set

import sympy as sp

from bondgraph.algebra.expressions import TIME
from codegen.fmu.model import FmuModel
from codegen.fmu.variables import moved
from codegen.program.records import Program

Place = tuple[str, int]
"""A kind of variable (as `Variable.kind`) and its index."""


def dependencies(model: FmuModel) -> Mapping[int, tuple[int, ...]] | None:
    """For each variable, by value reference, the states and inputs it depends on; None for all of them.

    What holds a port that sticks may depend on anything, and so may coefficients that change.
    """
    program = model.program
    if program.varying:
        return None
    known_by = reach(program)
    refs = {(one.kind, one.index): at for at, one in enumerate(model.variables)}
    found: dict[int, tuple[int, ...]] = {}
    for place, known in known_by.items():
        if place in refs:
            named = {refs.get(_known(model, one)) for one in known}
            found[refs[place]] = tuple(sorted(at for at in named if at is not None))
    return found


def _known(model: FmuModel, place: Place) -> Place:
    """The variable by which an importer knows a component of the integrated vector, or a source."""
    kind, index = place
    program = model.program
    if kind == "FMU_VECTOR" and not (moved(program) and index < len(program.states)):
        return ("FMU_STATE", index)
    if kind in ("FMU_INPUT", "FMU_SLOPE") and index in model.starts.sources:
        return ("FMU_TIME", 0)
    return place


def reach(
    program: Program, more: Mapping[Place, Set[Place]] | None = None
) -> Mapping[Place, frozenset[Place]]:
    """Everything that a place leads back to among the integrated vector, inputs and their slopes.

    ``more``: what places are told by beside the equations.
    """
    edges = _edges(program)
    for place, used in (more or {}).items():
        edges[place] = edges.get(place, set()) | used
    found: dict[Place, set[Place]] = {place: set() for place in edges}
    for place, used in edges.items():
        found[place] |= {one for one in used if one not in edges}
    changed = True
    while changed:
        changed = False
        for place, used in edges.items():
            new = set().union(*(found[one] for one in used if one in edges)) - found[place]
            found[place] |= new
            changed = changed or bool(new)
    return {place: frozenset(known) for place, known in found.items()}


def _edges(program: Program) -> dict[Place, set[Place]]:
    """What each place is worked out of at once."""
    n, own = len(program.states), len(program.law_states)
    bound = _bound(program)
    where = symbols_of(program)
    edges: dict[Place, set[Place]] = {}
    for i in range(n):
        edges["FMU_STATE", i] = {("FMU_VECTOR", i)}
        if moved(program):
            columns = _columns(program, "E", bound[i])
            edges["FMU_STATE", i] |= {("FMU_GIVEN", j) for j in columns}
        edges["FMU_RATE", i] = {("FMU_STATE", j) for j in _columns(program, "J", bound[i])}
        edges["FMU_RATE", i] |= {("FMU_GIVEN", j) for j in _columns(program, "B", bound[i])}
    for i in range(own):
        edges["FMU_STATE", n + i] = {("FMU_VECTOR", n + i)}
        edges["FMU_RATE", n + i] = {("FMU_READING", program.law_rates[i])}
    for i in range(len(program.readings)):
        edges["FMU_READING", i] = {("FMU_STATE", j) for j in _columns(program, "F", [i])}
        edges["FMU_READING", i] |= {("FMU_GIVEN", j) for j in _columns(program, "D", [i])}
        for j in _columns(program, "K", [i]):
            edges["FMU_READING", i] |= {("slope", j)}
        for j in _columns(program, "H", [i]):
            edges["FMU_READING", i] |= {("FMU_RATE", j)}
            edges["FMU_READING", i] |= {("slope", k) for k in _columns(program, "E", bound[j])}
    _add_laws(program, where, edges)
    return edges


def _add_laws(
    program: Program, where: Mapping[sp.Symbol, Place], edges: dict[Place, set[Place]]
) -> None:
    """What laws and friction ports give, and the slopes in time of inputs."""
    everything = {("FMU_TIME", 0)}
    everything |= {("FMU_VECTOR", i) for i in range(len(program.states) + len(program.law_states))}
    for j in range(len(program.external)):
        everything |= {("FMU_INPUT", j), ("FMU_SLOPE", j)}
    for j, name in enumerate(program.inputs):
        external = program.external.index(name) if name in program.external else None
        edges["FMU_GIVEN", j] = set() if external is None else {("FMU_INPUT", external)}
        edges["slope", j] = set() if external is None else {("FMU_SLOPE", external)}
    for group in (program.known, *program.groups, program.coupled):
        used = {where[one] for one in group.values.arguments if one in where}
        used |= {("FMU_READING", i) for i in group.readings} if group.loop else set()
        for j in group.inputs:
            edges["FMU_GIVEN", j] |= everything if program.joint else used
    for j, indices in zip(program.known.inputs, program.known_uses, strict=True):
        edges["slope", j] |= {("FMU_SLOPE", at) for at in indices}
        edges["slope", j] |= {("FMU_INPUT", at) for at in indices} | {("FMU_TIME", 0)}
    for port in program.friction:
        edges["FMU_GIVEN", port.input] = set(everything)


def symbols_of(program: Program) -> dict[sp.Symbol, Place]:
    """The place of each symbol."""
    listed = (
        ("FMU_STATE", (*program.states, *program.law_states)),
        ("FMU_READING", program.readings),
        ("FMU_GIVEN", program.inputs),
        ("FMU_INPUT", program.external),
    )
    found: dict[sp.Symbol, Place] = {}
    for kind, symbols in listed:
        for at, symbol in enumerate(symbols):
            found.setdefault(symbol, (kind, at))
    found.setdefault(TIME, ("FMU_TIME", 0))
    return found


def _bound(program: Program) -> list[list[int]]:
    """For each state those whose inertias act on its rate: the blocks of A."""
    blocks = [{i} for i in range(len(program.states))]
    pattern = program.layout["A"]
    for i, j in zip(pattern.rows, pattern.columns, strict=True):
        if blocks[i] is not blocks[j]:
            joined = blocks[i] | blocks[j]
            for k in joined:
                blocks[k] = joined
    return [sorted(block) for block in blocks]


def _columns(program: Program, letter: str, rows: Iterable[int]) -> set[int]:
    """The columns of a matrix in which some rows have entries."""
    pattern, chosen = program.layout[letter], set(rows)
    return {j for i, j in zip(pattern.rows, pattern.columns, strict=True) if i in chosen}
