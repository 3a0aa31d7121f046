"""`latex`: whatever is made of a graph, as LaTeX."""

from collections.abc import Mapping
from typing import Any

import networkx as nx
import sympy as sp

from bondgraph.algebra.expressions import expression
from bondgraph.analyse.linear_model import LinearModel
from bondgraph.analyse.state_space import StateSpace
from bondgraph.causality.causal_graph import CausalGraph
from bondgraph.equations import StateEquations
from bondgraph.errors import StructureError
from bondgraph.explaining.explanation import Explanation
from bondgraph.rates.record import ExplicitRates
from bondgraph.show.latex import equations_latex
from bondgraph.show.latex_matrices import matrices_latex, space_latex
from bondgraph.show.poles import poles_latex
from bondgraph.show.sums import typeset

TAKEN = (
    "state equations, explicit rates, linear models in symbols and in numbers, explanations, expressions and "
    "matrices, and mappings of names to expressions"
)


def latex(subject: Any) -> str:
    r"""State equations, or what is made of them, as LaTeX.

    Of `StateEquations` the matrices, then laws, sources and further states, and every equation with these
    put in; of a `LinearModel` or `StateSpace` the matrices, where they are numbers with the poles; of
    `ExplicitRates` one line each; of an `Explanation` the body of a document; of a transfer function, of any
    expression or matrix, itself; of a mapping, as of `holding_efforts`, a line for each name.

    Lines of amsmath's ``gathered``. Names are Greek where they are called so: ``omega_1`` is \omega_{1}.

    Raises `StructureError` for anything else, as a graph, which is derived first; `ExpressionError` for a
    mapping to what are no expressions.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("engine", "tau_e"), bg.One("shaft"), bg.I("J", "J", flow="omega")])
    >>> nx.add_path(g, ["engine", "shaft", "J"])
    >>> left, right = latex(bg.derive(g)).split(" = ")
    >>> print(left.replace("begin{matrix}", "").replace("end{matrix}", ""))
    \left[\J\\right]\frac{d}{dt}\left[\\omega\\right]
    >>> print(latex(bg.explicit(bg.derive(g))))
    \begin{aligned} \dot{\omega} &= \frac{\tau_{e}}{J} \end{aligned}
    >>> print(latex({"tau_e": "J*alpha"}))
    \begin{aligned} \tau_{e} &= J \alpha \end{aligned}
    """
    if isinstance(subject, StateEquations):
        return equations_latex(subject)
    if isinstance(subject, ExplicitRates):
        return rf"\begin{{aligned}} {subject.latex()} \end{{aligned}}" if subject else ""
    if isinstance(subject, LinearModel):
        known = () if subject.parameters or not subject.states else subject.numeric({}).modes()
        return _lines(matrices_latex(subject), poles_latex(known) if known else "")
    if isinstance(subject, StateSpace):
        return _lines(space_latex(subject), poles_latex(subject.modes()) if subject.states else "")
    if isinstance(subject, Explanation):
        return str(subject.latex())
    if isinstance(subject, sp.Basic | sp.MatrixBase):
        return str(typeset(subject))
    if isinstance(subject, Mapping):
        return _mapping_latex(subject)
    graph = isinstance(subject, nx.Graph | CausalGraph)
    first = "; derive the graph first, see bondgraph.derive" if graph else ""
    raise StructureError(f"latex takes {TAKEN}, not {type(subject).__name__}{first}")


def _lines(*parts: str) -> str:
    return " \\\\\n".join(part for part in parts if part)


def _mapping_latex(found: Mapping[Any, Any]) -> str:
    """``name = expression`` for each; `ExpressionError` for what is no expression."""
    rows = [
        f"{typeset(sp.Symbol(str(name)))} &= {typeset(expression(value, f'latex of {name}'))}"
        for name, value in found.items()
    ]
    return rf"\begin{{aligned}} {_lines(*rows)} \end{{aligned}}" if rows else ""
