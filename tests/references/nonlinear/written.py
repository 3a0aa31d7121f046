"""A graph's equations written down: one text for each element, one row for each sum of a junction.

Unknown are what storages hold and detectors sum up, and effort and flow of every bond. Every node has as
many equations as bonds, every storage one more: what it holds, by its variables.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import networkx as nx
import sympy as sp

Bond = tuple[str, str]
ABSORB = ("I", "C", "R", "De", "Df")


@dataclass
class Written:
    """``names``: what texts may call each unknown, and its number; ``texts``: what vanishes.

    ``held``: the unknowns that integrate others, and which. ``sums``: rows of a factor for each unknown.
    ``two_ports``: the texts of transformers and gyrators, by number.
    """

    bonds: list[Bond]
    names: dict[str, int] = field(default_factory=dict)
    held: dict[int, int] = field(default_factory=dict)
    texts: list[str] = field(default_factory=list)
    sums: list[dict[int, int]] = field(default_factory=list)
    two_ports: list[int] = field(default_factory=list)

    @property
    def size(self) -> int:
        """How many unknowns there are."""
        return len(self.held) + 2 * len(self.bonds)


def written(graph: nx.DiGraph[str]) -> Written:
    """All equations of a graph."""
    found = Written(list(graph.edges))
    holders = [name for node in graph for name in _holding(graph, node)]
    for k, name in enumerate(holders):
        found.names[name] = k
    for k in range(len(found.bonds)):
        found.names[f"_e{k}"] = len(holders) + 2 * k
        found.names[f"_f{k}"] = len(holders) + 2 * k + 1
    for node in graph:
        _name(graph, node, found)
    for node in graph:
        _write(graph, node, found)
    return found


def _ports(graph: nx.DiGraph[str], node: str) -> list[str]:
    """The names of a node's ports, as they follow it in the names of its variables."""
    return [f"_{port}" for port in graph.nodes[node].get("ports", ())] or [""]


def _holding(graph: nx.DiGraph[str], node: str) -> Iterator[str]:
    told = graph.nodes[node]
    if told["kind"] in "IC":
        yield from (
            f"{'p' if told['kind'] == 'I' else 'q'}_{node}{port}" for port in _ports(graph, node)
        )
    if told.get("integrate"):
        yield told["integrate"]


def _bonds(graph: nx.DiGraph[str], node: str, found: Written) -> list[tuple[int, int]]:
    """Numbers of a node's bonds, and whether power on the arrow counts into it."""

    def inward(tail: str, head: str) -> int:
        if graph.nodes[tail]["kind"] in ABSORB:
            head = tail
        return 1 if node == head else -1

    return [(k, inward(*bond)) for k, bond in enumerate(found.bonds) if node in bond]


def _bond_of(graph: nx.DiGraph[str], node: str, port: str, found: Written) -> int:
    for k, bond in enumerate(found.bonds):
        if node in bond and port in ("", f"_{graph.edges[bond].get('port')}"):
            return k
    raise KeyError((node, port))


def _name(graph: nx.DiGraph[str], node: str, found: Written) -> None:
    """The names of its effort and flow; of a junction, what its bonds have in common."""
    told = graph.nodes[node]
    if told["kind"] in ("TF", "GY"):
        return
    if told["kind"] in ("Zero", "One"):
        common = "effort" if told["kind"] == "Zero" else "flow"
        if told.get(common):
            first = _bonds(graph, node, found)[0][0]
            found.names[told[common]] = found.names[f"_{common[0]}{first}"]
        return
    for port in _ports(graph, node):
        k = _bond_of(graph, node, port, found)
        for which in ("effort", "flow"):
            name = told.get(which) or f"{which[0]}_{node}{port}"
            found.names[name] = found.names[f"_{which[0]}{k}"]


def _write(graph: nx.DiGraph[str], node: str, found: Written) -> None:
    told: Mapping[str, Any] = graph.nodes[node]
    kind = told["kind"]
    if kind in ("Zero", "One"):
        _write_junction(kind, _bonds(graph, node, found), found)
    elif kind in ("TF", "GY"):
        _write_two_port(kind, told["value"], _bonds(graph, node, found), found)
    elif kind in ("Se", "Sf"):
        k = _bond_of(graph, node, "", found)
        found.texts.append(f"_{'e' if kind == 'Se' else 'f'}{k} - ({told['value']})")
    elif kind in ("De", "Df"):
        k = _bond_of(graph, node, "", found)
        read, none = ("e", "f") if kind == "De" else ("f", "e")
        found.texts.append(f"_{none}{k}")
        if told.get("integrate"):
            found.held[found.names[told["integrate"]]] = found.names[f"_{read}{k}"]
    else:
        _write_element(graph, node, found)


def _write_junction(kind: str, bonds: list[tuple[int, int]], found: Written) -> None:
    same, summed = ("e", "f") if kind == "Zero" else ("f", "e")
    found.sums.append({found.names[f"_{summed}{k}"]: sign for k, sign in bonds})
    first = found.names[f"_{same}{bonds[0][0]}"]
    found.sums += [{first: 1, found.names[f"_{same}{k}"]: -1} for k, _ in bonds[1:]]


def _write_two_port(kind: str, value: object, bonds: list[tuple[int, int]], found: Written) -> None:
    """TF: e_in = m e_out, f_out = m f_in. GY: e_in = r f_out, e_out = r f_in."""
    into = next(k for k, sign in bonds if sign > 0)
    out = next(k for k, sign in bonds if sign < 0)
    across, back = ("e", "f") if kind == "TF" else ("f", "e")
    found.two_ports += [len(found.texts), len(found.texts) + 1]
    found.texts.append(f"_e{into} - ({value})*_{across}{out}")
    found.texts.append(f"_{back}{out} - ({value})*_f{into}")


def _write_element(graph: nx.DiGraph[str], node: str, found: Written) -> None:
    """I, C, R: by value, matrix, law or energy."""
    told, ports = graph.nodes[node], _ports(graph, node)
    kind = told["kind"]
    letter = {"I": "p", "C": "q", "R": ""}[kind]
    # What the law gives and what a value is a factor of.
    gives, other = ("e", "f") if kind in "RC" else ("f", "e")
    by_value = "f" if kind in "RI" else "e"
    bonds = [_bond_of(graph, node, port, found) for port in ports]
    for i, (port, k) in enumerate(zip(ports, bonds, strict=True)):
        if letter:
            found.held[found.names[f"{letter}_{node}{port}"]] = found.names[f"_{other}{k}"]
        holds = f"{letter}_{node}{port}" if letter else f"_e{k}"
        if (value := told.get("value")) is not None:
            row = value[i] if port else [value]
            terms = [f"({entry})*_{by_value}{k}" for entry, k in zip(row, bonds, strict=True)]
            found.texts.append(f"{holds} - ({' + '.join(terms)})")
            continue
        if told.get("energy") is not None:
            law = str(sp.diff(sp.sympify(told["energy"], {}), sp.Symbol(holds)))
        else:
            law = told["law"][port[1:]] if port else told["law"]
        if kind == "R":
            given = told.get("gives") or "effort"
            gives = (given.get(port[1:], "effort") if isinstance(given, dict) else given)[0]
        found.texts.append(f"_{gives}{k} - ({law})")
