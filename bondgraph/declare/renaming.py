"""Names in a declared graph: what its nodes read, and the same attributes under other names."""

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

import networkx as nx
import sympy as sp

from bondgraph.algebra.expressions import expression
from bondgraph.declare.quantities import name_text
from bondgraph.declare.tables import READ
from bondgraph.nodes.fields import port_names
from bondgraph.nodes.kinds import SIGNALS
from bondgraph.nodes.laws import SLIP, DryFriction, ExpressionLaw
from bondgraph.nodes.tasks import Called

Part: TypeAlias = "nx.DiGraph[Hashable]"
"""A bond graph whose terminals may still lack their attributes."""

Names = Mapping[str, str]
"""Old names of signals and parameters to new ones."""

_OWN_SLIP = sp.Dummy("slip of a curve")
"""Stands for ``slip`` in friction curves while the graph's names change."""


@dataclass(frozen=True)
class RenamedStep:
    """A controller's function where ``names`` are others, old and new: it is told those that it knows."""

    step: Called
    names: tuple[tuple[str, str], ...]

    def __call__(self, values: Mapping[str, float]) -> dict[str, float]:
        """What the function makes of the values, by the new names.

        >>> twice = RenamedStep(lambda now: {"u": 2 * now["x"]}, (("u", "left_u"), ("x", "left_x")))
        >>> twice({"left_x": 3, "t": 0})
        {'left_u': 6}
        """
        new = dict(self.names)
        known = {old: values[now] for old, now in self.names if now in values}
        others = {name: value for name, value in values.items() if name not in new.values()}
        told = self.step({**others, **known})
        return {new.get(name, name): value for name, value in told.items()}


def names_read(graph: Part) -> set[str]:
    """Every name that a value, a law or an energy reads."""
    return {one for name, told in graph.nodes(data=True) for one in names_read_at(name, told)}


def names_read_at(name: Hashable, attributes: Mapping[str, Any]) -> set[str]:
    """Every name that one node reads, but those that stand for its own inputs."""
    found: set[str] = set()

    def note(expr: sp.Expr) -> sp.Expr:
        found.update(name.name for name in expr.free_symbols)
        return expr

    for key in READ:
        _mapped_at(attributes, key, note, f"node {name!r}, {key}")
    return found - {_OWN_SLIP.name} - _inputs(name, attributes)


def _inputs(name: Hashable, attributes: Mapping[str, Any]) -> frozenset[str]:
    """The names that stand for what wires bring to a node of signals; nobody else knows them."""
    ports = attributes.get("ports") if str(attributes.get("kind")) in SIGNALS else None
    return frozenset(() if ports is None else port_names(ports, f"node {name!r}"))


def renamed(name: Hashable, attributes: Mapping[str, Any], names: Names) -> dict[str, Any]:
    """A node's attributes with new names in them; what holds none of the old is as it was."""
    own = _inputs(name, attributes)
    names = {old: new for old, new in names.items() if old not in own}
    result = with_names(name, attributes, names)
    for key in ("effort", "flow", "integrate"):
        if isinstance(result.get(key), Mapping):
            result[key] = {port: names.get(str(one), one) for port, one in result[key].items()}
        elif result.get(key) is not None:
            result[key] = names[str(name_text(result[key]))]
    return result


def with_names(name: Hashable, attributes: Mapping[str, Any], names: Names) -> dict[str, Any]:
    """A node's attributes with other names in all that it reads."""

    def rewrite(expr: sp.Expr) -> sp.Expr:
        found = [one for one in expr.free_symbols if one.name in names]
        return expr.xreplace({one: sp.Symbol(names[one.name], **one.assumptions0) for one in found})

    result = dict(attributes)
    for key in READ:
        if key in result:
            result[key] = _mapped_at(result, key, rewrite, f"node {name!r}, {key}")
    if result.get("step") is not None:
        result["step"] = RenamedStep(result["step"], tuple(sorted(names.items())))
    return result


def _mapped_at(
    attributes: Mapping[str, Any], key: str, change: Callable[[sp.Expr], sp.Expr], where: str
) -> Any:
    """An attribute with every expression in it changed; of laws and starts by ports, the ports stay.

    So do the names of transitions.
    """
    value = attributes.get(key)
    if key in ("law", "start", "transitions") and isinstance(value, Mapping):
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
