"""The slopes of a recording's rates in the integrated vector: line by line, by the chain rule."""

from functools import lru_cache
from types import MappingProxyType

import sympy as sp

from codegen.program.records import Block, block
from codegen.straight.sums import Line, Lines, Recording, Sum, Value

Slopes = dict[int, Value]
"""By the place of a component: how much more there is for each more of it."""


Places = tuple[tuple[int, ...], tuple[int, ...]]
"""Rows and columns of entries of a matrix."""


def with_slopes(recording: Recording) -> tuple[Recording, Places] | None:
    """A recording with a part "slopes", those of the rates that are not zero, and where these stand.

    Corners and jumps count for nothing beside them. None where lines call what has no formula.
    """
    if recording.loops:
        return None
    lines = Lines([*recording.lines])
    size, known = len(recording.parts["rate"]), dict[str, Slopes]()
    for at in range(size):
        known[f"s{at}"] = {at: 1.0}
    for line in recording.lines:
        for name, found in zip(line.names, _of_line(line, lines, known), strict=True):
            known[name] = found
    rows = [_of_sum(value, known) for value in recording.parts["rate"]]
    places = [(i, j) for i, row in enumerate(rows) for j, value in row.items() if value]
    slopes = tuple(rows[i][j] for i, j in places)
    where = tuple(i for i, _ in places), tuple(j for _, j in places)
    told = MappingProxyType({"slopes": slopes})
    return Recording(tuple(lines.listed), told, (), MappingProxyType({})), where


def _of_line(line: Line, lines: Lines, known: dict[str, Slopes]) -> list[Slopes]:
    inner = [_of_sum(value, known) for value in line.read]
    if line.code == "+":
        return inner
    if line.code == "*":
        one, other = (_owned(value, lines) for value in line.read)
        return [_added(_times(other, inner[0]), _times(one, inner[1]))]
    if line.code == "/":
        under, own = _owned(line.read[1], lines), lines.one(line.names[0])
        above = _added(inner[0], _times(-1.0, _times(own, inner[1])))
        return [{at: value / under for at, value in above.items()}]
    if not isinstance(line.code, Block):
        return []
    moving = tuple(at for at, slopes in enumerate(inner) if slopes)
    if not moving:
        return [{} for _ in line.names]
    code, places = partial_slopes(line.code, moving)
    found = lines.new(code, line.read, len(places)) if places else []
    result: list[Slopes] = [{} for _ in line.names]
    for (row, at), value in zip(places, found, strict=True):
        result[row] = _added(result[row], _times(value, inner[at]))
    return result


def _owned(value: Value, lines: Lines) -> Value:
    return Sum(lines, value.terms, value.constant) if isinstance(value, Sum) else value


def _of_sum(value: Value, known: dict[str, Slopes]) -> Slopes:
    found: Slopes = {}
    if isinstance(value, Sum):
        for name, factor in value.terms.items():
            found = _added(found, _times(factor, known.get(name, {})))
    return found


def _times(factor: Value, slopes: Slopes) -> Slopes:
    return {at: factor * value for at, value in slopes.items()}


def _added(one: Slopes, other: Slopes) -> Slopes:
    return {at: one.get(at, 0.0) + other.get(at, 0.0) for at in dict.fromkeys([*one, *other])}


def partial_slopes(
    code: Block, moving: tuple[int, ...]
) -> tuple[Block, tuple[tuple[int, int], ...]]:
    """The slopes of a block's results in some of its arguments that are not zero, and of which in which.

    The block has as many arguments, in the same order.
    """
    named: dict[sp.Basic, sp.Basic] = {
        name: sp.Symbol(f"_{at}", real=True) for at, name in enumerate(code.arguments)
    }
    for name, value in code.assignments:
        named[name] = value.xreplace(named)
    results = tuple(result.xreplace(named) for result in code.results)
    return _partial(results, len(code.arguments), moving)


@lru_cache(maxsize=256)
def _partial(
    results: tuple[sp.Expr, ...], count: int, moving: tuple[int, ...]
) -> tuple[Block, tuple[tuple[int, int], ...]]:
    """The same of results in ``_0``, ``_1`` ..: laws that are alike are differentiated once."""
    names = tuple(sp.Symbol(f"_{at}", real=True) for at in range(count))
    found, places = list[sp.Expr](), list[tuple[int, int]]()
    for row, result in enumerate(results):
        for at in moving:
            slope = _plain(sp.diff(result, names[at]))
            if slope != 0:
                found.append(slope)
                places.append((row, at))
    made = block(found, names)
    return Block(names, made.assignments, made.results), tuple(places)


def _plain(slope: sp.Expr) -> sp.Expr:
    """Steps by signs, and nothing of what is only at a jump."""
    if not slope.has(sp.DiracDelta, sp.Heaviside):
        return slope
    slope = slope.replace(sp.DiracDelta, lambda *_: sp.S.Zero)
    return slope.replace(sp.Heaviside, lambda x, *_: (1 + sp.sign(x)) / 2)
