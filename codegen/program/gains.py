"""Laws that determine one another, and whether they determine anything: loops whose gain is 1."""

from collections.abc import Iterator, Mapping

import sympy as sp

from bondgraph.algebra.elimination import ResidueRows
from bondgraph.algebra.residues import residues
from bondgraph.errors import AlgebraicLoopError
from bondgraph.reduce.motion import slope_of
from codegen.program.records import Block, Group, Program

Numbers = Mapping[str, sp.Rational]


def check_gains(program: Program, parameters: Numbers | None = None) -> None:
    """Refuse a loop of laws that nothing determines: the slopes of ``u - law(u)`` have no full rank.

    Decided exactly, whatever the signals are; with ``parameters`` at these numbers. ``F = F`` holds for
    every F, ``F = F + 1`` for none.
    """
    known = parameters or {}
    for group in (*program.groups, program.coupled):
        if group.loop and group.inputs and not _determined(program, group, known):
            names = ", ".join(str(program.inputs[j]) for j in group.inputs)
            ports = ", ".join(map(repr, group.ports))
            where = "at these parameters " if known else ""
            raise AlgebraicLoopError(
                f"{where}the laws at {ports} give {names} from {names} alone with a loop gain of 1: any "
                "value or none will do, so nothing determines it; let a law read another signal, or put a "
                "storage between"
            )


def _determined(program: Program, group: Group, known: Numbers) -> bool:
    """Whether the slopes of a loop have full rank for two random points."""
    laws = written_out(group.values)
    direct_rows = dict(shown(program, "D"))
    rows: list[dict[int, sp.Expr]] = []
    for at, law in enumerate(laws):
        own = {at: sp.Integer(1)}
        for name in sorted(law.free_symbols, key=str):
            direct = {j: sp.Integer(1)} if (j := _input(program, name)) is not None else {}
            for column, factor in (direct_rows.get(name) or direct).items():
                if column in group.inputs:
                    place = group.inputs.index(column)
                    own[place] = own.get(place, sp.Integer(0)) - slope_of(law, name) * factor
        rows.append(own)
    if any(program.layout["H"].rows):
        # What shows x' depends on inputs by way of A, too: left to the search for a solution.
        return True
    try:
        return any(_full_rank(rows, known, seed) for seed in (0, 1))
    except ZeroDivisionError:
        return True


def _full_rank(rows: list[dict[int, sp.Expr]], known: Numbers, seed: int) -> bool:
    value = residues(seed)

    def at(entry: sp.Expr) -> int:
        numbers = {s: known[s.name] for s in entry.free_symbols if s.name in known}
        return value(entry.xreplace(numbers))

    found = [{j: at(entry) for j, entry in row.items()} for row in rows]
    exact = ResidueRows({j: entry for j, entry in row.items() if entry} for row in found)
    return all(exact.pivot(i, jordan=False) for i in range(len(rows)))


def _input(program: Program, name: sp.Symbol) -> int | None:
    return program.inputs.index(name) if name in program.inputs else None


def shown(program: Program, letter: str) -> Iterator[tuple[sp.Symbol, dict[int, sp.Expr]]]:
    """Every reading's row of one of the matrices F, D, H, K."""
    entries, start = written_out(program.coefficients), 0
    rows: list[dict[int, sp.Expr]] = [{} for _ in program.readings]
    for one, pattern in program.layout.items():
        end = start + len(pattern.rows)
        if one == letter:
            for i, j, entry in zip(pattern.rows, pattern.columns, entries[start:end], strict=True):
                rows[i][j] = entry
        start = end
    yield from zip(program.readings, rows, strict=True)


def written_out(block: Block) -> list[sp.Expr]:
    """A block's results without temporaries."""
    results = list(block.results)
    for name, value in reversed(block.assignments):
        results = [result.xreplace({name: value}) for result in results]
    return results
