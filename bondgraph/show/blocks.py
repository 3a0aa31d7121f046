"""Matrices and vectors as blocks of text that stand beside one another."""

from collections.abc import Iterable, Mapping, Sequence

import sympy as sp

from bondgraph.show.plain import plain

Block = tuple[str, ...]
"""Lines of equal length."""

MOST_CELLS = 24
"""A sketch has at most so many rows and columns."""


def matrix_block(matrix: sp.Matrix, missing: str = "0") -> Block:
    """A matrix with aligned columns, each row in brackets.

    >>> print(*matrix_block(sp.Matrix([["a + b", -1], [0, "a"]])), sep="\\n")
    [ a + b  -1 ]
    [     0   a ]
    """
    entries = matrix.todok()
    rows = [
        [plain(entries[i, j]) if (i, j) in entries else missing for j in range(matrix.cols)]
        for i in range(matrix.rows)
    ]
    return bracketed(rows)


def column_block(names: Iterable[object]) -> Block:
    """A vector of names as a column."""
    return bracketed([[str(name)] for name in names], space="")


def bracketed(rows: Sequence[Sequence[str]], space: str = " ") -> Block:
    """Cells with aligned columns, each row in brackets."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = []
    for row in rows:
        cells = "  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True))
        lines.append(f"[{space}{cells}{space}]")
    return tuple(lines)


def beside(*blocks: Block | str) -> Block:
    """Blocks side by side, each in the middle of the highest; a text is a block of one line.

    >>> print(*beside(("1", "2", "3"), " = ", ("x",)), sep="\\n")
    1
    2 = x
    3
    """
    parts = [(block,) if isinstance(block, str) else block for block in blocks]
    height = max(map(len, parts))
    lines = [""] * height
    for block in parts:
        width = max(map(len, block), default=0)
        above = (height - len(block)) // 2
        for at in range(height):
            inside = above <= at < above + len(block)
            lines[at] += (block[at - above] if inside else "").ljust(width)
    return tuple(line.rstrip() for line in lines)


def sketch(entries: Mapping[tuple[int, int], sp.Expr], rows: int, columns: int) -> Block:
    """Where a matrix has entries; of a large one each cell stands for several rows and columns.

    >>> print(*sketch({(0, 0): 1, (1, 2): 1}, 2, 3), sep="\\n")
    x . .
    . . x
    """
    per_row, per_column = -(-rows // MOST_CELLS), -(-columns // MOST_CELLS)
    filled = {(i // per_row, j // per_column) for i, j in entries}
    return tuple(
        " ".join("x" if (i, j) in filled else "." for j in range(-(-columns // per_column)))
        for i in range(-(-rows // per_row))
    )


def aligned(rows: Sequence[Sequence[str]]) -> list[str]:
    """Rows as lines: the first column to the left, the others to the right.

    >>> aligned([("", "first"), ("omega", "2")])
    ['         first', '  omega      2']
    """
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = []
    for first, *others in rows:
        cells = [cell.rjust(width) for cell, width in zip(others, widths[1:], strict=True)]
        lines.append("  ".join(["", first.ljust(widths[0]), *cells]).rstrip())
    return lines
