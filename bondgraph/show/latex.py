"""The whole equations as LaTeX: the matrices, what stands beside them, and everything put in."""

from collections.abc import Iterable, Iterator

from bondgraph.equations import StateEquations
from bondgraph.show.display import MOST_SIGNS
from bondgraph.show.latex_matrices import is_readable, matrices_latex, notebook_matrices
from bondgraph.show.statements import Statement, statements, without_functions, without_idle
from bondgraph.show.sums import latex_pieces
from bondgraph.show.ways_latex import ways_latex
from bondgraph.show.whole import PUT_IN, TOO_LONG, put_in

LONGEST_LINE = 6
"""Terms on one line of a right side."""


def equations_latex(equations: StateEquations) -> str:
    """The matrices, then laws, sources and further states, and every equation with these put in."""
    equations = without_functions(equations)
    parts = (matrices_latex(without_idle(equations)), *beside(equations))
    return " \\\\\n".join(part for part in parts if part)


def beside(equations: StateEquations) -> list[str]:
    """What stands beside the matrices, as lines of LaTeX; none where these say all."""
    found = statements(equations)
    stated = aligned((*found.given, *found.rates))
    closed = aligned(put_in(equations, found))
    lines = [*([stated] if stated else []), *ways_latex(equations)]
    if lines and (equations.states or equations.outputs):
        lines.insert(0, r"\text{where}")
    if len(closed) > MOST_SIGNS:
        return [*lines, rf"\text{{{TOO_LONG}}}"]
    return [*lines, rf"\text{{{PUT_IN}}}", closed] if closed else lines


def aligned(stated: Iterable[Statement]) -> str:
    """Equations below one another at their signs of equality; of none nothing."""
    rows = [row for one in stated for row in _rows(one)]
    body = " \\\\\n".join(rows)
    return rf"\begin{{aligned}} {body} \end{{aligned}}" if rows else ""


def _rows(one: Statement) -> Iterator[str]:
    pieces = latex_pieces(one.right)
    first, *more = (
        " ".join(pieces[at : at + LONGEST_LINE]) for at in range(0, len(pieces), LONGEST_LINE)
    )
    yield f"{' '.join(latex_pieces(one.left_terms))} &= {first}"
    yield from (rf"&\quad {line}" for line in more)


def notebook_latex(equations: StateEquations) -> str:
    """The equations for a notebook's display; of large systems the sizes alone."""
    equations = without_functions(equations)
    if is_readable(equations):
        text = equations_latex(equations)
        if len(text) <= 4 * MOST_SIGNS:
            return rf"$$\begin{{gathered}} {text} \end{{gathered}}$$" if text else ""
    return notebook_matrices(equations)
