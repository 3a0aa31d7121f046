"""Laws put over ports after the derivation: which port is meant, and whether the law may close it."""

from collections.abc import Hashable, Mapping, Sequence

from bondgraph.algebra.exact import rows_of
from bondgraph.equations import StateEquations
from bondgraph.errors import DependentSourceError, StructureError
from bondgraph.nodes.inverting import as_received
from bondgraph.nodes.laws import DryFriction, ExpressionLaw, Law, check_slider, law
from bondgraph.reduce.readings import check_laws
from bondgraph.reduce.structure import Port


def merged_laws(
    equations: StateEquations, overrides: Mapping[Hashable, object]
) -> dict[Hashable, Law]:
    """Every closed port's law; a key of the overrides is a node, or the input it gives."""
    if not isinstance(overrides, Mapping):
        raise StructureError(f"laws must map nodes to laws, not be {overrides!r}")
    merged = dict(equations.laws)
    for key, value in overrides.items():
        port = port_called(equations.ports, key)
        name = port.element.name
        if port.element.kind.switches:
            raise StructureError(
                f"law at {name!r}: a switch is told by its on and off, not by a law"
            )
        declared = equations.laws.get(name)
        state = declared.state if isinstance(declared, ExpressionLaw) else None
        closed = law(value, f"law at {name!r}", state, equations.tables)
        if isinstance(closed, DryFriction):
            if not port.element.kind.resists:
                raise StructureError(f"law at {name!r}: dry friction closes an R")
            if port.gives == "flow":
                check_slider(closed, f"law at {name!r}")
        else:
            told = as_received(port.element, closed)
            if told is None:
                raise DependentSourceError(
                    f"law at {name!r}: the port gives its {port.gives} here, and {closed.expression} is not "
                    f"turned round; give a law of {port.received}"
                )
            closed = told
        merged[name] = closed
    check_laws(
        merged, equations.signals, equations.ports, rows_of(equations.E), equations.readings,
        equations.reduction.structure.states_of_laws,
    )  # fmt: skip
    return merged


def port_called(ports: Sequence[Port], key: Hashable) -> Port:
    """The port of that node, or the one that gives the input of that name."""
    named = [port for port in ports if port.element.name == key]
    giving = [port for port in ports if str(key) in _inputs(port)]
    found = named or giving
    if not found:
        raise StructureError(
            f"no open port or source is called {key!r}; there are "
            f"{', '.join(repr(port.element.name) for port in ports) or 'none'}"
        )
    if named and giving and named != giving:
        raise StructureError(f"law at {key!r}: that names a node and another node's input")
    return found[0]


def _inputs(port: Port) -> set[str]:
    """The names of what a port gives; of one that goes either way, of both its variables."""
    either = port.element.lets_go and not port.element.kind.switches
    return {port.given.name} | ({port.received.name} if either else set())
