"""What holds each set of sticking ports, as ranks that text for a target can rely on: decided exactly."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from itertools import combinations

import sympy as sp

from bondgraph.algebra.elimination import ResidueRows
from bondgraph.algebra.residues import residues
from bondgraph.equations import StateEquations
from bondgraph.errors import ParameterError, StructureError
from codegen.model.numbers import at_parameters
from codegen.ports.slips import moved_laws
from codegen.program.records import Program

Ports = tuple[int, ...]

MOST_PORTS = 8
"""So many friction ports that are not plainly regular are looked at in all their combinations."""


class _Ranks:
    """Ranks of the blocks of D and F that belong to sets of friction ports."""

    def __init__(
        self, program: Program, equations: StateEquations, parameters: Mapping[str, sp.Rational]
    ) -> None:
        value = residues()

        def exact(row: Mapping[int, sp.Expr]) -> dict[int, int]:
            found = {j: value(at_parameters(entry, parameters)) for j, entry in row.items()}
            return {j: entry for j, entry in found.items() if entry}

        readings = list(equations.readings.values())
        rows = [readings[port.reading] for port in program.friction]
        self._D = [exact(row.D) for row in rows]
        self._F = [exact({j + len(program.inputs): e for j, e in row.F.items()}) for row in rows]
        self._inputs = [port.input for port in program.friction]
        self._moved = moved_laws(program, equations)
        laws = [group.inputs for group in (*program.groups, program.coupled)]
        self._laws = [j for inputs in laws for j in inputs]

    def rank(self, ports: Ports, others: Iterable[int] = (), states: bool = False) -> int:
        """The rank of ``[D_ss, D_s others, F_s]``; laws that efforts of s move count with these."""
        moved = [j for i in ports for j in self._moved[i]]
        columns = list(dict.fromkeys([*(self._inputs[i] for i in ports), *moved, *others]))
        rows = [{j: self._D[i][j] for j in columns if j in self._D[i]} for i in ports]
        if states:
            rows = [row | self._F[i] for i, row in zip(ports, rows, strict=True)]
            columns += sorted({j for i in ports for j in self._F[i]})
        eliminated = ResidueRows(rows)
        return sum(eliminated.pivot(column, jordan=False) for column in columns)

    def held(self, ports: Ports) -> tuple[int, int]:
        """How many efforts D_ss determines, and how many independent slips bind the states."""
        beside = self.rank(ports)
        return beside, self.rank(ports, states=True) - beside

    def ruled_by_laws(self, ports: Ports) -> bool:
        """Whether to hold them the slope in time of what a law gives would be needed."""
        return self.rank(ports, self._laws) > self.rank(ports)


def sticking_ranks(
    program: Program, equations: StateEquations, parameters: Mapping[str, sp.Rational]
) -> Mapping[Ports, tuple[int, int]]:
    """For sets of sticking ports the rank of D_ss and that of the slips that bind the states.

    Sets that are missing are plainly regular: rank 0, and all slips bind the states. Raises
    `StructureError` or `ParameterError`, naming the ports, if a set could not be held, or is held in
    another way with these parameters than with most.
    """
    names = [port.name for port in program.friction]
    given, general = _Ranks(program, equations, parameters), _Ranks(program, equations, {})
    result: dict[Ports, tuple[int, int]] = {}
    for ports in _sets(given, general, names):
        listed = _listed(names, ports)
        held = given.held(ports)
        if held != general.held(ports):
            raise ParameterError(
                f"with these parameters what holds {listed} is of another rank than in general, and text "
                "that takes other numbers cannot have both; put the numbers into the graph"
            )
        if general.ruled_by_laws(ports):
            raise StructureError(
                f"holding {listed} would need the slope in time of what a law gives; put a storage between"
            )
        if held != (0, len(ports)):
            result[ports] = held
    return result


def beside_resistance(program: Program, equations: StateEquations) -> tuple[bool, ...]:
    """For each friction port whether its slip depends at once on friction, or on laws that friction moves."""
    readings = list(equations.readings.values())
    inputs = {port.input for port in program.friction} | set(program.coupled.inputs)
    return tuple(
        any(readings[port.reading].D.get(j, 0) != 0 for j in inputs) for port in program.friction
    )


def _sets(given: _Ranks, general: _Ranks, names: Sequence[Hashable]) -> list[Ports]:
    """The sets to look at: the full one alone if it is regular, as its parts then are too."""
    every = tuple(range(len(names)))
    plain = (0, len(every))
    if given.held(every) == general.held(every) == plain:
        return [(i,) for i in every] + [every]
    if len(every) > MOST_PORTS:
        raise StructureError(
            f"{_listed(names, every)} are more than {MOST_PORTS} friction ports that share loads or lie "
            "beside resistances; the text would need a table of all their combinations"
        )
    return [ports for count in every for ports in combinations(every, count + 1)]


def _listed(names: Sequence[Hashable], ports: Ports) -> str:
    return ", ".join(repr(names[i]) for i in ports)
