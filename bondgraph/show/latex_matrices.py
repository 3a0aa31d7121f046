"""The matrices of equations as LaTeX."""

import sympy as sp

from bondgraph.show.display import MOST_SIGNS, MOST_STATES, Matrices, Space, structure
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


def space_latex(space: Space) -> str:
    """``dx/dt = P x + Q u + R du/dt`` and ``y = F x + D u + G du/dt`` in numbers of five digits."""
    x, u, y = (
        typeset(sp.Matrix([sp.Symbol(name) for name in names]))
        for names in (space.states, space.inputs, space.outputs)
    )
    lines = []
    if space.states:
        lines.append(f"{RATE}{x} = {_products(space, ('P', x), ('Q', u), ('R', RATE + u))}")
    if space.outputs:
        lines.append(f"{y} = {_products(space, ('F', x), ('D', u), ('G', RATE + u))}")
    return " \\\\\n".join(lines)


def _products(space: Space, *terms: tuple[str, str]) -> str:
    """The products of those arrays that are not zero."""
    shown = [(getattr(space, name), vector) for name, vector in terms]
    rows = [(array.tolist(), vector) for array, vector in shown if array.size and array.any()]
    told = [(sp.Matrix([[_digits(one) for one in row] for row in table]), v) for table, v in rows]
    return " + ".join(typeset(matrix) + vector for matrix, vector in told) or "0"


def _digits(value: float) -> sp.Expr:
    """A number of five digits; a whole one without a point."""
    return sp.Integer(int(value)) if value == int(value) else sp.Float(f"{value:.5g}", 5)


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
