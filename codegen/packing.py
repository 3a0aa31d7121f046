"""Objects as bytes for another process, read-only mappings included."""

import io
import pickle
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import sympy as sp


def packed(value: object) -> bytes:
    """The bytes from which `pickle.loads` makes the same object.

    >>> pickle.loads(packed(MappingProxyType({"m": 2})))
    mappingproxy({'m': 2})
    """
    file = io.BytesIO()
    _Packer(file, protocol=pickle.HIGHEST_PROTOCOL).dump(value)
    return file.getvalue()


class _Packer(pickle.Pickler):
    def reducer_override(self, value: Any) -> Any:
        if isinstance(value, MappingProxyType):
            return _read_only, (dict(value),)
        if isinstance(value, sp.ImmutableSparseMatrix):
            # By itself it would come back with places that are no Python integers.
            return sp.ImmutableSparseMatrix, (*value.shape, dict(value.todok()))
        return NotImplemented


def _read_only(mapping: dict[Any, Any]) -> Mapping[Any, Any]:
    return MappingProxyType(mapping)
