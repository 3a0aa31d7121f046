"""`Asked`: a sweep as the loop needs it."""

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass
from typing import Any

from codegen.family import Family
from codegen.numbers.arrays import Array
from codegen.runs.track import Settings

Given = Mapping[str, Any] | Callable[[Mapping[str, float]], Mapping[str, Any]] | None
"""Initial states or inputs, or a function of a run's numbers that gives them."""


@dataclass(frozen=True)
class Asked:
    """A sweep as the loop needs it; ``names``: what each run has numbers for."""

    family: Family
    names: tuple[str, ...]
    time: Array
    measures: Mapping[str, Callable[..., Any]]
    initial: Given
    inputs: Given
    settings: Settings
    initially_on: tuple[Hashable, ...] = ()
