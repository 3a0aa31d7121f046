"""Equations as LaTeX."""

import sympy as sp

from bondgraph.show.display import MOST_SIGNS, MOST_STATES, Matrices, structure
from bondgraph.show.sums import typeset

RATE = r"\frac{d}{dt}"


def latex(equations: Matrices) -> str:
    r"""``A dx/dt = J x + B u + E du/dt`` and ``y = F x + D u + G du/dt``, zero matrices left out.

    Names are Greek where they are called so: ``omega_1`` is \omega_{1}.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("engine", "tau_e"), bg.One("shaft"), bg.I("J", "J", flow="omega")])
    >>> nx.add_path(g, ["engine", "shaft", "J"])
    >>> left, right = latex(bg.derive(g)).split(" = ")
    >>> print(left.replace("begin{matrix}", "").replace("end{matrix}", ""))
    \left[\J\\right]\frac{d}{dt}\left[\\omega\\right]
    """
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


def notebook_latex(equations: Matrices) -> str:
    """The equations for a notebook's display; of large systems the sizes alone."""
    if len(equations.states) <= MOST_STATES and len(equations.outputs) <= 2 * MOST_STATES:
        text = latex(equations)
        if len(text) <= MOST_SIGNS:
            return rf"$$\begin{{gathered}} {text} \end{{gathered}}$$"
    counts = {name: len(getattr(equations, name).todok()) for name in "AJBEFDG"}
    sizes = r",\; ".join(
        rf"{name} \in \mathbb{{R}}^{{{m.rows} \times {m.cols}}}\ (\text{{{counts[name]} entries}})"
        for name in counts
        if counts[name]
        for m in [getattr(equations, name)]
    )
    return rf"$$\begin{{gathered}} {_structure(equations)} \\ {sizes} \end{{gathered}}$$"


def _structure(equations: Matrices) -> str:
    names = {"x'": r"\dot{x}", "u'": r"\dot{u}"}
    return " ".join(names.get(word, word) for word in structure(equations).split())
