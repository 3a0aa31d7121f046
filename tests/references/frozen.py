"""What of a record can be changed after it was handed out, found by walking through all that it holds."""

from collections.abc import Iterator, Mapping
from dataclasses import is_dataclass
from functools import partial
from types import MappingProxyType, MethodType
from typing import Any

import networkx as nx
import numpy as np
import scipy.sparse as sps

from bondgraph.named import Named

Parts = Iterator[tuple[str, Any]]


def changeable(record: object) -> list[str]:
    """Each place in a record, caches included, that can be changed, with what stands there.

    Followed are records, tuples, frozen sets, mappings, sparse arrays, and what methods and partial functions
    are bound to; objects of classes that are no records, such as expressions, are not.
    """
    found: list[str] = []
    waiting, seen = [(type(record).__name__, record)], set[int]()
    kept = []
    while waiting:
        where, value = waiting.pop()
        if id(value) in seen:
            continue
        seen.add(id(value))
        # Alive until the end, so that no other object gets its id.
        kept.append(value)
        wrong = _wrong(value)
        if wrong:
            found.append(f"{where}: {wrong}")
        else:
            waiting += [(where + step, part) for step, part in _parts(value)]
    return sorted(found)


def _wrong(value: Any) -> str | None:
    """What about a value can be changed by itself; None if nothing."""
    if isinstance(value, list | dict | set | bytearray):
        return f"a {type(value).__name__}"
    if isinstance(value, Mapping) and not isinstance(value, MappingProxyType | Named):
        return f"a mapping that is not read-only, a {type(value).__name__}"
    if isinstance(value, np.ndarray) and value.flags.writeable:
        return "an array that can be written to"
    if isinstance(value, np.ndarray) and isinstance(value.base, np.ndarray):
        return "a view of an array that can be written to" if value.base.flags.writeable else None
    if isinstance(value, nx.Graph) and not nx.is_frozen(value):
        return "a graph that is not frozen"
    if is_dataclass(value) and not type(value).__dataclass_params__.frozen:  # type: ignore[union-attr]
        return f"a record that is not frozen, a {type(value).__name__}"
    return None


def _parts(value: Any) -> Parts:
    """What a value holds, each part with the way to it."""
    if isinstance(value, MappingProxyType):
        for key, part in value.items():
            yield f" key {key!r}", key
            yield f"[{key!r}]", part
    elif isinstance(value, tuple | frozenset):
        yield from ((f"[{at}]", part) for at, part in enumerate(value))
    elif sps.issparse(value):
        yield from ((f".{name}", getattr(value, name)) for name in ("data", "indices", "indptr"))
    elif isinstance(value, MethodType):
        yield f".{value.__name__} of", value.__self__
    elif isinstance(value, partial):
        yield from ((f" argument {at}", part) for at, part in enumerate(value.args))
    elif is_dataclass(value):
        yield from ((f".{name}", part) for name, part in vars(value).items())
