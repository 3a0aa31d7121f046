"""State equations as text for a terminal: matrices, else row by row, else by their structure."""

from collections.abc import Sequence
from typing import Literal, Protocol

import sympy as sp

from bondgraph.algebra.exact import rows_of
from bondgraph.show.blocks import Block, beside, column_block, matrix_block, sketch
from bondgraph.show.lines import wrapped
from bondgraph.show.sums import Term, rate, text_pieces

WIDTH = 100
"""Lines are at most about so long."""

MOST_STATES = 12
MOST_SIGNS = 4_000
"""Systems with more states, or longer text, are summarised."""

VECTORS = {"J": "x", "B": "u", "E": "u'", "F": "x", "D": "u", "G": "u'"}
"""What each matrix is multiplied with."""

MOST_NAMES = 8
"""Of longer lists the middle is counted only."""


class Space(Protocol):
    """A linear model in numbers; its arrays are P, Q, R, F, D and G."""

    @property
    def states(self) -> Sequence[str]:
        """Their names; so of inputs and outputs."""

    @property
    def inputs(self) -> Sequence[str]:
        """See ``states``."""

    @property
    def outputs(self) -> Sequence[str]:
        """See ``states``."""


class Matrices(Protocol):
    """What is shown: ``A x' = J x + B u + E u'``, ``y = F x + D u + G u'``."""

    @property
    def states(self) -> tuple[sp.Symbol, ...]:
        """The symbols of x."""

    @property
    def inputs(self) -> tuple[sp.Symbol, ...]:
        """The symbols of u."""

    @property
    def outputs(self) -> tuple[sp.Symbol, ...]:
        """The symbols of y."""

    @property
    def A(self) -> sp.ImmutableSparseMatrix:
        """States by states; so is J, while B and E have a column for each input."""

    @property
    def J(self) -> sp.ImmutableSparseMatrix:
        """States by states."""

    @property
    def B(self) -> sp.ImmutableSparseMatrix:
        """States by inputs."""

    @property
    def E(self) -> sp.ImmutableSparseMatrix:
        """States by inputs."""

    @property
    def F(self) -> sp.ImmutableSparseMatrix:
        """Outputs by states."""

    @property
    def D(self) -> sp.ImmutableSparseMatrix:
        """Outputs by inputs."""

    @property
    def G(self) -> sp.ImmutableSparseMatrix:
        """Outputs by inputs."""


Form = Literal["matrices", "rows", "structure"]
"""The forms of a text: whole matrices, one row after the other, sizes and places of entries."""


def equations_text(equations: Matrices) -> str:
    """Aligned matrices where they fit a line, else row by row; of large systems sizes and places."""
    return equations_shown(equations)[1]


def equations_shown(equations: Matrices) -> tuple[Form, str]:
    """The text and the form that it has."""
    if len(equations.states) > MOST_STATES or len(equations.outputs) > 2 * MOST_STATES:
        return "structure", summary(equations)
    blocks = _blocks(equations)
    if max((len(line) for block in blocks for line in block), default=0) <= WIDTH:
        return "matrices", "\n\n".join("\n".join(block) for block in blocks)
    text = "\n".join(line for row in rows_of_terms(equations) for line in written(*row))
    return ("rows", text) if len(text) <= MOST_SIGNS else ("structure", summary(equations))


def right_sides(
    equations: Matrices,
) -> tuple[list[tuple[str, sp.Matrix, Sequence[sp.Symbol]]], ...]:
    """The products on the right of both equations whose matrix is not zero: letter, matrix, vector."""
    x, u = equations.states, equations.inputs
    rates = [rate(name) for name in u]
    upper = [("J", equations.J, x), ("B", equations.B, u), ("E", equations.E, rates)]
    lower = [("F", equations.F, x), ("D", equations.D, u), ("G", equations.G, rates)]
    return tuple([part for part in parts if part[1].todok()] for parts in (upper, lower))


def _blocks(equations: Matrices) -> list[Block]:
    upper, lower = right_sides(equations)
    blocks = []
    if equations.states:
        rates = column_block(rate(name) for name in equations.states)
        blocks.append(beside(matrix_block(equations.A), " ", rates, *_products(upper)))
    if equations.outputs:
        blocks.append(beside(column_block(equations.outputs), *_products(lower)))
    return blocks


def _products(parts: Sequence[tuple[str, sp.Matrix, Sequence[sp.Symbol]]]) -> list[Block | str]:
    result: list[Block | str] = []
    for _, matrix, vector in parts:
        result += [" + " if result else " = ", matrix_block(matrix), " ", column_block(vector)]
    return result or [" = 0"]


def rows_of_terms(equations: Matrices) -> list[tuple[list[Term], list[Term]]]:
    """Each row of both equations as its left and right side."""
    upper, lower = right_sides(equations)
    lefts = _rows(equations.A, [rate(name) for name in equations.states])
    one = sp.Integer(1)
    outputs = [[(one, name)] for name in equations.outputs]
    return [*zip(lefts, _sums(upper, len(lefts)), strict=True),
            *zip(outputs, _sums(lower, len(outputs)), strict=True)]  # fmt: skip


def _sums(
    parts: Sequence[tuple[str, sp.Matrix, Sequence[sp.Symbol]]], count: int
) -> list[list[Term]]:
    """The right sides of so many rows."""
    result: list[list[Term]] = [[] for _ in range(count)]
    for _, matrix, vector in parts:
        for row, terms in zip(result, _rows(matrix, vector), strict=True):
            row += terms
    return result


def _rows(matrix: sp.Matrix, names: Sequence[sp.Symbol]) -> list[list[Term]]:
    return [[(row[j], names[j]) for j in sorted(row)] for row in rows_of(matrix)]


def written(left: Sequence[Term], right: Sequence[Term]) -> list[str]:
    """``left = right`` on as many lines as it needs, later ones indented."""
    pieces = text_pieces(left) + [f"= {piece}" if at == 0 else piece
                                  for at, piece in enumerate(text_pieces(right))]  # fmt: skip
    return wrapped(pieces, WIDTH, "    ")


def summary(equations: Matrices) -> str:
    """Sizes, names, how many entries each matrix has, and where those of A and J stand."""
    upper, lower = right_sides(equations)
    lines = [structure(equations)]
    for letter, what, names in (
        ("x", "state", equations.states), ("u", "input", equations.inputs),
        ("y", "output", equations.outputs),
    ):  # fmt: skip
        if names:
            lines.append(f"  {letter}: {counted(len(names), what)}: {listed(names)}")
    matrices = [("A", equations.A, ()), *upper, *lower]
    counts = [f"{name} {m.rows} x {m.cols}: {len(m.todok())}" for name, m, _ in matrices]
    lines.append(f"  entries that are not zero: {',  '.join(counts)}")
    if equations.states:
        n = len(equations.states)
        drawn = [(name, matrix) for name, matrix, _ in matrices if name in "AJ"]
        pictures: list[Block | str] = []
        for name, matrix in drawn:
            pictures += ["    ", (name, *sketch(matrix.todok(), n, n))]
        lines += ["", *beside(*pictures)]
    return "\n".join(lines)


def structure(equations: Matrices) -> str:
    """Both equations with the letters of those matrices that are not zero."""
    upper, lower = (
        " + ".join(f"{letter} {VECTORS[letter]}" for letter, *_ in side) or "0"
        for side in right_sides(equations)
    )
    parts = [f"A x' = {upper}"] if equations.states else []
    return ",   ".join([*parts, f"y = {lower}"] if equations.outputs else parts)


def listed(names: Sequence[object]) -> str:
    """Names with commas, the middle of a long list left out."""
    texts = [str(name) for name in names]
    if len(texts) > MOST_NAMES:
        texts = [*texts[: MOST_NAMES - 3], "...", *texts[-2:]]
    return ", ".join(texts)


def counted(count: int, what: str, many: str | None = None) -> str:
    """A number of things.

    >>> counted(1, "state"), counted(2, "state")
    ('1 state', '2 states')
    """
    return f"{count} {what if count == 1 else many or what + 's'}"
