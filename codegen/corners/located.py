"""Corners and jumps of a program's laws: what each hangs on, and the laws on one side of each.

``Abs(a)`` has a corner where ``a`` is zero, ``Max(a, b)`` where ``a - b`` is, a `Piecewise` where what its
conditions compare is equal. On either side a law goes on smoothly, beyond the corner, too: a step that is
taken on one side keeps its order up to where ``a`` is zero, however far beyond that its stages look.
"""

from collections.abc import Hashable, Iterable, Iterator
from dataclasses import replace

import sympy as sp

from codegen.corners.branches import KINDS, Branch, Sided
from codegen.corners.tabled import ends_of
from codegen.program.gains import shown, written_out
from codegen.program.records import Block, Corners, Program, block

SIDE = "side_"
"""What a side is called, with a number; no result shows it."""


def with_corners(program: Program) -> Program:
    """The program with the corners of its laws; the same where there are none.

    Not those of parameters, of known sources alone, whose instants are known, of what stays between instants,
    nor the slips of friction ports, which are events anyway.
    """
    if not any(expr.has(*KINDS) for code in program.blocks for expr in code.values):
        return program
    sides, named = _Sides(program), [one for one in _laws(program) if one[1].has(*KINDS)]
    for node, expr in named:
        sides.owner = node
        sides.sided.put(expr)
    if not sides.sizes:
        return program
    arguments = sides.arguments()
    ways = _ways(map(sides.sided.put, (expr for _, expr in named)), sides.symbols, arguments)
    known = _told(program)
    own = [
        *program.parameters,
        *program.external,
        *program.inputs,
        *program.readings,
        *sides.symbols,
    ]

    def values(found: Iterable[sp.Expr], active: Iterable[sp.Expr]) -> Block:
        return block([*(expr.xreplace(known) for expr in found), *active], own)

    def sided(code: Block) -> Block:
        laws = written_out(code)
        put = [sides.sided.put(expr) for expr in laws]
        return code if put == laws else block(put, own)

    count = len(arguments)
    # Conditions of switches are watched by themselves, and impulses go over corners.
    blocks = (*map(sided, program.blocks[:-2]), program.guards)
    corners = Corners(
        tuple(sides.symbols),
        tuple(sides.nodes),
        values(sides.sizes, [sp.Integer(1)] * count),
        blocks,
        values(arguments, [_active(way) for way in ways]),
        tuple(ends_of(list(sides.sizes))),
    )
    return replace(program, corners=corners)


class _Sides:
    """The sides that were found so far, each of what it hangs on."""

    def __init__(self, program: Program) -> None:
        slips = {program.readings[port.received] for port in program.friction}
        slips |= {program.readings[port.reading] for port in program.friction}
        self._apart = slips | {-slip for slip in slips}
        self._still = {*program.parameters, *program.external[len(program.asked) :]}
        self._still |= program.equations.kept
        names = {*program.parameters, *program.external, *program.inputs, *program.readings}
        names |= {*program.states, *program.law_states}
        self._taken = {name.name for name in names}
        self.sided = Sided(self._of)
        self.owner: Hashable = None
        self.sizes: dict[sp.Expr, sp.Symbol] = {}
        self.nodes: list[Hashable] = []

    @property
    def symbols(self) -> list[sp.Symbol]:
        """All of them."""
        return list(self.sizes.values())

    def arguments(self) -> list[sp.Expr]:
        """What each hangs on, itself on one side of each of its own corners."""
        found: list[sp.Expr] = []
        # What a side hangs on may have corners of its own, which have sides then.
        while len(found) < len(self.sizes):
            self.owner = self.nodes[len(found)]
            found.append(self.sided.put(list(self.sizes)[len(found)]))
        return found

    def _of(self, size: sp.Expr) -> tuple[sp.Symbol, int] | None:
        if not size.free_symbols - self._still or size in self._apart:
            return None
        content, plain = sp.expand(size).as_content_primitive()
        way = 1 if content.is_positive else -1
        if plain.could_extract_minus_sign():
            plain, way = -plain, -way
        if plain not in self.sizes:
            self.sizes[plain] = self._new()
            self.nodes.append(self.owner)
        return self.sizes[plain], way

    def _new(self) -> sp.Symbol:
        name = f"{SIDE}{len(self.sizes) + 1}"
        while name in self._taken:
            name += "_"
        self._taken.add(name)
        return sp.Symbol(name)


def _laws(program: Program) -> Iterator[tuple[Hashable, sp.Expr]]:
    """What is evaluated in a run, with the node of each."""
    for group in (program.known, *program.groups, program.coupled):
        yield from zip(group.ports, written_out(group.values), strict=True)
    ports = [port.name for port in program.friction for _ in range(4)]
    yield from zip(ports, written_out(program.friction_values), strict=True)
    for expr in written_out(program.coefficients):
        yield _modulated(program, expr) if expr.has(*KINDS) else None, expr
    yield from zip(program.known.ports, written_out(program.known_rates), strict=True)


def _modulated(program: Program, expr: sp.Expr) -> Hashable:
    """The node whose value has the corners of a coefficient."""
    kinds = expr.atoms(*KINDS)
    for name, element in program.equations.elements.items():
        value = element.value
        if value is not None and value.atoms(*KINDS) & kinds:
            return name
    return next(iter(program.equations.elements))


def _told(program: Program) -> dict[sp.Symbol, sp.Expr]:
    """Readings that are sums of states by constant factors, written out: they take no evaluation."""
    rows = {letter: dict(shown(program, letter)) for letter in "FDHK"}
    still = {*program.parameters}
    found: dict[sp.Symbol, sp.Expr] = {}
    for name in program.readings:
        row = rows["F"][name]
        if any(rows[letter][name] for letter in "DHK") or name in program.states:
            continue
        if row and not set().union(*(entry.free_symbols for entry in row.values())) - still:
            found[name] = sp.Add(*(entry * program.states[j] for j, entry in row.items()))
    return found


Way = frozenset[tuple[sp.Symbol, int]]
"""On which sides of others one is for a branch to be taken."""


def _ways(
    laws: Iterable[sp.Expr], sides: list[sp.Symbol], arguments: list[sp.Expr]
) -> list[set[Way]]:
    """For each side the ways to where it is asked for."""
    found: dict[sp.Symbol, set[Way]] = {side: set() for side in sides}
    hangs, named = dict(zip(sides, arguments, strict=True)), set(sides)

    def count(side: sp.Symbol, way: Way) -> None:
        if not {(side, 1), (side, -1)} & way and not any(known <= way for known in found[side]):
            found[side] = {known for known in found[side] if not way <= known} | {way}
            walk(hangs[side], way)

    def walk(expr: sp.Expr, way: Way) -> None:
        if expr in found:
            count(expr, way)
        if not (isinstance(expr, Branch) and expr.args[0] in found):
            for part in expr.args if expr.free_symbols & named else ():
                walk(part, way)
            return
        side, above, below = expr.args
        if (side, -1) not in way:
            walk(above, way | {(side, 1)})
        if (side, 1) not in way:
            walk(below, way | {(side, -1)})
        count(side, way)

    for law in laws:
        walk(law, frozenset())
    return [found[side] for side in sides]


def _active(ways: set[Way]) -> sp.Expr:
    """1 where a side is asked for, else 0."""
    one, found = sp.Integer(1), sp.Integer(0)
    for way in sorted(ways, key=lambda way: sorted((side.name, of) for side, of in way)):
        here: sp.Expr = one
        for side, of in sorted(way, key=lambda part: part[0].name):
            here = Branch(side, here, found) if of > 0 else Branch(side, found, here)
        found = here
    return found
