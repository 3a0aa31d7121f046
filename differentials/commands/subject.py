"""What a command is about: a differential of the catalog, or the graph in a file."""

import re
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click
import networkx as nx
from click.shell_completion import CompletionItem

import bondgraph as bg
from bondgraph.errors import nearest
from differentials.report import causality_text
from differentials.topologies import Differential, catalog, graph

READERS = {".json": bg.read_json, ".graphml": bg.read_graphml}
"""How files are read, by their endings."""

ENDINGS = tuple(READERS)

TABLES = "bondgraph.tables"
"""Where a command keeps the tables that it was given."""


def tables_given(ctx: Any) -> tuple[bg.LookupTable, ...]:
    """The tables that a command was given, which are read before all else."""
    return () if ctx is None else tuple(ctx.meta.get(TABLES, ()))


@dataclass(frozen=True)
class Subject:
    """A name to call files after, and either the catalog's differential or a file's graph."""

    name: str
    differential: Differential | None = None
    file: "nx.DiGraph[Any] | None" = None

    @property
    def title(self) -> str:
        """What it is, for people."""
        chosen = self.differential
        if chosen is not None:
            return f"{chosen.title} ({chosen.source})"
        return str(self.file.graph.get("name", "a graph")) if self.file is not None else self.name

    @property
    def ports(self) -> tuple[str, ...]:
        """What the equations show: a differential's slips."""
        return () if self.differential is None else tuple(self.differential.clutches)

    def switches(self) -> tuple[Any, ...]:
        """The switches of a file's graph."""
        return () if self.file is None else tuple(one.name for one in bg.switches(self.file))

    def graph(
        self, halfshafts: bool = False, unlumped: bool = False, on: Collection[str] = (),
        off: Collection[str] = (),
    ) -> "nx.DiGraph[Any]":  # fmt: skip
        """The graph, with halfshafts or all inertias apart; in the mode of its switches that is named."""
        if self.file is None:
            if on or off:
                raise bg.StructureError(f"{self.name} has no switches; leave --on and --off out")
            return graph(self.name, halfshafts, not unlumped)
        if halfshafts or unlumped:
            raise bg.StructureError(
                "--halfshafts and --unlumped choose among the catalog's models; a file has only one"
            )
        if not on and not off:
            return self.file
        both = [name for name in on if name in off]
        if both:
            raise bg.StructureError(f"{both[0]!r} is on by --on and off by --off; keep one")
        nodes_called(off, self.switches(), "switch")
        return bg.in_mode(self.file, on=nodes_called(on, self.switches(), "switch"))


def nodes_called(names: Iterable[str], nodes: Iterable[Any], what: str) -> list[Any]:
    """The nodes of these names, which need not be texts."""
    known = {str(node): node for node in nodes}
    for name in names:
        if name not in known:
            listed = ", ".join(known) or "none"
            raise bg.StructureError(
                f"no {what} is called {name!r}{nearest(name, known)}; there is {listed}"
            )
    return [known[name] for name in names]


class SubjectType(click.ParamType):  # type: ignore[type-arg]
    """A name of the catalog, or a file that ends in .json or .graphml."""

    name = "model"

    def convert(self, value: Any, param: Any, ctx: Any) -> Subject:
        """The differential, or the graph read from the file."""
        if isinstance(value, Subject):
            return value
        if value in catalog:
            return Subject(value, catalog[value])
        path = Path(value)
        reader = READERS.get(path.suffix.lower())
        if reader is None:
            hint = nearest(value, catalog)
            raise bg.StructureError(
                f"no differential is called {value!r}{hint}; there is {', '.join(catalog)}, or a file "
                "that ends in .json or .graphml"
            )
        if not path.is_file():
            raise bg.StructureError(
                f"there is no file {value!r}; `bondgraph convert alsd -o alsd.json` would write one"
            )
        name = re.sub(r"\W", "_", path.stem)
        found = reader(path, tables_given(ctx))
        return Subject(f"_{name}" if name[:1].isdigit() else name, None, found)

    def shell_complete(self, ctx: Any, param: Any, incomplete: str) -> list[CompletionItem]:
        """The catalog's names that begin so, and files."""
        names = [CompletionItem(name) for name in catalog if name.startswith(incomplete)]
        return names or [CompletionItem(incomplete, type="file")]


def mode_text(subject: Subject, on: Iterable[str], derived: bg.StateEquations) -> str:
    """Which mode of the switches is shown, or what they do in equations of all; empty without switches."""
    # What relays and bounds of signals are made of is told with their equations.
    switches = [one for one in derived.switches if not one.port.element.of_signals]
    if derived.switches:
        each = ", ".join(f"{one.name} (held while {one.held}, {one.guard})" for one in switches)
        return f"switches, each let go or held: {each}\n" if each else ""
    if not subject.switches():
        return ""
    told = ", ".join(on) or "none"
    return f"switches that are on: {told} (of {', '.join(map(str, subject.switches()))})\n"


def causality_of(declared: "nx.DiGraph[Any]") -> str:
    """Which storages are states, and why the others are not."""
    return causality_text(bg.assign_causality(declared))
