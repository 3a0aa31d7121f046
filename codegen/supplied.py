"""What numbers and laws make of equations: ports turned for their laws, names without a number as inputs."""

from collections.abc import Iterable

import sympy as sp

from bondgraph.analyse.turned import turned
from bondgraph.derive import check_derived, derive_again
from bondgraph.equations import StateEquations
from bondgraph.errors import ParameterError, nearest


def supplied(equations: StateEquations, laws: object, parameters: Iterable[str]) -> StateEquations:
    """The equations as they are run with these laws over ports, and numbers for these names.

    A name in a value beside a parameter that has a number, `opening` of ``b*(1 + opening)``, is an input,
    as it is in laws. Where it stands alone or is nearly a parameter's name, the number was forgotten.

    Raises `ParameterError` for that, and what `turned` raises.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("force", "F"), bg.One("mass"), bg.I("m", 2, flow="v"),
    ...                   bg.R("valve", "b*(1 + opening)")])
    >>> g.add_edges_from([("force", "mass"), ("mass", "m"), ("mass", "valve")])
    >>> supplied(bg.derive(g), {}, ["b"]).inputs
    (F, opening)
    """
    check_derived(equations)
    equations, given = turned(equations, laws), set(parameters)
    missing = [name for name in equations.parameters if name.name not in given]
    if not missing:
        return equations
    forgotten = [
        name for name in missing if nearest(name.name, given) or _alone(equations, name, given)
    ]
    if forgotten:
        raise ParameterError(_told(forgotten, given))
    return derive_again(equations, {}, [name.name for name in missing])


def _alone(equations: StateEquations, name: sp.Symbol, given: set[str]) -> bool:
    """Whether a value reads this name and none that has a number."""
    values = [one.value for one in equations.elements.values() if one.value is not None]
    values += [entry for one in equations.elements.values() for _, entry in one.row]
    used = [{n.name for n in value.free_symbols} for value in values if name in value.free_symbols]
    return any(not names & given for names in used)


def _told(missing: list[sp.Symbol], given: set[str]) -> str:
    told = ", ".join(name.name + nearest(name.name, given) for name in missing)
    return (
        f"missing parameter(s) {told}; give each a number in parameters, or derive with "
        f"inputs={[name.name for name in missing]} what changes in time"
    )
