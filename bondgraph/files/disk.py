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
    """Write the graph as JSON, see `to_json`; a failing write leaves the file that was there.

    Raises `WriteError` where the file cannot be written, `FileFormatError` where it could not be read back,
    and what `to_json` raises.

    >>> import tempfile
    >>> import bondgraph as bg
    >>> g = nx.DiGraph([("u", "loop"), ("loop", "L")])
    >>> g.add_nodes_from([bg.Se("u", "u"), bg.One("loop"), bg.I("L", "L")])
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_json(g, f"{folder}/coil.json")
    ...     again = read_json(f"{folder}/coil.json")
    >>> bg.derive(again).B == bg.derive(g).B
    True
    """
    _write(to_json(graph), path)


def read_json(
    path: str | os.PathLike[str], tables: Iterable[Sampled] = ()
) -> "nx.DiGraph[Hashable]":
    """The validated graph in a JSON file, see `from_json`; the errors name the file.

    Raises `FileFormatError` for a file too large or not UTF-8, `OSError` for one that cannot be opened,
    and what `from_json` raises.

    >>> import tempfile
    >>> import bondgraph as bg
    >>> g = nx.DiGraph([("u", "loop"), ("loop", "L")])
    >>> g.add_nodes_from([bg.Se("u", "u"), bg.One("loop"), bg.I("L", "L")])
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_json(g, f"{folder}/coil.json")
    ...     again = read_json(f"{folder}/coil.json")
    >>> bg.derive(again).B == bg.derive(g).B
    True
    """
    return _read(from_json, path, tables)


def write_graphml(graph: Any, path: str | os.PathLike[str]) -> None:
    """Write the graph as GraphML, see `to_graphml`; a failing write leaves the file that was there.

    Raises `WriteError` where the file cannot be written, `FileFormatError` where it could not be read back,
    and what `to_graphml` raises.

    >>> import tempfile
    >>> import bondgraph as bg
    >>> g = nx.DiGraph([("u", "loop"), ("loop", "L")])
    >>> g.add_nodes_from([bg.Se("u", "u"), bg.One("loop"), bg.I("L", "L")])
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_graphml(g, f"{folder}/coil.graphml")
    ...     again = read_graphml(f"{folder}/coil.graphml")
    >>> bg.derive(again).B == bg.derive(g).B
    True
    """
    _write(to_graphml(graph), path)


def read_graphml(
    path: str | os.PathLike[str], tables: Iterable[Sampled] = ()
) -> "nx.DiGraph[Hashable]":
    """The validated graph in a GraphML file, see `from_graphml`; the errors name the file.

    Raises `FileFormatError` for a file too large or not UTF-8, `OSError` for one that cannot be opened,
    and what `from_graphml` raises.

    >>> import tempfile
    >>> import bondgraph as bg
    >>> g = nx.DiGraph([("u", "loop"), ("loop", "L")])
    >>> g.add_nodes_from([bg.Se("u", "u"), bg.One("loop"), bg.I("L", "L")])
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_graphml(g, f"{folder}/coil.graphml")
    ...     again = read_graphml(f"{folder}/coil.graphml")
    >>> bg.derive(again).B == bg.derive(g).B
    True
    """
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
