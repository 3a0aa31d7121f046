"""What is set at an instant: a `Reset` at an event, a `Task` at instants of its own, which are exact.

A `Machine` is in one of its modes, and a `Transition` leads from one to another.
"""

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass

import sympy as sp

TICK = "tick"
"""The event at which a task sets what it sets."""


@dataclass(frozen=True)
class Reset:
    """What a state becomes at an event of a switch: as it turns "on" or "off"; at a "hit" of a stop;
    at the "tick" of a task."""

    state: sp.Symbol
    value: sp.Expr
    event: str


Called = Callable[[Mapping[str, float]], Mapping[str, float]]
"""A Python function that works at a task's instants: from values by name to values by name."""


@dataclass(frozen=True)
class Task:
    """What a sampled controller does at the instants ``(k*every + offset)/unit`` [s], k = 0, 1, ...

    ``resets``: what it sets, all told by what stood before it. The three numbers of an instant are
    integers below 2^53, so each of its instants is one division, rounded once and the same wherever it
    is worked out. ``step``: a Python function that tells instead what all becomes, of what it ``reads``;
    expressions read no signals but these, any where there are none.
    """

    name: Hashable
    every: int
    offset: int
    unit: int
    resets: tuple[Reset, ...]
    step: Called | None = None
    reads: tuple[sp.Symbol, ...] = ()

    @property
    def period(self) -> float:
        """The time [s] from one instant to the next.

        >>> Task("c", 1, 0, 100, ()).period
        0.01
        """
        return self.every / self.unit

    @property
    def instants(self) -> str:
        """Its instants in words.

        >>> Task("c", 1, 5, 100, ()).instants, Task("c", 2, 0, 1, ()).instants
        ('every 1/100 s from 1/20 s on', 'every 2 s')
        """
        every, offset = (sp.Rational(part, self.unit) for part in (self.every, self.offset))
        return f"every {every} s" + (f" from {offset} s on" if offset else "")

    @property
    def states(self) -> tuple[sp.Symbol, ...]:
        """What it keeps from one instant to the next: its states, then what it gives."""
        return tuple(reset.state for reset in self.resets)


@dataclass(frozen=True)
class Machine:
    """A state machine: the state that is the ``number`` of its mode, the modes in order, and the first."""

    name: Hashable
    number: sp.Symbol
    modes: tuple[str, ...]
    start: str

    def chosen(self, mode: str, inside: sp.Expr, outside: sp.Expr) -> sp.Expr:
        """One expression in a mode and another in all others: by the number that is nearest.

        >>> Machine("m", sp.Symbol("m"), ("a", "b"), "a").chosen("a", sp.Symbol("x"), sp.Integer(0))
        Piecewise((x, m < 1/2), (0, True))
        """
        at, last, half = self.modes.index(mode), len(self.modes) - 1, sp.Rational(1, 2)
        low = [self.number > at - half] if at else []
        high = [self.number < at + half] if at < last else []
        return sp.Piecewise((inside, sp.And(*low, *high)), (outside, True))


@dataclass(frozen=True)
class Transition:
    """A machine's way from one mode to another, taken as its guard rises above zero in the first."""

    machine: Machine
    source: str
    target: str
    guard: sp.Expr

    @property
    def words(self) -> str:
        """What its event is called.

        >>> one = Transition(Machine("m", sp.Symbol("m"), ("a", "b"), "a"), "a", "b", sp.Symbol("x"))
        >>> one.words
        'a > b'
        """
        return f"{self.source} > {self.target}"
