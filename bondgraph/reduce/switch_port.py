"""`SwitchPort`: a port that a switch holds or lets go, which of its ways is which, what changes it over."""

from collections.abc import Hashable
from dataclasses import dataclass
from typing import Literal

import sympy as sp

from bondgraph.nodes.elements import Switch
from bondgraph.reduce.structure import Port

Guard = Literal["one-sided", "stop", "commanded", "general"]
"""What changes a switch over: its two sides, these at a bound, a signal from outside, or any expression."""


@dataclass(frozen=True)
class SwitchPort:
    """A port that is let go, when it gives zero, or held, when it gives what keeps at zero what it receives.

    ``guard``: "one-sided" if ``on`` is a positive multiple of the port's own effort and ``off`` of its own
    flow reversed, or both with the other sign (a flow and an effort for a controlled 0-junction);
    "stop" if ``off`` is instead the negative of a gap, a displacement beyond a bound, the integral of its own
    flow: apart from the bound it is on, there its own two sides tell;
    "commanded" if both hold time, parameters and open sources' inputs alone; else "general".

    ``side``, of a one-sided port 1 or -1, else 0: let go, it receives ``side * received >= 0``; held, it
    gives ``side * given <= 0``.
    """

    switch: Switch
    port: Port
    guard: Guard
    side: int = 0
    #: Of a stop the gap, which changes at the rate of its flow or of that reversed; and the displacement.
    gap: sp.Expr | None = None
    displacement: sp.Symbol | None = None
    #: How fast the gap opens along the displacement, 1 or -1.
    opening: int = 0

    @property
    def name(self) -> Hashable:
        """The node: the Sw, or the controlled junction."""
        return self.switch.name

    @property
    def on(self) -> sp.Expr:
        """Off, it turns on as this rises above zero."""
        return self.switch.on

    @property
    def off(self) -> sp.Expr:
        """On, it turns off as this rises above zero."""
        return self.switch.off

    @property
    def read(self) -> tuple[sp.Expr, ...]:
        """What it reads: its conditions, or the guard of its transition, and what it sets states to."""
        taken = self.switch.transition
        conditions = (self.on, self.off) if taken is None else (taken.guard,)
        return *conditions, *(one.value for one in self.switch.resets)

    @property
    def gives(self) -> str:
        """What it gives in all of its modes, "effort" or "flow"."""
        return self.port.gives

    @property
    def held(self) -> Literal["on", "off"]:
        """The way in which it is held: "off" if it gives, in all modes, what it gives as zero while on."""
        return "off" if self.port.gives == self.switch.gives else "on"
