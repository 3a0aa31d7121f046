"""What storages hold as starts of exported programs, which may be given other parameters."""

from dataclasses import dataclass
from functools import cached_property

import sympy as sp

from codegen.model.starts import laws_of_held
from codegen.program.records import Block, Program


@dataclass(frozen=True)
class Holdings:
    """What a start may tell of independent storages, ``p_m`` and ``q_C``, and how states follow from it.

    ``names`` in turn. ``rows``: the places of the states that each is a sum of. ``by_law``: whether a law
    gives the only one of them instead. ``values``: row after row the coefficients, and what laws give; these
    read what is held at the place of the state.
    """

    names: tuple[str, ...]
    rows: tuple[tuple[int, ...], ...]
    by_law: tuple[bool, ...]
    values: Block

    @cached_property
    def begins(self) -> tuple[int, ...]:
        """Where each one's values begin, and their end."""
        found = [0]
        for row in self.rows:
            found.append(found[-1] + len(row))
        return tuple(found)

    @property
    def places(self) -> tuple[int, ...]:
        """All rows one after the other."""
        return tuple(place for row in self.rows for place in row)


def holdings(program: Program) -> Holdings:
    """Those of a program that its parameters tell."""
    equations, known = program.equations, {*program.parameters}
    places = {name: at for at, name in enumerate(program.states)}
    owners = {port.element.co_energy for port in equations.reduction.structure.ports}
    laws = laws_of_held(equations)
    found: list[tuple[str, tuple[int, ...], bool]] = []
    values: list[sp.Expr] = []
    for name, expr in equations.held.items():
        if name in laws:
            state, law = laws[name]
            if state in places and law.free_symbols <= known | {name}:
                found.append((name.name, (places[state],), True))
                values.append(law.xreplace({name: state}))
            continue
        terms = {one: expr.coeff(one) for one in sorted(expr.free_symbols & owners, key=str)}
        told = {part for value in terms.values() for part in value.free_symbols}
        rest = sp.expand(expr - sp.Add(*(value * one for one, value in terms.items())))
        if terms and terms.keys() <= places.keys() and told <= known and rest == 0:
            found.append((name.name, tuple(places[one] for one in terms), False))
            values += terms.values()
    names, rows, by_law = zip(*found, strict=True) if found else ((), (), ())
    read = set[sp.Symbol]().union(*(value.free_symbols for value in values))
    code = Block(tuple(sorted(read, key=str)), (), tuple(values))
    return Holdings(names, rows, by_law, code)
