"""Bond graphs as files: read without trust, written whole or not at all."""

import os
from collections.abc import Callable, Hashable, Iterable
from pathlib import Path
from typing import Any

import networkx as nx

from bondgraph.errors import BondGraphError, FileFormatError
from bondgraph.files.graphml import from_graphml, to_graphml
from bondgraph.files.nodelink import from_json, to_json
from bondgraph.tables.record import Sampled
from bondgraph.writing import write_bytes

MAX_BYTES = 10_000_000
"""Files beyond this are refused; a graph of 50 000 nodes is well below."""


def write_json(graph: Any, path: str | os.PathLike[str]) -> None:
    """Write the graph as JSON, see `to_json`; a failing write leaves the file that was there."""
    _write(to_json(graph), path)


def read_json(
    path: str | os.PathLike[str], tables: Iterable[Sampled] = ()
) -> "nx.DiGraph[Hashable]":
    """The validated graph in a JSON file, see `from_json`; the errors name the file."""
    return _read(from_json, path, tables)


def write_graphml(graph: Any, path: str | os.PathLike[str]) -> None:
    """Write the graph as GraphML, see `to_graphml`; a failing write leaves the file that was there."""
    _write(to_graphml(graph), path)


def read_graphml(
    path: str | os.PathLike[str], tables: Iterable[Sampled] = ()
) -> "nx.DiGraph[Hashable]":
    """The validated graph in a GraphML file, see `from_graphml`; the errors name the file."""
    return _read(from_graphml, path, tables)


def _read(
    parse: Callable[[str, Iterable[Sampled]], "nx.DiGraph[Hashable]"],
    path: str | os.PathLike[str],
    tables: Iterable[Sampled],
) -> "nx.DiGraph[Hashable]":
    """What the file holds; files that are too large or not UTF-8 are refused."""
    with Path(path).open("rb") as file:
        raw = file.read(MAX_BYTES + 1)
    try:
        if len(raw) > MAX_BYTES:
            raise FileFormatError(f"more than {MAX_BYTES} bytes, too large for a bond graph")
        return parse(raw.decode("utf-8-sig"), tables)
    except UnicodeDecodeError as error:
        raise FileFormatError(f"{os.fspath(path)}: not UTF-8: {error.reason}") from None
    except BondGraphError as error:
        raise type(error)(f"{os.fspath(path)}: {error}") from None


def _write(text: str, path: str | os.PathLike[str]) -> None:
    """Write a file that can be read back."""
    raw = text.encode("utf-8")
    if len(raw) > MAX_BYTES:
        raise FileFormatError(f"{len(raw)} bytes, but at most {MAX_BYTES} are read back")
    write_bytes(path, raw)
