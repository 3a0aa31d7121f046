"""A derivation as aligned plain text."""

from collections.abc import Iterator, Sequence

from bondgraph.blocks import Block, beside, matrix_block
from bondgraph.display import WIDTH, equations_text, wrapped
from bondgraph.equations import StateEquations
from bondgraph.explaining.layout import first_few, fits, heading, shortened
from bondgraph.explaining.records import Equation, Formula, Step
from bondgraph.sums import Sum, text_pieces

LONGEST_NODE = 18
LONGEST_LEFT = 30
"""Longer names and left sides stand out of their columns."""


def text_of(steps: Sequence[Step], result: StateEquations, limit: int | None) -> str:
    """The steps under their titles, equations numbered and aligned at their first ``=``."""
    first, *rest = heading(result)
    lines = [first, *(f"  {line}" for line in rest)]
    for number, step in enumerate(steps, 1):
        lines += ["", f"{number}. {step.title}"]
        lines += _step(step, fits(result, limit), limit)
    return "\n".join([*lines, "", _ending(result), ""])


def _ending(result: StateEquations) -> str:
    lines = (f"  {line}".rstrip() for line in equations_text(result).splitlines())
    return "\n".join(["In matrices", "", *lines])


def _step(step: Step, matrices: bool, limit: int | None) -> Iterator[str]:
    sentences, more = first_few(step.sentences, limit)
    for sentence in sentences:
        yield from wrapped([f"  - {sentence.split()[0]}", *sentence.split()[1:]], WIDTH, "    ")
    if more:
        yield f"  ... and {more} more"
    equations, more = first_few(step.equations, limit)
    yield from _equations(equations, limit)
    if more:
        yield f"  ... and {more} more, up to ({step.equations[-1].number})"
    for formula in step.formulas:
        yield from _formula(formula, matrices)


def _equations(equations: Sequence[Equation], limit: int | None) -> Iterator[str]:
    numbers = [f"({one.number})" for one in equations]
    nodes = ["" if one.node is None else str(one.node) for one in equations]
    lefts = [_joined(one.sides[0], limit) for one in equations]
    widths = [
        _width(numbers, WIDTH), _width(nodes, LONGEST_NODE), _width(lefts, LONGEST_LEFT),
    ]  # fmt: skip
    for one, *cells in zip(equations, numbers, nodes, lefts, strict=True):
        number, node, left = (cell.ljust(width) for cell, width in zip(cells, widths, strict=True))
        head = f"  {number}  {node}  {left.strip():>{widths[2]}}"
        rights = [_joined(side, limit) for side in one.sides[1:]]
        line = " = ".join([head, *rights])
        if len(line) <= WIDTH:
            yield line
            continue
        yield from _broken(head, one, limit)


def _broken(head: str, one: Equation, limit: int | None) -> Iterator[str]:
    """Each further side on a line of its own, or several, below one another."""
    column = min(len(head), WIDTH // 2)
    for at, side in enumerate(one.sides[1:]):
        pieces, more = shortened(text_pieces(side), limit)
        if more:
            pieces.append(f"... ({more} more terms)")
        for count, line in enumerate(wrapped(pieces, WIDTH - column, "")):
            start = head if at == count == 0 else " " * column
            yield f"{start} {'=' if count == 0 else ' '} {line}"


def _joined(side: Sum, limit: int | None) -> str:
    pieces, more = shortened(text_pieces(side), limit)
    return " ".join(pieces) + (f" ... ({more} more terms)" if more else "")


def _width(cells: Sequence[str], most: int) -> int:
    return max((len(cell) for cell in cells if len(cell) <= most), default=0)


def _formula(formula: Formula, matrices: bool) -> Iterator[str]:
    products = [" ".join(factor.text for factor in product) for product in formula.products]
    yield f"  ({formula.number})  {formula.left.text} = {' + '.join(products)}"
    if not matrices:
        sizes = dict.fromkeys(
            f"{one.text} {one.matrix.rows} x {one.matrix.cols} with {len(one.matrix.todok())} entries"
            for product in formula.products
            for one in product
        )
        yield f"       {', '.join(sizes)}"
        return
    parts: list[Block | str] = ["  = "]
    for at, product in enumerate(formula.products):
        parts += [" + "] if at else []
        for place, factor in enumerate(product):
            parts += [" "] if place else []
            parts.append(matrix_block(factor.matrix))
    block = beside(*parts)
    if max(map(len, block)) <= WIDTH:
        yield ""
        yield from (f"     {line}" for line in block)
        return
    for factor in {one.text: one for product in formula.products for one in product}.values():
        yield ""
        named = beside(f"{factor.text} = ", matrix_block(factor.matrix))
        yield from (f"     {line}" for line in named)
