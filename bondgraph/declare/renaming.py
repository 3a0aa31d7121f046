"""Names in a declared graph: what its nodes name and read, and the same attributes under other names."""

from collections.abc import Callable, Hashable, Iterator, Mapping
from typing import Any, TypeAlias

import networkx as nx
import sympy as sp

from bondgraph.algebra.atoms import normal
from bondgraph.algebra.expressions import expression
from bondgraph.declare.tables import READ
from bondgraph.errors import StructureError
from bondgraph.nodes.attributes import bare_name
from bondgraph.nodes.kinds import Kind
from bondgraph.nodes.laws import SLIP, DryFriction, ExpressionLaw
from bondgraph.nodes.stops import stop_parts

Part: TypeAlias = "nx.DiGraph[Hashable]"
"""A bond graph whose terminals may still lack their attributes."""

Names = Mapping[str, str]
"""Old names of signals and parameters to new ones."""

_OWN_SLIP = sp.Dummy("slip of a curve")
"""Stands for ``slip`` in friction curves while the graph's names change."""


def quantities(
    name: Hashable, attributes: Mapping[str, Any]
) -> Iterator[tuple[str, str, str | None]]:
    """What a node names: the letter and ending of the default name, and the name given or None."""
    if not attributes:
        yield from (("e", "", None), ("f", "", None))
        return
    kind = _kind(name, attributes)
    ports = attributes.get("ports")
    for key in ("effort", "flow"):
        if kind.two_port or ((kind.joins or kind is Kind.STOP) and key not in kind.nature.keys):
            continue
        given = attributes.get(key)
        if kind.supplies and key not in kind.nature.keys:
            given = _bare(name, attributes.get("value"))
        if ports is None:
            yield key[0], "", name_text(given)
        for port in ports or ():
            yield key[0], f"_{port}", name_text((given or {}).get(port))
    yield from _further(kind, attributes)


def _further(kind: Kind, attributes: Mapping[str, Any]) -> Iterator[tuple[str, str, str | None]]:
    """The same beside effort and flow: states of laws, integrals, the ports of controlled junctions."""
    ports = attributes.get("ports")
    if kind.stores and any(attributes.get(key) is not None for key in ("law", "energy")):
        for ending in ("",) if ports is None else (f"_{port}" for port in ports):
            yield kind.letter, ending, None
    if kind.joins and (attributes.keys() & {"on", "off", "reset"}):
        yield from (("e", "_switch", None), ("f", "_switch", None))
    if kind is Kind.STOP:
        yield "q", "", None
        for part in stop_parts(attributes):
            yield from (("e", f"_{part}", None), ("f", f"_{part}", None))
    if attributes.get("integrate") is not None:
        yield "", "", name_text(attributes["integrate"])


def _kind(name: Hashable, attributes: Mapping[str, Any]) -> Kind:
    try:
        return Kind(str(attributes.get("kind")))
    except ValueError:
        raise StructureError(
            f"node {name!r}: kind {attributes.get('kind')!r}; there are {', '.join(Kind)}. A part is "
            "the graph as declared, and its terminals have no attributes at all or a kind"
        ) from None


def _bare(name: Hashable, value: object) -> str | None:
    """The input that a source's value names, if it is one name."""
    found = bare_name(value, f"node {name!r}")
    return None if found is None else found.name


def name_text(name: Any) -> str | None:
    """A name as it is compared."""
    return None if name is None else str(normal(str(name)))


def names_read(graph: Part) -> set[str]:
    """Every name that a value, a law or an energy reads."""
    found: set[str] = set()

    def note(expr: sp.Expr) -> sp.Expr:
        found.update(name.name for name in expr.free_symbols)
        return expr

    for name, attributes in graph.nodes(data=True):
        for key in READ:
            _mapped_at(attributes, key, note, f"node {name!r}, {key}")
    return found - {_OWN_SLIP.name}


def renamed(name: Hashable, attributes: Mapping[str, Any], names: Names) -> dict[str, Any]:
    """A node's attributes with new names in them; what holds none of the old is as it was."""

    def rewrite(expr: sp.Expr) -> sp.Expr:
        found = [one for one in expr.free_symbols if one.name in names]
        return expr.xreplace({one: sp.Symbol(names[one.name], **one.assumptions0) for one in found})

    result = dict(attributes)
    for key in READ:
        if key in result:
            result[key] = _mapped_at(result, key, rewrite, f"node {name!r}, {key}")
    for key in ("effort", "flow", "integrate"):
        if isinstance(result.get(key), Mapping):
            result[key] = {port: names.get(str(one), one) for port, one in result[key].items()}
        elif result.get(key) is not None:
            result[key] = names[str(name_text(result[key]))]
    return result


def _mapped_at(
    attributes: Mapping[str, Any], key: str, change: Callable[[sp.Expr], sp.Expr], where: str
) -> Any:
    """An attribute with every expression in it changed; of laws and starts by ports, the ports stay."""
    value = attributes.get(key)
    if key in ("law", "start") and isinstance(value, Mapping):
        return {port: _mapped(one, change, f"{where} at {port}") for port, one in value.items()}
    return _mapped(value, change, where)


def _mapped(value: Any, change: Callable[[sp.Expr], sp.Expr], where: str) -> Any:
    """A value, law or matrix with every expression in it changed; the same object if nothing changes."""
    if value is None:
        return None
    if isinstance(value, DryFriction):
        return _mapped_friction(value, change)
    if isinstance(value, ExpressionLaw):
        state = None if value.state is None else change(value.state)
        return ExpressionLaw(change(value.expression), state)
    if isinstance(value, sp.MatrixBase):
        return value.applyfunc(lambda entry: change(expression(entry, where)))
    if isinstance(value, list | tuple):
        return type(value)(_mapped(entry, change, where) for entry in value)
    if isinstance(value, Mapping):
        return {
            key if isinstance(entry, Mapping) else _mapped(key, change, where): _mapped(
                entry, change, where
            )
            for key, entry in value.items()
        }
    before = expression(value, where)
    after = change(before)
    if after == before:
        return value
    if not isinstance(value, str) or not isinstance(after, sp.Symbol):
        return after
    # Of a source more than a name is no input, and stays more.
    return after.name if value.strip().isidentifier() else f"1*{after.name}"


def _mapped_friction(law: DryFriction, change: Callable[[sp.Expr], sp.Expr]) -> DryFriction:
    """Friction with its expressions changed; in the curve ``slip`` is not the graph's but its own."""
    curve = change(law.curve.xreplace({SLIP: _OWN_SLIP})).xreplace({_OWN_SLIP: SLIP})
    return DryFriction(change(law.level), curve, change(law.breakaway))
