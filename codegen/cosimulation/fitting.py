"""Values of a unit's variables, by their types."""

import math
from collections.abc import Iterable, Sequence
from itertools import groupby
from typing import Any

from bondgraph.errors import SignalError
from codegen.cosimulation.described import INTEGERS, UnitVariable
from codegen.numbers.arrays import is_finite, is_number


def fitting(one: UnitVariable, value: Any, part: str) -> Any:
    """A number as a variable's type has it; `SignalError` for what it does not take."""
    where = f"participant {part!r}: {one.name!r}"
    if isinstance(value, bool):
        value = int(value)
    if not is_number(value) or not is_finite(value):
        raise SignalError(f"{where} takes a finite number, not {value!r}")
    if one.kind == "Boolean":
        if value not in (0, 1):
            raise SignalError(f"{where} is a truth value, 0 or 1, not {value!r}")
        return bool(value)
    if one.kind in INTEGERS:
        if float(value) != math.floor(value):
            raise SignalError(f"{where} takes whole numbers, not {value!r}")
        return int(value)
    return float(value)


def by_kind(
    variables: Iterable[UnitVariable],
) -> list[tuple[str, Sequence[UnitVariable]]]:
    """Variables by the types that they are got and set by."""
    ordered = sorted(variables, key=lambda one: one.kind)
    return [(kind, [*several]) for kind, several in groupby(ordered, key=lambda one: one.kind)]
