r"""Equations as LaTeX."""

import sympy as sp

from bondgraph.equations import StateEquations

RATE = r"\frac{d}{dt}"


def latex(equations: StateEquations) -> str:
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
        sp.latex(sp.Matrix(names))
        for names in (equations.states, equations.inputs, equations.outputs)
    )
    lines = []
    if equations.states:
        left = sp.latex(sp.Matrix(equations.A)) + RATE + x
        lines.append(f"{left} = {_sum(equations, ('J', x), ('B', u), ('E', RATE + u))}")
    if equations.outputs:
        lines.append(f"{y} = {_sum(equations, ('F', x), ('D', u), ('G', RATE + u))}")
    return " \\\\\n".join(lines)


def _sum(equations: StateEquations, *terms: tuple[str, str]) -> str:
    """The products of those matrices that are not zero."""
    shown = [(getattr(equations, name), vector) for name, vector in terms]
    products = [sp.latex(sp.Matrix(matrix)) + vector for matrix, vector in shown if matrix.todok()]
    return " + ".join(products) or "0"
