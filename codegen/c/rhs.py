"""The rates of slipping friction in straight-line code: laws in turn, and no entry that is zero."""

from collections.abc import Iterable
from dataclasses import dataclass

import networkx as nx
import sympy as sp

from codegen.c.constants import Constants, expanded, needed
from codegen.program.records import Block, Group, Program

MOST_INVERSES = 4096
"""Beyond this many entries of A^-1 straight-line code is no gain."""


@dataclass(frozen=True)
class Straight:
    """A block for the rates; ``hoisted``: constants from parameters; ``inverses``: entries of A^-1.

    ``constants`` are the names of both, in this order; ``signs`` those of the friction's directions.
    """

    code: Block
    constants: tuple[sp.Symbol, ...]
    signs: tuple[sp.Symbol, ...]
    hoisted: tuple[sp.Expr, ...]
    inverses: tuple[tuple[int, int], ...]


def straight(program: Program) -> Straight | None:
    """Straight-line code for the rates, or None where something has to be solved for."""
    return Builder(program).built() if is_straight(program) else None


def is_straight(program: Program) -> bool:
    """Whether nothing has to be solved for, and little to be kept of A^-1."""
    looped = program.joint or any(group.loop for group in program.groups)
    rated = any(program.layout[name].rows for name in "EHK")
    if looped or rated or program.varying:
        return False
    return sum(len(part) ** 2 for part in _blocks(program)) <= MOST_INVERSES


def straights(program: Program) -> tuple[Straight, ...]:
    """Straight-line code for the rates, where there is some: of laws as they are, and on one side of each
    corner, where they have any."""
    kinds = [program] if program.corners is None else [program, program.on_sides]
    found = tuple(fast for one in kinds if (fast := straight(one)) is not None)
    return found if len(found) == len(kinds) else ()


def _blocks(program: Program) -> list[list[int]]:
    """States that A couples, each with those it is coupled to."""
    coupled: nx.Graph[int] = nx.Graph()
    coupled.add_nodes_from(range(len(program.states)))
    pattern = program.layout["A"]
    coupled.add_edges_from(zip(pattern.rows, pattern.columns, strict=True))
    return sorted(sorted(part) for part in nx.connected_components(coupled))


def _product(factor: sp.Expr, value: sp.Expr) -> sp.Expr:
    """A product; a number is not multiplied into a sum."""
    if factor.is_number and factor != 1 and value.is_Add:
        return sp.Mul(factor, value, evaluate=False)
    return factor * value


class Builder:
    """Collects the assignments of one program's rates."""

    def __init__(self, program: Program) -> None:
        self._program, self._blocks = program, _blocks(program)
        self._parameters = set(program.parameters)
        taken = {
            name.name
            for part in (program.states, program.law_states, program.inputs, program.external,
                         program.readings, program.parameters, program.sides)
            for name in part
        }  # fmt: skip
        self._constants = Constants(self._parameters, taken)
        self._inverses: dict[tuple[int, int], sp.Symbol] = {}
        self._assignments: list[tuple[sp.Symbol, sp.Expr]] = []
        self._given: dict[int, sp.Expr] = {}
        self._entries = self._matrices()
        self._signs = tuple(
            self._constants.new(f"sign_{at}") for at in range(len(program.friction))
        )

    def built(self) -> Straight:
        """The rates, by states, then law states."""
        code, inverses = needed(self._assignments, self._rates_of_all()), self._places()
        names = (*self._constants.names.values(), *(self._inverses[place] for place in inverses))
        return Straight(code, names, self._signs, tuple(self._constants.names), tuple(inverses))

    def _places(self) -> list[tuple[int, int]]:
        """The entries of A^-1 that are used."""
        return sorted(self._inverses, key=lambda place: (place[1], place[0]))

    def _rates_of_all(self) -> list[sp.Expr]:
        """The rates, once all that moves them is assigned."""
        program = self._program
        for at, name in enumerate(program.inputs):
            if name in program.external:
                self._given[at] = name
        self._laws(program.known)
        for group in program.groups[: program.early]:
            self._laws(group)
        self._friction()
        for group in program.groups[program.early :]:
            self._laws(group)
        return [*self._rates(), *(self._row(row, "F", "D") for row in program.law_rates)]

    def _matrices(self) -> dict[str, dict[int, list[tuple[int, sp.Expr]]]]:
        """Per matrix and row its entries."""
        values = expanded(self._program.coefficients)
        found: dict[str, dict[int, list[tuple[int, sp.Expr]]]] = {}
        start = 0
        for letter, pattern in self._program.layout.items():
            rows: dict[int, list[tuple[int, sp.Expr]]] = {}
            end = start + len(pattern.rows)
            for i, j, value in zip(pattern.rows, pattern.columns, values[start:end], strict=True):
                rows.setdefault(i, []).append((j, value))
            found[letter], start = rows, end
        return found

    def _row(self, row: int, states: str, inputs: str) -> sp.Expr:
        """One row of a pair of matrices times states and inputs."""
        values = [
            (entry, self._program.states[j]) for j, entry in self._entries[states].get(row, [])
        ]
        values += [(entry, self._given[j]) for j, entry in self._entries[inputs].get(row, [])]
        gathered: dict[sp.Expr, sp.Expr] = {}
        for entry, value in values:
            turned = entry.could_extract_minus_sign()
            factor = self._constants.named(-entry if turned else entry)
            gathered[factor] = gathered.get(factor, sp.S.Zero) + (-value if turned else value)
        return sp.Add(*(_product(*part) for part in gathered.items()))

    def _read(self, expressions: Iterable[sp.Expr]) -> None:
        """Assign the readings that these expressions use."""
        program = self._program
        known = {*program.states, *program.law_states, *program.inputs, *program.external}
        known |= {*self._parameters, *(name for name, _ in self._assignments)}
        used: set[sp.Symbol] = set().union(*(value.free_symbols for value in expressions))
        for at, name in enumerate(program.readings):
            if name in used and name not in known:
                self._assignments.append((name, self._row(at, "F", "D")))

    def _laws(self, group: Group) -> None:
        values = expanded(group.values)
        self._read(values)
        for at, value in zip(group.inputs, values, strict=True):
            self._give(at, self._constants.hoisted(value))

    def _give(self, at: int, value: sp.Expr) -> None:
        name = self._program.inputs[at]
        if name in self._parameters:
            self._given[at] = value
            return
        self._assignments.append((name, value))
        self._given[at] = name

    def _friction(self) -> None:
        values = expanded(self._program.friction_values)
        self._read([*values[::4], *values[2::4]])
        for at, port in enumerate(self._program.friction):
            level, curve = (
                self._constants.hoisted(values[4 * at]),
                self._constants.hoisted(values[4 * at + 2]),
            )
            self._give(port.input, level * curve * self._signs[at])

    def _rates(self) -> list[sp.Expr]:
        """``A^-1 (J x + B u)``, block by block of A."""
        rates: dict[int, sp.Expr] = {}
        for part in self._blocks:
            pushed = [self._row(i, "J", "B") for i in part]
            if len(part) > 1:
                names = [self._constants.new(f"q{i}") for i in part]
                self._assignments += list(zip(names, pushed, strict=True))
                pushed = list(names)
            for i in part:
                terms = [self._inverse(i, j) * q for j, q in zip(part, pushed, strict=True)]
                rates[i] = sp.Add(*terms)
        return [rates[i] for i in range(len(self._program.states))]

    def _inverse(self, row: int, column: int) -> sp.Symbol:
        place = (min(row, column), max(row, column))
        if place not in self._inverses:
            self._inverses[place] = self._constants.new(f"a_{place[0]}_{place[1]}")
        return self._inverses[place]
