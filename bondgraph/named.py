"""`Named`: a read-only mapping whose keys a notebook completes."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Generic, TypeVar

from bondgraph.errors import nearest

K = TypeVar("K")
V = TypeVar("V")


@dataclass(frozen=True, eq=False, repr=False)
class Named(Mapping[K, V], Generic[K, V]):
    """A mapping that cannot be changed; where keys are symbols, their names do as well.

    >>> import sympy as sp
    >>> found = Named({sp.Symbol("omega"): 3})
    >>> found["omega"], found[sp.Symbol("omega")], list(found)
    (3, 3, [omega])
    >>> found["omga"]
    Traceback (most recent call last):
    KeyError: "no 'omga' (did you mean 'omega'?); there are omega"
    """

    entries: Mapping[K, V]

    def __post_init__(self) -> None:
        object.__setattr__(self, "entries", MappingProxyType(dict(self.entries)))

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (dict(self.entries),)

    def __getitem__(self, key: K | str) -> V:
        """What stands at a key, or at the key of that name; `KeyError` naming what there is."""
        if key in self.entries:
            return self.entries[key]  # type: ignore[index]
        if isinstance(key, str):
            for one, value in self.entries.items():
                if str(one) == key:
                    return value
        names = [str(one) for one in self.entries]
        raise KeyError(f"no {key!r}{nearest(str(key), names)}; there are {', '.join(names)}")

    def __iter__(self) -> Iterator[K]:
        return iter(self.entries)

    def __len__(self) -> int:
        return len(self.entries)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({dict(self.entries)!r})"

    def _ipython_key_completions_(self) -> list[str]:
        return [str(key) for key in self.entries]
