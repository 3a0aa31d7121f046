"""What the parts of state machines are called, and how the names of their variables end."""

ARROW = ">"
"""Between the mode that a transition leaves and the one that it comes to."""

NUMBER = "in"
"""The part of a state machine that keeps the number of its mode; no name that a state can have."""

LAST = "_end"
"""How the names end of what the port of a transition ends at."""


def ending(words: str) -> str:
    """What the names of effort and flow of a transition's port end with.

    >>> ending("idle > launch")
    'idle_launch'
    """
    return "_".join(part.strip() for part in words.split(ARROW))
