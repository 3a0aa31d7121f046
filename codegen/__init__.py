"""From state equations to simulators: signals, programs, the event-driven hybrid loop, and sweeps."""

from bondgraph.offering import offer

__all__ = offer(__name__)
