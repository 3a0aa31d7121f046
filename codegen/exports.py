"""The targets that there are; another one is another line."""

from collections.abc import Mapping
from types import MappingProxyType

from bondgraph.errors import SignalError
from codegen.c.target import C
from codegen.fmu.target import Fmu
from codegen.python.target import Python
from codegen.targets import Target

_ALL: tuple[Target, ...] = (Python(), C(), Fmu("2.0"), Fmu("3.0"))

TARGETS: Mapping[str, Target] = MappingProxyType({one.name: one for one in _ALL})
"""By name, in the order in which they are offered."""


def target(name: str) -> Target:
    """The target of this name; `SignalError` for one that there is not.

    >>> target("c").following
    'cc -std=c99 -O2 {folder}/*.c -lm -o run_{name}'
    """
    if name not in TARGETS:
        raise SignalError(f"unknown target {name!r}; there are {', '.join(TARGETS)}")
    return TARGETS[name]
