"""What the parts of nodes of several elements are called, and how the names of their variables end."""

from collections.abc import Mapping
from typing import Any

BOUNDS = {"low": 1, "high": -1}
"""The bounds of a stop, and which way its flow leads off each."""

POSITION = "position"
"""The part of a stop that integrates its flow."""

ARROW = ">"
"""Between the mode that a transition leaves and the one that it comes to."""

NUMBER = "in"
"""The part of a state machine that keeps the number of its mode; no name that a state can have."""

LAST = "_end"
"""How the names end of what the port of a transition ends at."""


def stop_parts(attributes: Mapping[str, Any]) -> tuple[str, ...]:
    """The names of a stop's parts beside its junction."""
    return (POSITION, *(key for key in BOUNDS if attributes.get(key) is not None))


def ending(words: str) -> str:
    """What the names of effort and flow of a transition's port end with.

    >>> ending("idle > launch")
    'idle_launch'
    """
    return "_".join(part.strip() for part in words.split(ARROW))
