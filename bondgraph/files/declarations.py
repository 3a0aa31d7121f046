"""A bond graph as plain data: texts, numbers and small objects that a file can hold, and back."""

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from bondgraph.algebra.atoms import MAX_DIGITS, number
from bondgraph.algebra.expressions import expression
from bondgraph.algebra.lookups import Handle
from bondgraph.algebra.written import written
from bondgraph.declare.tables import TABLES, tables_in
from bondgraph.declare.validate import validate
from bondgraph.errors import ExpressionError, FileFormatError
from bondgraph.files.tables import plain_table
from bondgraph.nodes.kinds import EXPRESSIONS, INSTANTS, NAMED, Kind
from bondgraph.nodes.laws import DryFriction, ExpressionLaw

FRICTION = ("breakaway", "curve", "level")
"""The parts of a dry friction, in a file's order."""

NAMES = frozenset(
    {"kind", "effort", "flow", "gives", "integrate", "unit", "port", "tail_port", "head_port"}
) | {"stroke", "signal", "initially"}
"""Attributes of nodes and bonds that are mere names."""


@dataclass(frozen=True)
class Declaration:
    """A graph's name, its nodes and bonds in their order, their attributes and its tables as plain data."""

    name: str | None
    nodes: tuple[tuple[Hashable, dict[str, Any]], ...]
    bonds: tuple[tuple[Hashable, Hashable, dict[str, Any]], ...]
    tables: tuple[Any, ...] = ()


def declaration(graph: Any) -> Declaration:
    """The graph as plain data from which `restored` makes a graph of the same equations.

    Text, int and float stay as they are; other numbers and expressions become text that
    `expression` reads as the same. Attributes come as ``kind`` and the rest sorted.

    Raises what `validate` raises, and `FileFormatError`, naming the node, for what text cannot say.
    """
    if validate(graph) is graph:
        raise FileFormatError("this is the checked copy that validate made; write the graph itself")
    unknown = sorted(repr(key) for key in graph.graph if key not in ("name", TABLES))
    name = graph.graph.get("name") or None
    if unknown or not isinstance(name, str | None):
        which = unknown[0] if unknown else f"'name' = {name!r}"
        raise FileFormatError(
            f"graph attribute {which}: a file keeps a name, a text, and tables; remove it"
        )
    check_text(name or "", "the graph's name")
    nodes = []
    for node, attributes in graph.nodes(data=True):
        where = f"node {node!r}"
        if isinstance(node, int) and node.bit_length() > 4 * MAX_DIGITS:
            raise FileFormatError(f"a node's name is a number of more than {MAX_DIGITS} digits")
        check_text(node, where)
        nodes.append((node, _all_plain(attributes, attributes.get("kind"), where)))
    bonds = [
        (tail, head, _all_plain(attributes, None, f"bond {tail!r} -> {head!r}"))
        for tail, head, attributes in graph.edges(data=True)
    ]
    return Declaration(name, tuple(nodes), tuple(bonds), tuple(map(plain_table, tables_in(graph))))


def _all_plain(attributes: Mapping[str, Any], kind: object, where: str) -> dict[str, Any]:
    given = {key: value for key, value in attributes.items() if value is not None}
    if kind is not None:
        given["kind"] = Kind(str(kind))
    if given.get("step") is not None:
        raise FileFormatError(
            f"{where}: its step is a Python function, which no file can hold; tell update and gives as "
            "expressions"
        )
    keys = sorted(given, key=lambda key: (key != "kind", key))
    return {key: _plain(key, given[key], kind, f"{where}, {key}") for key in keys}


def _plain(key: str, value: Any, kind: object, where: str) -> Any:
    """One attribute as a text, a number or, where that is not enough, a list or an object of such."""
    if key == "priority":
        return _priority(value, where)
    if key in ("law", "start") and isinstance(value, Mapping):
        told = {_name(port, where): _law(one, kind, where) for port, one in value.items()}
        return dict(sorted(told.items()))
    if key == "law":
        return _law(value, kind, where)
    if key in (*EXPRESSIONS, *INSTANTS):
        rows = value.tolist() if isinstance(value, sp.MatrixBase) else value
        if isinstance(rows, Sequence) and not isinstance(rows, str):
            return [[_written(entry, where) for entry in row] for row in rows]
        return _written(rows, where)
    if key in ("reset", *NAMED) and isinstance(value, Mapping):
        return {_name(state, where): _become(state, told, where) for state, told in value.items()}
    if key in ("ports", "reads", "modes"):
        return [_name(one, where) for one in value]
    if key in ("effort", "flow", "gives") and isinstance(value, Mapping):
        names = {_name(port, where): _name(given, where) for port, given in value.items()}
        return dict(sorted(names.items()))
    if key in NAMES:
        return _name(value, where)
    raise FileFormatError(f"{where}: files do not know this attribute")


def _become(state: object, told: Any, where: str) -> Any:
    """What a name stands for, or by an event what each of its states is reset to."""
    if isinstance(told, Mapping):
        return {
            _name(one, where): _written(value, f"{where} of {one}") for one, value in told.items()
        }
    return _written(told, f"{where} of {state}")


def _law(value: Any, kind: object, where: str) -> Any:
    if isinstance(value, DryFriction):
        return {part: _written(getattr(value, part), where) for part in FRICTION}
    if isinstance(value, ExpressionLaw):
        text = _written(value.expression, where)
        if value.state is None or Kind(str(kind)).stores:
            return text
        return {"expression": text, "state": _written(value.state, where)}
    return _written(value, where)


def _name(value: Any, where: str) -> str:
    text = value.name if isinstance(value, sp.Symbol) else str(value)
    check_text(text, where)
    return text


def _priority(value: object, where: str) -> float:
    exact = float(number(value, where))
    if abs(exact) == float("inf"):
        raise FileFormatError(f"{where}: {value!r} is beyond what a file can hold")
    return int(exact) if exact.is_integer() and abs(exact) < 2**53 else exact


def _written(value: Any, where: str) -> str | int | float:
    """The number or text that stands for this value; text that reads back as another is refused."""
    if isinstance(value, str):
        check_text(value, where)
    if isinstance(value, str | int | float):
        return value
    exact = expression(value, where)
    strange = sorted(s.name for s in exact.free_symbols if s != sp.Symbol(s.name))
    if strange:
        raise FileFormatError(
            f"{where}: the symbol {strange[0]} has assumptions, which text cannot say; "
            f"use a plain Symbol({strange[0]!r})"
        )
    text = written(exact)
    try:
        back = expression(text, where, {part.table for part in exact.atoms(Handle)})
    except ExpressionError as error:
        raise FileFormatError(f"{error}; it cannot be written as text") from None
    if back != exact:
        raise FileFormatError(f"{where}: {text!r} would be read as {back}, which is not the same")
    return text


def check_text(text: object, where: str) -> None:
    """Refuse text that no UTF-8 file can hold."""
    try:
        if isinstance(text, str):
            text.encode("utf-8")
    except UnicodeEncodeError:
        raise FileFormatError(
            f"{where}: half a character (a surrogate) has no place in a file"
        ) from None
