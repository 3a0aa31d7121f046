"""The matrices of equations as LaTeX."""

import sympy as sp

from bondgraph.show.display import MOST_SIGNS, MOST_STATES, Matrices, structure
from bondgraph.show.sums import typeset

RATE = r"\frac{d}{dt}"


def matrices_latex(equations: Matrices) -> str:
    """``A dx/dt = J x + B u + E du/dt`` and ``y = F x + D u + G du/dt``, zero matrices left out."""
    x, u, y = (
        typeset(sp.Matrix(names))
        for names in (equations.states, equations.inputs, equations.outputs)
    )
    lines = []
    if equations.states:
        left = typeset(sp.Matrix(equations.A)) + RATE + x
        lines.append(f"{left} = {_sum(equations, ('J', x), ('B', u), ('E', RATE + u))}")
    if equations.outputs:
        lines.append(f"{y} = {_sum(equations, ('F', x), ('D', u), ('G', RATE + u))}")
    return " \\\\\n".join(lines)


def _sum(equations: Matrices, *terms: tuple[str, str]) -> str:
    """The products of those matrices that are not zero."""
    shown = [(getattr(equations, name), vector) for name, vector in terms]
    products = [typeset(sp.Matrix(matrix)) + vector for matrix, vector in shown if matrix.todok()]
    return " + ".join(products) or "0"


def notebook_matrices(equations: Matrices) -> str:
    """The matrices for a notebook's display; of large systems the sizes alone, of none nothing."""
    text = matrices_latex(equations) if is_readable(equations) else sizes_latex(equations)
    return rf"$$\begin{{gathered}} {text} \end{{gathered}}$$" if text else ""


def is_readable(equations: Matrices) -> bool:
    """Whether the matrices are small enough to be shown."""
    if len(equations.states) > MOST_STATES or len(equations.outputs) > 2 * MOST_STATES:
        return False
    return len(matrices_latex(equations)) <= MOST_SIGNS


def sizes_latex(equations: Matrices) -> str:
    """The structure, and how many entries each matrix has."""
    counts = {name: len(getattr(equations, name).todok()) for name in "AJBEFDG"}
    sizes = r",\; ".join(
        rf"{name} \in \mathbb{{R}}^{{{m.rows} \times {m.cols}}}\ (\text{{{counts[name]} entries}})"
        for name in counts
        if counts[name]
        for m in [getattr(equations, name)]
    )
    names = {"x'": r"\dot{x}", "u'": r"\dot{u}"}
    told = " ".join(names.get(word, word) for word in structure(equations).split())
    return rf"{told} \\ {sizes}"
