"""A derivation as aligned plain text."""

from collections.abc import Iterator, Sequence

from bondgraph.equations import StateEquations
from bondgraph.explaining.layout import first_few, fits, heading, shortened
from bondgraph.explaining.records import Equation, Factor, Formula, Step
from bondgraph.show.blocks import Block, beside, matrix_block
from bondgraph.show.display import WIDTH, counted, equations_shown
from bondgraph.show.lines import words, wrapped
from bondgraph.show.sums import Sum, text_pieces

WIDEST_MATRIX = 120
"""Wider matrices are told by their size."""

LONGEST_NODE = 18
LONGEST_LEFT = 48
"""Longer names and left sides stand out of their columns."""


def text_of(steps: Sequence[Step], result: StateEquations, limit: int | None) -> str:
    """The steps under their titles, equations numbered and aligned at their first ``=``."""
    first, *rest = heading(result)
    lines = [first, *(f"  {line}" for line in rest)]
    for number, step in enumerate(steps, 1):
        lines += ["", f"{number}. {step.title}"]
        lines += _step(step, fits(result, limit), limit)
    return "\n".join([*lines, *_ending(result)])


def _ending(result: StateEquations) -> Iterator[str]:
    """The equations in matrices, or their structure; rows have been shown."""
    form, text = equations_shown(result)
    if text and form != "rows":
        yield from ("", "In matrices", "")
        yield from (f"  {line}".rstrip() for line in text.splitlines())


def _step(step: Step, matrices: bool, limit: int | None) -> Iterator[str]:
    sentences, more = first_few(step.sentences, limit)
    for sentence in sentences:
        first, *rest = words(sentence)
        yield from wrapped([f"  - {first}", *rest], WIDTH, "    ")
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
        label = f"  {number}  {node}  "
        rights = [_joined(side, limit) for side in one.sides[1:]]
        line = " = ".join([f"{label}{left.strip():>{widths[2]}}", *rights])
        if len(line) <= WIDTH:
            yield line
        else:
            yield from _broken(label, widths[2], one, limit)


def _broken(label: str, width: int, one: Equation, limit: int | None) -> Iterator[str]:
    """Each further side on a line of its own, or several, below one another."""
    left = wrapped(_pieces(one.sides[0], limit), WIDTH - len(label), "  ")
    head = f"{label}{left[0]:>{width}}"
    column = len(label) + width
    if len(left) > 1 or len(head) > column:
        yield head
        column = len(label) + 2
        yield from (f"{' ' * len(label)}{line}" for line in left[1:])
        head = " " * column
    for side in one.sides[1:]:
        for count, line in enumerate(wrapped(_pieces(side, limit), WIDTH - column - 3, "  ")):
            yield f"{head} {'=' if count == 0 else ' '} {line}"
            head = " " * column


def _pieces(side: Sum, limit: int | None) -> list[str]:
    terms, more = shortened(side, limit, "<{} operations>")
    pieces = text_pieces(terms)
    return [*pieces, f"... ({more} more terms)"] if more else pieces


def _joined(side: Sum, limit: int | None) -> str:
    return " ".join(_pieces(side, limit))


def _width(cells: Sequence[str], most: int) -> int:
    return max((len(cell) for cell in cells if len(cell) <= most), default=0)


def _formula(formula: Formula, matrices: bool) -> Iterator[str]:
    products = [" ".join(factor.text for factor in product) for product in formula.products]
    yield f"  ({formula.number})  {formula.left.text} = {' + '.join(products)}"
    if matrices:
        parts: list[Block | str] = ["  = "]
        for at, product in enumerate(formula.products):
            parts += [" + "] if at else []
            for place, factor in enumerate(product):
                parts += [" "] if place else []
                parts.append(matrix_block(factor.matrix))
        block = beside(*parts)
        yield ""
        if max(map(len, block)) <= WIDTH:
            yield from (f"     {line}" for line in block)
            return
    for factor in {one.text: one for product in formula.products for one in product}.values():
        yield from _matrix(factor, matrices)


def _matrix(factor: Factor, matrices: bool) -> Iterator[str]:
    """One matrix under its name, or its size."""
    block = beside(f"{factor.text} = ", matrix_block(factor.matrix)) if matrices else ()
    if matrices and max(map(len, block)) <= WIDEST_MATRIX:
        yield from (f"     {line}" for line in block)
        yield ""
        return
    entries = counted(len(factor.matrix.todok()), "entry", "entries")
    yield f"       {factor.text}: {factor.matrix.rows} x {factor.matrix.cols}, {entries}"
